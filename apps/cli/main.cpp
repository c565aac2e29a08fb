// limber: any 3D model becomes limber.
#include "program.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "command.h"
#include "limber/actions/option_spelling.h"
#include "limber/batch/batch_plan.h"
#include "limber/core/file/storage_error.h"
#include "limber/core/known_error.h"
#include "limber/core/text/printable.h"
#include "progress_line.h"

namespace {

constexpr int kFailed = 1, kUsage = 2, kInterrupted = 130;
constexpr const char* kAsksForHelp = "asks for help";

int fail(std::string_view what, int code = kFailed) {
  if (limber::cli::interrupted()) {
    fmt::print(stderr, "limber: interrupted\n");
    return kInterrupted;
  }
  fmt::print(stderr, "limber: {}\n", limber::printable(what));
  return code;
}

int codeOf(const limber::Error& error) {
  const auto* known = dynamic_cast<const limber::KnownError*>(&error);
  if (known && known->kind() == limber::ErrorKind::kOutOfMemory) return limber::cli::kOutOfMemoryCode;
  return dynamic_cast<const limber::StorageError*>(&error) ? limber::cli::kStorageCode : kFailed;
}

int fail(const limber::Error& error) {
  return fail(limber::spellOptions(error, limber::OptionSpelling::kProgram).what(), codeOf(error));
}

int usage(const CLI::App& program, const std::string& what) {
  std::string command;
  for (const CLI::App* at = &program; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  fmt::print(stderr, "limber: {} (limber{} --help shows how to call it)\n", limber::printable(what), command);
  return kUsage;
}

void addCommands(CLI::App& program) {
  using namespace limber::cli;
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
}

// Lets an option have no other values than these.
void allowOnly(CLI::Option& option, const std::vector<std::string>& values, const std::string& problem) {
  option.check(CLI::Validator(
      [values, problem](std::string& value) {
        return std::find(values.begin(), values.end(), value) != values.end() ? std::string() : problem;
      },
      ""));
}

// What a batch's plan may say: nothing that runs a program, nor that writes anything but the entry's output.
void restrictToBatch(CLI::App& program, const limber::cli::BatchCall& batch) {
  const std::vector<std::string> folders(batch.adapterFolders.begin(), batch.adapterFolders.end());
  for (CLI::App* command : program.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (limber::cli::isForPlans(*option)) continue;
      const bool isFolder = option->check_lname("adapter-folder");
      allowOnly(*option, isFolder ? folders : std::vector<std::string>(),
                isFolder ? "is given to limber batch itself, not by a plan"
                         : "is not for a batch's plan: it runs a program or writes beside the output");
    }
    if (CLI::Option* output = command->get_option_no_throw("--output")) {
      output->multi_option_policy(CLI::MultiOptionPolicy::Throw);
      allowOnly(*output, {batch.output}, fmt::format("has to be \"{}\" in a batch's plan", limber::kBatchOutput));
    }
    restrictToBatch(*command, batch);
  }
}

void addCommandsFor(const limber::cli::BatchCall* batch, CLI::App& program) {
  if (batch) program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  addCommands(program);
  if (batch) restrictToBatch(program, *batch);
}

void parseCall(CLI::App& program, const std::vector<std::string>& arguments) {
  program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 wants the last first
}

// Thrown instead of running a call. Its commands' callbacks cannot be removed: they own what parsing writes to.
struct CallMakesSense {};

// CLI11 would only say that a subcommand is missing. Empty where the words before the first option name commands.
std::string wrongCommand(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* at = &program;
  for (std::size_t i = 0; i >= arguments.size() || !arguments[i].starts_with('-'); ++i) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* command : at->get_subcommands({})) {
      known.push_back(command->get_name());
      if (i < arguments.size() && command->get_name() == arguments[i]) next = command;
    }
    if (known.empty() || at->get_require_subcommand_min() == 0) return {};
    const std::string there = limber::cli::joinNames(known);
    if (i >= arguments.size()) return fmt::format("a command is missing; there are: {}", there);
    if (!next) return fmt::format("there is no command '{}'; there are: {}", arguments[i], there);
    at = next;
  }
  return {};
}

}  // namespace

namespace limber::cli {

CallOutline outlineCall(const std::vector<std::string>& arguments, const BatchCall& batch) {
  CLI::App program;
  addCommandsFor(&batch, program);
  program.parse_complete_callback([] { throw CallMakesSense(); });
  CallOutline outline;
  outline.problem = wrongCommand(program, arguments);
  if (!outline.problem.empty()) return outline;
  try {
    parseCall(program, arguments);
  } catch (const CallMakesSense&) {
    // as it should
  } catch (const CLI::Success&) {
    outline.problem = kAsksForHelp;
  } catch (const CLI::ParseError& error) {
    outline.problem = error.what();
  }
  CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  outline.hasOutput = command->get_option_no_throw("--output") != nullptr;
  outline.hasThreads = command->get_option_no_throw("--threads") != nullptr;
  outline.hasAdapters = command->get_option_no_throw("--adapter-folder") != nullptr;
  return outline;
}

int runProgram(const std::vector<std::string>& arguments, const BatchCall* batch) {
  CLI::App program("Makes any 3D model limber: a static mesh goes in, a rigged and skinned character comes out.",
                   "limber");
  program.set_version_flag("--version", "limber " LIMBER_VERSION);
  addCommandsFor(batch, program);
  program.footer(
      "limber COMMAND --help shows the options of a command, with an example. The examples use files that those of\n"
      "limber sample --help make. Pages that are named as docs/scale.md are in the folder docs of the source, and in\n"
      "share/doc/limber of the .deb and the .tar.gz.");
  if (const std::string problem = wrongCommand(program, arguments); !problem.empty()) return usage(program, problem);
  try {
    try {
      parseCall(program, arguments);
    } catch (const CLI::Success& request) {  // --help, --version
      if (batch) return usage(program, kAsksForHelp);
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
  return limber::cli::runProgram({argv + std::min(argc, 1), argv + argc});
}
