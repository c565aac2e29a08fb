// limber session: what was done in the studio, done again.
#include <algorithm>
#include <cctype>
#include <memory>

#include <fmt/format.h>

#include "command.h"
#include "limber/core/counted.h"
#include "limber/core/file/file.h"
#include "limber/document/read.h"
#include "limber/document/stored_archive.h"
#include "limber/session/scene/scene.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct SessionArguments {
  std::string commands, output;
  Common common;
};

// What was done, and where its files are.
struct Work {
  std::vector<Command> commands;
  Resolver files;
};

constexpr const char* kCommandsInArchive = "commands.json";

Work readWork(const std::string& path) {
  Bytes bytes = readFile(path);
  const auto parsed = [](ByteSpan text) {
    return commandsFromJson({reinterpret_cast<const char*>(text.data()), text.size()});
  };
  try {
    if (!looksLikeZipArchive(bytes)) return {parsed(bytes), folderResolver(std::filesystem::path(path).parent_path())};
    const auto kept = std::make_shared<const Bytes>(std::move(bytes));
    const auto archive = std::make_shared<const ZipArchive>(*kept, path);
    const std::optional<Bytes> list = archive->find(kCommandsInArchive);
    if (!list) {
      throw Error(ErrorCode::kBadData, fmt::format("holds no {}", kCommandsInArchive), path,
                  "is it a .limber file, as the studio saves it?");
    }
    return {parsed(*list), [kept, archive](std::string_view name) { return archive->find(std::string(name)); }};
  } catch (const Error& error) {
    if (error.where().starts_with(path)) throw;
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

std::string contentOf(const SessionScene& scene) {
  std::string text;
  for (const SceneMember& member : scene.members()) {
    text += fmt::format("{}{} with {}", text.empty() ? "" : ", ", member.session->source().name,
                        counted(member.session->state().rig->skeleton().jointCount(), "joint"));
  }
  return text;
}

void run(const SessionArguments& options) {
  options.common.apply();
  checkOutput(options.output, {".glb", ".obj", ".stl", ".ply"});
  const auto [commands, files] = readWork(options.commands);
  TerminalProgress progress(options.common.quiet);
  SessionScene scene(files);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    try {
      scene.run(commands[i], *progress);
    } catch (const Error& error) {
      throw error.within(fmt::format("{}: commands[{}]", options.commands, i));
    }
  }
  progress->stage("write");
  const Bytes bytes = scene.exportModel(formatOf(options.output));
  const OutputFile file{options.output, bytes};
  writeFiles({&file, 1});
  progress.finish();

  const Account account(options.common.quiet, options.output);
  account.line(fmt::format("{} done: {}", counted(commands.size(), "command"), contentOf(scene)));
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

}  // namespace

void addSessionCommand(CLI::App& program) {
  auto options = std::make_shared<SessionArguments>();
  CLI::App* command = program.add_subcommand("session", "Do again what was done in the studio");
  command->require_subcommand(1);
  command->footer(
      "Example:\n  limber sample dancing-stool -o commands.json\n  limber session replay commands.json -o posed.glb");
  CLI::App* replay = command->add_subcommand("replay", "Run a recorded list of commands and write the result");
  replay
      ->add_option("COMMANDS", options->commands,
                   "the list in JSON, or a .limber file, as the studio saves them; - is standard input")
      ->required();
  replay
      ->add_option(
          "-o,--output", options->output,
          "the .glb (rigged, standing in the pose; all models of a scene), .obj, .stl or .ply (the posed surfaces); - "
          "is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  options->common.addTo(*replay);
  replay->footer(
      "Models are opened beside the list, or in the .limber file. Commands are those of limber/session/command.h:\n"
      "  {\"limber_commands\": 2, \"commands\": [{\"do\": \"open_file\", \"file\": \"fox.glb\"},\n"
      "   {\"do\": \"set_handles\", \"count\": 20}, {\"do\": \"set_turn\", \"joint\": \"handle_03\", \"turn\": [0, "
      "30, 0],\n"
      "   \"relative\": true}]}\n"
      "Further models come into the scene by add_sample and add_file; choose_member says which one the commands behind "
      "it are for.\n"
      "\nExample:\n"
      "  limber sample dancing-stool -o commands.json\n"
      "  limber session replay commands.json -o posed.glb\n"
      "  limber session replay commands.json -o posed.stl");
  replay->callback([options] { run(*options); });

  CLI::App* types = command->add_subcommand("types", "Print the commands as a union of TypeScript types");
  types->footer("Example:\n  limber session types > commands.d.ts");
  types->callback([] { fmt::print("{}", commandTypes()); });
}

}  // namespace limber::cli
