#include "limber/actions/edit_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/error.h"
#include "limber/core/text/parse_number.h"
#include "limber/core/text/split_text.h"

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

std::vector<double> numbersOf(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string_view word : splitAt(text, ',')) {
    const std::optional<double> number = finiteNumber(word);
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
