// limber session: what was done in the studio, done again.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "command.h"
#include "limber/asset/read.h"
#include "limber/core/counted.h"
#include "limber/core/file.h"
#include "limber/session/session.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct SessionArguments {
  std::string commands, output;
  Common common;
};

std::vector<Command> readCommands(const std::string& path) {
  const Bytes bytes = readFile(path);
  try {
    return commandsFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const Error& error) {
    throw error.within(path);
  }
}

ExportFormat formatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".obj") return ExportFormat::kObj;
  if (extension == ".stl") return ExportFormat::kStl;
  return extension == ".ply" ? ExportFormat::kPly : ExportFormat::kGlb;
}

void run(const SessionArguments& options) {
  options.common.apply();
  checkOutput(options.output, {".glb", ".obj", ".stl", ".ply"});
  const std::vector<Command> commands = readCommands(options.commands);
  TerminalProgress progress(options.common.quiet);
  Session session(folderResolver(std::filesystem::path(options.commands).parent_path()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    try {
      session.run(commands[i], *progress);
    } catch (const Error& error) {
      throw error.within(fmt::format("{}: commands[{}]", options.commands, i));
    }
  }
  progress->stage("write");
  const Bytes bytes = session.exportModel(formatOf(options.output));
  const OutputFile file{options.output, bytes};
  writeFiles({&file, 1});
  progress.finish();

  const Account account(options.common.quiet, options.output);
  account.line(fmt::format("{} done: {} with {}", counted(commands.size(), "command"), session.source().name,
                           counted(session.state().rig->skeleton().jointCount(), "joint")));
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

}  // namespace

void addSessionCommand(CLI::App& program) {
  auto options = std::make_shared<SessionArguments>();
  CLI::App* command = program.add_subcommand("session", "Do again what was done in the studio");
  command->require_subcommand(1);
  command->footer("Example:\n  limber session replay commands.json -o posed.glb");
  CLI::App* replay = command->add_subcommand("replay", "Run a recorded list of commands and write the result");
  replay->add_option("COMMANDS", options->commands, "the list in JSON, as the studio saves it; - is standard input")
      ->required();
  replay
      ->add_option(
          "-o,--output", options->output,
          "the .glb (rigged, standing in the pose), .obj, .stl or .ply (the posed surface); - is standard output "
          "(GLB)")
      ->required()
      ->type_name("FILE");
  options->common.addTo(*replay);
  replay->footer(
      "Models are opened beside the list. Commands are those of limber/session/command.h:\n"
      "  {\"limber_commands\": 1, \"commands\": [{\"do\": \"open_file\", \"file\": \"fox.glb\"},\n"
      "   {\"do\": \"set_handles\", \"count\": 20}, {\"do\": \"turn_joint\", \"joint\": \"handle_03\", \"axis\": [0, "
      "1, 0],\n"
      "   \"degrees\": 30}]}\n"
      "\nExample:\n"
      "  limber session replay commands.json -o posed.glb");
  replay->callback([options] { run(*options); });
}

}  // namespace limber::cli
