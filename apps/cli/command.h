// Common code of the subcommands: how they are added, and where they print.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "limber/actions/option_spelling.h"
#include "limber/core/file/file.h"
#include "limber/core/known_error.h"
#include "limber/core/progress.h"
#include "limber/document/asset.h"

namespace limber::cli {

// Each adds its subcommand with a callback that runs it. The callback throws limber::Error.
void addRigCommand(CLI::App& program);
void addInfoCommand(CLI::App& program);
void addPreviewCommand(CLI::App& program);
void addSampleCommand(CLI::App& program);
void addEvaluateCommand(CLI::App& program);
void addPoseCommand(CLI::App& program);
void addConvertCommand(CLI::App& program);
void addPartsCommand(CLI::App& program);
void addSessionCommand(CLI::App& program);
void addRetargetCommand(CLI::App& program);
void addAnimateCommand(CLI::App& program);
void addStudioCommand(CLI::App& program);
void addTransferCommand(CLI::App& program);
void addStudyCommand(CLI::App& program);
void addBatchCommand(CLI::App& program);
void addCrowdCommand(CLI::App& program);
void addCompletionCommand(CLI::App& program);
void addMotionEvaluation(CLI::App& evaluate);  // subcommands of evaluate
void addRetargetingEvaluation(CLI::App& evaluate);
void addDecompositionEvaluation(CLI::App& evaluate);
void addHandleEvaluation(CLI::App& evaluate);
void addTransferEvaluation(CLI::App& evaluate);
void addVotesEvaluation(CLI::App& evaluate);

// The exit code of a command for which memory did not suffice.
inline constexpr int kOutOfMemoryCode = 3;

// Options that most commands have.
struct Common {
  bool quiet = false;
  int threads = 0;

  void addTo(CLI::App& command);
  void apply() const;  // sets the number of threads
};

// The account of what was done: on standard output, or on standard error where that carries a file. Names come from
// files: control characters in a line are shown, not obeyed (printable).
class Account {
 public:
  Account(bool quiet, std::string_view output) : quiet_(quiet), toError_(output == "-") {}
  void line(std::string_view text) const;

 private:
  bool quiet_, toError_;
};

// On standard error, a line for each kind.
void printWarnings(const Warnings& warnings, bool quiet);
// All that printWarnings was given since this process began, or since it was forked.
const Warnings& givenWarnings();
// Throws an Error that names the first warning if there is one.
void refuseWarnings(const Warnings& warnings);
// Throws an Error that names the first that was skipped, where nothing else is left to compare.
void refuseNothing(bool isEmpty, const Warnings& skipped);
std::string joinNames(const std::vector<std::string>& names);

// Throws Error kBadArgument unless the name ends in one of the extensions (".glb") or is "-".
void checkOutput(std::string_view path, const std::vector<std::string_view>& extensions);

// What `make` returns. An Error of its own that one option is to blame for is a wrong usage: CLI::ValidationError.
template <typename Make>
auto checkedOptions(const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    if (!isOption(error.where())) throw;
    throw CLI::ValidationError(spellOptions(error, OptionSpelling::kProgram).what());
  }
}

// A file written beside the result, named by `option`, must overwrite none of the others: throws
// CLI::ValidationError where it does, by whatever path.
void checkBeside(const std::string& option, const std::string& path, const std::vector<std::string>& others);

// -o for what is written in Markdown, "the table".
CLI::Option* addMarkdownOutput(CLI::App& command, std::string& output, std::string_view what);

// Marks an option that runs a program of the user's or names what is written beside the output: the user has it, a
// batch's plan does not.
CLI::Validator notForPlans();
bool isForPlans(CLI::Option& option);

// A number from `low` to `high`; CLI::Range lets NaN pass.
CLI::Validator numberIn(double low, double high);
// A whole number from 0; CLI11 takes -1 for the largest.
CLI::Validator seedNumber();
// A moment of a clip in seconds; one after its end is the end.
CLI::Validator momentOfClip();

// What `parse` makes of a file's text, or of standard input's. Its errors name the file.
template <typename Parse>
auto parsedFile(const std::string& file, const Parse& parse) {
  const Bytes bytes = readFile(file);
  try {
    return parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  } catch (const Error& error) {
    throwWithin(error, file == "-" ? "standard input" : file);
  }
}

// On standard output. Control characters in it, but for lines and tabs, are shown, not obeyed; so they are by
// writeText. Not for JSON, where they would no longer say what they are: dumpReport escapes them.
void printText(std::string_view text);
void writeText(const std::string& path, const std::string& text);
void printJson(const Json& json);
// Figures, as JSON or as lines for people.
template <typename Figures>
void printReport(const Figures& figures, bool asJson) {
  if (asJson) {
    printJson(toJson(figures));
  } else {
    printText(toText(figures));
  }
}
// Two texts, both or none; the first only where `pathBeside` is not empty.
void writeTexts(const std::string& pathBeside, const std::string& beside, const std::string& path,
                const std::string& text);
// Throws Error kFile where standard output did not take all that was printed.
void flushOutput();

}  // namespace limber::cli
