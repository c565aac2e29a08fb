// limber: any 3D model becomes limber.
#include "program.h"

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "command.h"
#include "limber/core/known_error.h"
#include "limber/pipeline/option_spelling.h"
#include "progress_line.h"

namespace {

constexpr int kFailed = 1, kUsage = 2, kInterrupted = 130;

int fail(std::string_view what, int code = kFailed) {
  if (limber::cli::interrupted()) {
    fmt::print(stderr, "limber: interrupted\n");
    return kInterrupted;
  }
  fmt::print(stderr, "limber: {}\n", what);
  return code;
}

int fail(const limber::Error& error) {
  const auto* known = dynamic_cast<const limber::KnownError*>(&error);
  const bool isOutOfMemory = known && known->kind() == limber::ErrorKind::kOutOfMemory;
  return fail(limber::spellOptions(error, limber::OptionSpelling::kProgram).what(),
              isOutOfMemory ? limber::cli::kOutOfMemoryCode : kFailed);
}

int usage(const CLI::App& program, const std::string& what) {
  std::string command;
  for (const CLI::App* at = &program; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  fmt::print(stderr, "limber: {} (limber{} --help shows how to call it)\n", what, command);
  return kUsage;
}

// CLI11 would only say that a subcommand is missing. Empty where the words before the first option name commands.
std::string wrongCommand(const CLI::App& program, int argc, char** argv) {
  const CLI::App* at = &program;
  for (int i = 1; i >= argc || argv[i][0] != '-'; ++i) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* command : at->get_subcommands({})) {
      known.push_back(command->get_name());
      if (i < argc && command->get_name() == argv[i]) next = command;
    }
    if (known.empty() || at->get_require_subcommand_min() == 0) return {};
    if (i >= argc) return fmt::format("a command is missing; there are: {}", limber::cli::joinNames(known));
    if (!next) return fmt::format("there is no command '{}'; there are: {}", argv[i], limber::cli::joinNames(known));
    at = next;
  }
  return {};
}

}  // namespace

namespace limber::cli {

int runProgram(int argc, char** argv) {
  CLI::App program("Makes any 3D model limber: a static mesh goes in, a rigged and skinned character comes out.",
                   "limber");
  program.set_version_flag("--version", "limber " LIMBER_VERSION);
  program.require_subcommand(1);
  addRigCommand(program);
  addInfoCommand(program);
  addPreviewCommand(program);
  addSampleCommand(program);
  addEvaluateCommand(program);
  addPoseCommand(program);
  addConvertCommand(program);
  addPartsCommand(program);
  addSessionCommand(program);
  addRetargetCommand(program);
  addAnimateCommand(program);
  addTransferCommand(program);
  addStudyCommand(program);
  addStudioCommand(program);
  addBatchCommand(program);
  addCrowdCommand(program);
  addCompletionCommand(program);
  program.footer("limber COMMAND --help shows the options of a command, with an example.");
  if (const std::string problem = wrongCommand(program, argc, argv); !problem.empty()) return usage(program, problem);
  try {
    try {
      program.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help, --version
      program.exit(request);
    }
    flushOutput();
    return 0;
  } catch (const CLI::RuntimeError& error) {  // of a command with exit codes of its own
    return fail(error.what(), error.get_exit_code());
  } catch (const CLI::ParseError& error) {
    return usage(program, error.what());
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory for this", kOutOfMemoryCode);
  } catch (const Error& error) {
    return fail(error);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}

}  // namespace limber::cli

int main(int argc, char** argv) {
  return limber::cli::runProgram(argc, argv);
}
