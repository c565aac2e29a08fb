#include "limber/actions/edit_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/error.h"
#include "limber/core/text/parse_number.h"

namespace limber {

namespace {

constexpr std::size_t kNamesListed = 12;

}  // namespace

std::string inQuotes(std::string_view text) {
  return fmt::format("'{}'", text);
}

void failText(std::string_view text, std::string message, std::string remedy) {
  throw Error(ErrorCode::kBadArgument, std::move(message), inQuotes(text), std::move(remedy));
}

std::optional<double> numberOf(std::string_view word) {
  const char* at = word.data();
  const char* const end = at + word.size();
  const std::optional<double> value = parseNumber(at, end);
  return value && at == end && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string_view> splitAt(char separator, std::string_view text) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t end = text.find(separator);
    words.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

std::vector<double> numbersOf(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string_view word : splitAt(',', text)) {
    const std::optional<double> number = numberOf(word);
    if (!number) return {};
    numbers.push_back(*number);
  }
  if (numbers.size() != count) numbers.clear();
  return numbers;
}

Index requireJoint(const Skeleton& skeleton, const std::string& name, const std::string& where) {
  if (const std::optional<Index> joint = skeleton.find(name)) return *joint;
  const std::span<const std::string_view> bones = humanoidBones();
  if (std::find(bones.begin(), bones.end(), name) != bones.end()) {
    for (const HumanoidJoint& one : humanoidJoints(skeleton)) {
      if (one.bone == name) return one.joint;
    }
  }
  std::string known;
  for (std::size_t j = 0; j < std::min(kNamesListed, skeleton.joints.size()); ++j) {
    known += (j == 0 ? "" : ", ") + skeleton.joints[j].name;
  }
  if (skeleton.joints.size() > kNamesListed) known += ", ...";
  throw Error(ErrorCode::kBadArgument, fmt::format("no joint is called '{}'", name), where, "there are: " + known);
}

}  // namespace limber
