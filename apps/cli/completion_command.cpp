// limber completion: scripts by which a shell completes commands and options, made from the commands themselves.
#include <fmt/format.h>

#include "command.h"

namespace limber::cli {

namespace {

struct OptionWords {
  std::vector<std::string> names;  // with their dashes
  std::string description;
  bool takesValue = false;
};

struct CommandWords {
  std::string path;                                           // "limber evaluate rig"
  std::vector<std::pair<std::string, std::string>> commands;  // below it, with what they do
  std::vector<OptionWords> options;
};

// Of a text of several lines the first.
std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void addWords(const CLI::App& command, const std::string& path, std::vector<CommandWords>& all) {
  CommandWords words{path, {}, {}};
  for (const CLI::App* one : command.get_subcommands({})) {
    words.commands.emplace_back(one->get_name(), firstLine(one->get_description()));
  }
  for (const CLI::Option* one : command.get_options()) {
    OptionWords option{{}, firstLine(one->get_description()), one->get_items_expected_max() > 0};
    for (const std::string& name : one->get_snames()) option.names.push_back("-" + name);
    for (const std::string& name : one->get_lnames()) option.names.push_back("--" + name);
    if (!option.names.empty()) words.options.push_back(std::move(option));
  }
  all.push_back(std::move(words));
  for (const CLI::App* one : command.get_subcommands({})) addWords(*one, path + " " + one->get_name(), all);
}

// Within single quotes of a shell; `quote` is how it writes one there.
std::string quoted(std::string_view text, std::string_view quote) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string(quote) : std::string(1, c);
  return result;
}

std::string bashScript(const std::vector<CommandWords>& all) {
  std::string text =
      "# Completion of limber for bash, made by limber completion bash.\n"
      "_limber_words() {\n  case \"$1\" in\n";
  for (const CommandWords& command : all) {
    std::string words;
    for (const auto& [name, description] : command.commands) words += " " + name;
    for (const OptionWords& option : command.options) {
      for (const std::string& name : option.names) words += " " + name;
    }
    text += fmt::format("    '{}') echo '{}' ;;\n", command.path, words.empty() ? "" : words.substr(1));
  }
  text +=
      "    *) return 1 ;;\n  esac\n}\n"
      "_limber() {\n"
      "  local command=limber i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    _limber_words \"$command ${COMP_WORDS[i]}\" >/dev/null && command+=\" ${COMP_WORDS[i]}\" || break\n"
      "  done\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$(_limber_words \"$command\")\" -- \"${COMP_WORDS[COMP_CWORD]}\")\n"
      "}\n"
      "complete -o default -F _limber limber\n";
  return text;
}

std::string zshEntry(const std::string& name, const std::string& description) {
  return fmt::format(" '{}:{}'", name, quoted(description, "'\\''"));
}

std::string zshScript(const std::vector<CommandWords>& all) {
  std::string text =
      "#compdef limber\n"
      "# Completion of limber for zsh, made by limber completion zsh.\n"
      "_limber_words() {\n  case $1 in\n";
  for (const CommandWords& command : all) {
    std::string commands, options;
    for (const auto& [name, description] : command.commands) commands += zshEntry(name, description);
    for (const OptionWords& option : command.options) {
      for (const std::string& name : option.names) options += zshEntry(name, option.description);
    }
    text += fmt::format("    '{}') commands=({} ) options=({} ) ;;\n", command.path, commands, options);
  }
  text +=
      "    *) return 1 ;;\n  esac\n}\n"
      "_limber() {\n"
      "  local command=limber i\n"
      "  local -a commands options\n"
      "  for ((i = 2; i < CURRENT; ++i)); do\n"
      "    _limber_words \"$command ${words[i]}\" || break\n"
      "    command+=\" ${words[i]}\"\n"
      "  done\n"
      "  _limber_words $command\n"
      "  (( $#commands )) && _describe command commands\n"
      "  if [[ ${words[CURRENT]} == -* ]]; then _describe -o option options; elif (( ! $#commands )); then _files; fi\n"
      "}\n"
      "if [ \"$funcstack[1]\" = _limber ]; then _limber \"$@\"; else compdef _limber limber; fi\n";
  return text;
}

std::string fishScript(const std::vector<CommandWords>& all) {
  std::string text =
      "# Completion of limber for fish, made by limber completion fish.\n"
      "function __limber_at\n"
      "  set -l at limber\n"
      "  for word in (commandline -opc)[2..-1]\n"
      "    contains -- \"$at $word\" $__limber_commands; or break\n"
      "    set at \"$at $word\"\n"
      "  end\n"
      "  test \"$at\" = \"$argv[1]\"\n"
      "end\n"
      "set -g __limber_commands";
  for (const CommandWords& command : all) text += fmt::format(" '{}'", command.path);
  text += "\n";
  for (const CommandWords& command : all) {
    const std::string start = fmt::format("complete -c limber -n '__limber_at \"{}\"'", command.path);
    for (const auto& [name, description] : command.commands) {
      text += fmt::format("{} -f -a {} -d '{}'\n", start, name, quoted(description, "\\'"));
    }
    for (const OptionWords& option : command.options) {
      text += start;
      for (const std::string& name : option.names) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      text += fmt::format("{} -d '{}'\n", option.takesValue ? " -r" : "", quoted(option.description, "\\'"));
    }
  }
  return text;
}

}  // namespace

void addCompletionCommand(CLI::App& program) {
  CLI::App* command = program.add_subcommand("completion", "Print a script by which a shell completes limber's words");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "Example:\n"
      "  mkdir -p ~/.local/share/bash-completion/completions ~/.config/fish/completions\n"
      "  limber completion bash > ~/.local/share/bash-completion/completions/limber\n"
      "  limber completion fish > ~/.config/fish/completions/limber.fish");
  command->callback([&program, shell] {
    std::vector<CommandWords> all;
    addWords(program, "limber", all);
    fmt::print("{}", *shell == "bash" ? bashScript(all) : *shell == "zsh" ? zshScript(all) : fishScript(all));
  });
}

}  // namespace limber::cli
