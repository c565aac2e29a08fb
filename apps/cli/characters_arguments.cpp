#include "characters_arguments.h"

#include <fmt/format.h>

#include "command.h"
#include "limber/core/counted.h"
#include "progress_line.h"

namespace limber::cli {

void CharactersArguments::addTo(CLI::App& command) {
  const char* group = "Many characters (docs/crowds.md)";
  CLI::Option* option =
      command
          .add_option("--characters", list,
                      "a file with a rigged model a line, in place of MODEL; OUTPUT is then the folder to write")
          ->type_name("FILE")
          ->group(group);
  command.add_flag("--separate", isSeparate, "a file for each motion of a character, not one with all its clips")
      ->needs(option)
      ->group(group);
  std::vector<std::string> formats;
  for (const std::string_view extension : modelExtensions()) formats.emplace_back(extension.substr(1));
  command.add_option("--format", format, "of the files in the folder")
      ->needs(option)
      ->check(CLI::IsMember(formats))
      ->type_name("NAME")
      ->capture_default_str()
      ->group(group);
}

CharactersJob CharactersArguments::job() const {
  CharactersJob job;
  job.characters = readCharacterList(list);
  job.extension = "." + format;
  job.isSeparate = isSeparate;
  return job;
}

void CharactersArguments::run(const CharactersJob& job, bool isQuiet) const {
  TerminalProgress progress(isQuiet);
  const CharactersReport report = retargetCharacters(job, *progress);
  progress.finish();
  const Account account(isQuiet, {});
  account.line(fmt::format("{} of {}, {} of skeletons: written to {}", counted(report.files, "file"),
                           counted(job.characters.size(), "character"), counted(report.matches, "match", "matches"),
                           job.folder.string()));
  for (const CharacterFailures& one : report.failures) {
    account.line(fmt::format("  {:>7} failed: {} (such as {})", one.count, one.problem, one.example.string()));
  }
  printWarnings(report.warnings, isQuiet);
  if (report.failed == 0) return;
  const CharacterFailures& first = report.failures.front();
  throw Error(ErrorCode::kBadData, fmt::format("{} failed, first: {}", counted(report.failed, "file"), first.problem),
              first.example.string(), "the others are written");
}

}  // namespace limber::cli
