#include "combine_arguments.h"

#include <cmath>

#include <fmt/format.h>

#include "command.h"
#include "limber/core/text/parse_number.h"
#include "limber/core/text/split_text.h"

namespace limber::cli {

namespace {

constexpr double kMaxSteps = 101;

[[noreturn]] void refuseBlend(const std::string& text) {
  throw CLI::ValidationError(
      "--blend", fmt::format("'{}' is neither a weight from 0 to 1 nor FROM:TO:COUNT, such as 0:1:5 with a count of 2 "
                             "to {:g}",
                             text, kMaxSteps));
}

// "0.4", or "0:1:5": so many from the first to the last.
std::vector<double> weightsOf(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view word : splitAt(text, ':')) {
    const std::optional<double> number = finiteNumber(word);
    if (!number) refuseBlend(text);
    numbers.push_back(*number);
  }
  const auto isWeight = [](double number) { return number >= 0 && number <= 1; };
  if (numbers.size() == 1 && isWeight(numbers[0])) return numbers;
  if (numbers.size() != 3 || !isWeight(numbers[0]) || !isWeight(numbers[1])) refuseBlend(text);
  const double count = numbers[2];
  if (!(count >= 2 && count <= kMaxSteps) || count != std::floor(count)) refuseBlend(text);
  std::vector<double> weights;
  for (double i = 0; i < count; ++i) weights.push_back(std::lerp(numbers[0], numbers[1], i / (count - 1)));
  return weights;
}

}  // namespace

void CombineArguments::addTo(CLI::App& command) {
  CLI::Option* blend =
      command
          .add_option("--blend", blend_,
                      "one clip of two motions, step by step: 0 the first, 1 the second; 0:1:5 makes a set of five")
          ->type_name("WEIGHT");
  CLI::Option* crossfade =
      command
          .add_option("--crossfade", crossfade_,
                      "one clip of two motions, the second after the first, with a transition of so many seconds")
          ->check(numberIn(0.02, 10))
          ->type_name("SECONDS");
  CLI::Option* sequence = command.add_flag("--sequence", sequence_,
                                           "likewise of any number of motions; --crossfade says how long each "
                                           "transition takes, else 0.3 s");
  blend->excludes(crossfade);
  blend->excludes(sequence);
}

std::optional<CombineOptions> CombineArguments::options(std::size_t motions, bool byProgram) const {
  const char* option = !blend_.empty() ? "--blend" : sequence_ ? "--sequence" : "--crossfade";
  if (blend_.empty() && !sequence_ && !crossfade_) return std::nullopt;
  if (byProgram) throw CLI::ValidationError(option, "is for limber's own methods, not for a program of yours");
  CombineOptions options;
  if (!blend_.empty()) options.blendWeights = weightsOf(blend_);
  options.crossfadeSeconds = crossfade_.value_or(options.crossfadeSeconds);
  if (!sequence_ && motions > 2) {
    throw CLI::ValidationError(
        option, fmt::format("takes two motions, not {}{}", motions, blend_.empty() ? ": add --sequence" : ""));
  }
  return options;
}

}  // namespace limber::cli
