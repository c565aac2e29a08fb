// limber evaluate transfer: rigs transferred between characters, against their artists' own.
#include <filesystem>

#include "command.h"
#include "limber/actions/transfer/transfer_asset.h"
#include "limber/evaluate/skin/transfer_table.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct TransferTrialArguments {
  std::vector<std::string> folders;
  std::string each, output = "-";
  TransferTrialOptions trials;
  Common common;
};

// "creatures/tune"
std::string folderName(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.has_filename() ? folder : folder.parent_path();
  const std::string above = path.parent_path().filename().string();
  return above.empty() || above == "data" ? path.filename().string() : above + "/" + path.filename().string();
}

void runTransferTrials(const TransferTrialArguments& options) {
  options.common.apply();
  checkOutput(options.output, {".md"});
  if (!options.each.empty()) checkOutput(options.each, {".tsv"});
  checkBeside("--each", options.each, {options.output});
  TerminalProgress progress(options.common.quiet);
  Warnings skipped;
  std::vector<TransferFolder> folders;
  bool isEmpty = true;
  for (const std::string& folder : options.folders) {
    const auto transfer = [](const Asset& source, Asset& target) {
      Progress unheard;
      transferOnto(source, target, {}, unheard);
    };
    folders.push_back({folderName(folder), tryTransfers(folder, options.trials, transfer, *progress, skipped)});
    isEmpty = isEmpty && folders.back().trials.empty();
  }
  refuseNothing(isEmpty, skipped);
  writeTexts(options.each, toTsv(eachTransferTrial(folders)), options.output, toMarkdown(transferTable(folders)));
  printWarnings(skipped, options.common.quiet);
}

}  // namespace

void addTransferEvaluation(CLI::App& evaluate) {
  auto options = std::make_shared<TransferTrialArguments>();
  CLI::App* command =
      evaluate.add_subcommand("transfer", "Transfer rigs between people and compare with their artists' own");
  command->add_option("FOLDER", options->folders, "folders with rigged characters")->required();
  command->add_option("--sources", options->trials.maxSources, "rigs for each target: of its own joints, and of others")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--each", options->each, "write the figures of each pair, tab separated (.tsv)")
      ->check(notForPlans())
      ->type_name("FILE");
  addMarkdownOutput(*command, options->output, "the table");
  options->common.addTo(*command);
  command->footer(
      "Every person of a folder loses its rig and takes those of others there: of some whose joints have the same "
      "names,\n"
      "and of some of other makers. Joints are compared by what they are of a body, weights by joints of one name or,\n"
      "between makers, by parts of the body; what is out of reach are weights on joints that hold nothing in the "
      "source.\n"
      "\nExample:\n  limber evaluate transfer characters --each pairs.tsv");
  command->callback([options] { runTransferTrials(*options); });
}

}  // namespace limber::cli
