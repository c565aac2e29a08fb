#include "limber/actions/option_spelling.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

namespace limber {

namespace {

constexpr std::string_view kOptions[] = {"handles", "max-influences", "rigger", "template", "skinning",
                                         "pieces",  "existing-rig",   "up",     "front",    "pins",
                                         "upright", "chains",         "bones",  "target",   "reading"};

// "max-influences" or "existing-rig: replace".
struct WrittenOption {
  std::string_view name, value;
};

bool isOptionWord(std::string_view word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

// Parses the text between two backticks.
std::optional<WrittenOption> parseOption(std::string_view inside) {
  const std::size_t colon = inside.find(": ");
  const bool hasValue = colon != std::string_view::npos;
  const WrittenOption option{inside.substr(0, colon), hasValue ? inside.substr(colon + 2) : std::string_view()};
  const bool isKnown = std::find(std::begin(kOptions), std::end(kOptions), option.name) != std::end(kOptions);
  if (!isKnown || (hasValue && !isOptionWord(option.value))) return std::nullopt;
  return option;
}

// The words with their hyphens as underscores, or as capitals behind them.
std::string joinWords(std::string_view name, OptionSpelling spelling) {
  std::string joined;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != '-') {
      joined += name[i];
    } else if (spelling == OptionSpelling::kPython) {
      joined += '_';
    } else if (++i < name.size()) {
      joined += static_cast<char>(name[i] - 'a' + 'A');
    }
  }
  return joined;
}

std::string programOption(const WrittenOption& option) {
  if (option.name == "existing-rig") {
    if (option.value == "replace") return "--replace-rig";
    return option.value.empty() ? "--replace-rig or --keep-skeleton" : "--keep-skeleton";
  }
  const std::string name = option.name == "pins" ? "--pin" : "--" + std::string(option.name);
  return option.value.empty() ? name : name + " " + std::string(option.value);
}

std::string spelled(const WrittenOption& option, OptionSpelling spelling) {
  if (spelling == OptionSpelling::kProgram) return programOption(option);
  const std::string name = joinWords(option.name, spelling);
  if (option.value.empty()) return name;
  const std::string value(option.value);
  return spelling == OptionSpelling::kPython ? name + "=\"" + value + "\"" : name + ": '" + value + "'";
}

}  // namespace

std::string spellOptions(std::string_view text, OptionSpelling spelling) {
  std::string result;
  while (!text.empty()) {
    const std::size_t open = text.find('`');
    const std::size_t close = open == std::string_view::npos ? open : text.find('`', open + 1);
    if (close == std::string_view::npos) break;
    const std::optional<WrittenOption> option = parseOption(text.substr(open + 1, close - open - 1));
    result += text.substr(0, option ? open : close);  // a backtick that closes nothing may open
    if (option) result += spelled(*option, spelling);
    text.remove_prefix(option ? close + 1 : close);
  }
  return result + std::string(text);
}

bool isOption(std::string_view text) {
  return text.size() > 2 && text.front() == '`' && text.back() == '`' && parseOption(text.substr(1, text.size() - 2));
}

Warnings spellOptions(const Warnings& advice, OptionSpelling spelling) {
  Warnings written;
  for (const Warning& one : advice.items()) {
    written.add(one.kind, spellOptions(one.message, spelling), one.where, one.count);
  }
  return written;
}

Error spellOptions(const Error& error, OptionSpelling spelling) {
  return Error(error.code(), error.message(),
               isOption(error.where()) ? spellOptions(error.where(), spelling) : error.where(),
               spellOptions(error.remedy(), spelling));
}

}  // namespace limber
