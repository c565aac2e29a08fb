#include "limber/pipeline/option_spelling.h"

#include <algorithm>
#include <cstddef>

namespace limber {

namespace {

// "max-influences" or "existing-rig: replace".
struct WrittenOption {
  std::string_view name, value;
};

bool isOptionWord(std::string_view word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
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
    const std::string_view inside = text.substr(open + 1, close - open - 1);
    const std::size_t colon = inside.find(": ");
    const bool hasValue = colon != std::string_view::npos;
    const WrittenOption option{inside.substr(0, colon), hasValue ? inside.substr(colon + 2) : std::string_view()};
    const bool isOption = isOptionWord(option.name) && (!hasValue || isOptionWord(option.value));
    result += text.substr(0, isOption ? open : close);  // a backtick that closes nothing may open
    if (isOption) result += spelled(option, spelling);
    text.remove_prefix(isOption ? close + 1 : close);
  }
  return result + std::string(text);
}

}  // namespace limber
