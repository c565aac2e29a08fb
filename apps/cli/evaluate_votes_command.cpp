// limber evaluate votes: methods ranked by what people chose, two results at a time.
#include <memory>

#include <nlohmann/json.hpp>

#include "command.h"
#include "limber/study/ranking/vote_ranking.h"
#include "vote_files.h"

namespace limber::cli {

namespace {

struct VotesArguments {
  std::vector<std::string> files;
  std::string output = "-";
  bool json = false;
};

void runVotes(const VotesArguments& arguments) {
  checkOutput(arguments.output, {".md"});
  const std::vector<Vote> votes = readVotes(arguments.files);
  if (votes.empty()) {
    throw Error(ErrorCode::kBadData, "no vote was cast", arguments.files.front(),
                "open a study's index.html and vote under \"By eye\"");
  }
  const std::vector<VoteRanking> rankings = rankByVotes(votes);
  if (arguments.json) {
    printJson(toJson(rankings));
  } else {
    writeText(arguments.output, toMarkdown(voteTables(rankings)));
  }
}

}  // namespace

void addVotesEvaluation(CLI::App& evaluate) {
  auto arguments = std::make_shared<VotesArguments>();
  CLI::App* command =
      evaluate.add_subcommand("votes", "Rank methods by what people chose in the blind ballot of a study's page");
  command->add_option("VOTES", arguments->files, "votes.csv files that the page saved")->required();
  CLI::Option* json = command->add_flag("--json", arguments->json, "print JSON");
  addMarkdownOutput(*command, arguments->output, "the tables")->excludes(json);
  command->footer(
      "chosen: share of a method's votes that went to it, \"alike\" half to each. strength: the chance that it is\n"
      "chosen beside a method of middling strength, whatever it happened to stand beside (Bradley-Terry), with the\n"
      "95 % interval of a bootstrap over the votes. p: sign test of each two, after Holm. A voter has one vote on\n"
      "each two results; the last one counts.\n"
      "\nThe file's columns: voter, kind (rig, retarget), subject, first, second, choice (first, second, alike).\n"
      "\nExample:\n  limber evaluate votes anna.csv ben.csv -o by_eye.md");
  command->callback([arguments] { runVotes(*arguments); });
}

}  // namespace limber::cli
