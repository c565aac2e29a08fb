#include "limber/evaluate/rig/body_joints.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string_view>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/character/anatomy/names/humanoid_words.h"

namespace limber {

namespace {

constexpr double kMoves = 0.1;          // of a vertex's weight
constexpr double kSamePosition = 1e-3;  // of the extent of all joints
constexpr std::array<std::string_view, 11> kNoBody = {"end",    "tip",  "leaf", "nub",    "site",   "ear",
                                                      "weapon", "hair", "slot", "breast", "stomach"};

// Joints that count: those marked, and those that have a marked one above and one below.
std::vector<bool> withBetween(const Skeleton& skeleton, const std::vector<bool>& marked) {
  const Index count = skeleton.jointCount();
  std::vector<bool> above(count, false), below(marked), result(marked);
  for (Index j = 0; j < count; ++j) {
    if (const auto parent = skeleton.joints[j].parent) above[j] = above[*parent] || marked[*parent];
  }
  for (Index j = count; j-- > 0;) {
    if (below[j] && skeleton.joints[j].parent) below[*skeleton.joints[j].parent] = true;
  }
  for (Index j = 0; j < count; ++j) result[j] = marked[j] || (above[j] && below[j]);
  return result;
}

bool isNoBody(const std::string& name) {
  const std::vector<std::string> words = detail::wordsOfName(name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return std::find(kNoBody.begin(), kNoBody.end(), word) != kNoBody.end();
  });
}

bool endsWith(std::string_view bone, std::string_view part) {
  return bone.size() >= part.size() && bone.substr(bone.size() - part.size()) == part;
}

// The tree that each counting joint belongs to, by its first joint.
std::vector<Index> treesOf(const std::vector<std::optional<Index>>& above) {
  std::vector<Index> tree(above.size());
  for (Index j = 0; j < tree.size(); ++j) tree[j] = above[j] ? tree[*above[j]] : j;
  return tree;
}

}  // namespace

std::vector<bool> countedJoints(const SkinnedModel& model) {
  std::vector<bool> counts(model.skeleton.jointCount(), false);
  const std::size_t slots = model.weights.slots;
  for (std::size_t v = 0; slots > 0 && v < model.weights.weights.size() / slots; ++v) {
    double whole = 0;
    for (std::size_t s = 0; s < slots; ++s) whole += model.weights.weights[v * slots + s];
    for (std::size_t s = 0; s < slots; ++s) {
      const double weight = model.weights.weights[v * slots + s];
      if (weight > 0 && weight >= kMoves * whole) counts[model.weights.joints[v * slots + s]] = true;
    }
  }
  for (const HumanoidJoint& named : humanoidJoints(model.skeleton)) {
    if (named.bone != "hips") counts[named.joint] = true;  // the hips are called so on the ground as well
  }
  return withBetween(model.skeleton, counts);
}

std::vector<bool> bodyJoints(const Skeleton& skeleton, std::vector<bool> counted) {
  const Index count = skeleton.jointCount();
  std::vector<std::string_view> plays(count);
  for (const HumanoidJoint& named : humanoidJoints(skeleton)) plays[named.joint] = named.bone;
  std::vector<bool> out(count, false), ends(count, false);  // ends: what hangs on it is out
  std::vector<detail::BodyWord> words;
  for (Index j = 0; j < count; ++j) {
    const std::string_view bone = plays[j];
    words.push_back(detail::readBodyName(skeleton.joints[j].name).word);
    const bool hand = words[j] == detail::BodyWord::kHand || endsWith(bone, "Hand");
    ends[j] = hand || words[j] == detail::BodyWord::kHead || endsWith(bone, "Foot") || endsWith(bone, "Toes");
    out[j] = words[j] >= detail::BodyWord::kThumb || (bone.empty() && isNoBody(skeleton.joints[j].name));
    if (const std::optional<Index> parent = skeleton.joints[j].parent) {
      const bool toes = endsWith(bone, "Toes") && endsWith(plays[*parent], "Foot");
      const bool goesOn = words[j] == words[*parent] && words[j] != detail::BodyWord::kNone;  // wrist and hand
      out[j] = out[j] || out[*parent] || (ends[*parent] && !toes && !goesOn);
    }
    if (out[j]) counted[j] = false;
  }
  return counted;
}

BodyFigure figureOf(const Skeleton& skeleton, const std::vector<bool>& counts) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  Box box;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (counts[j]) box.add(globals[j].translation());
  }
  BodyFigure figure;
  std::vector<std::optional<Index>> kept(skeleton.jointCount());  // a joint's index in the figure
  std::vector<std::optional<Index>> above;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!counts[j]) continue;
    const Vec3 position = globals[j].translation();
    const auto same = std::find_if(figure.joints.begin(), figure.joints.end(), [&](const Vec3& other) {
      return (other - position).norm() <= kSamePosition * box.longestSide();
    });
    if (same != figure.joints.end()) {
      kept[j] = static_cast<Index>(same - figure.joints.begin());
      continue;
    }
    std::optional<Index> parent = skeleton.joints[j].parent;
    while (parent && !counts[*parent]) parent = skeleton.joints[*parent].parent;
    kept[j] = static_cast<Index>(figure.joints.size());
    above.push_back(parent ? kept[*parent] : std::nullopt);
    figure.joints.push_back(position);
  }
  const std::vector<Index> tree = treesOf(above);
  std::vector<Index> sizes(tree.size(), 0);
  for (const Index first : tree) ++sizes[first];
  const auto largest = static_cast<Index>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (Index j = 0; j < tree.size(); ++j) {
    std::optional<Index> from = above[j];
    double least = std::numeric_limits<double>::infinity();
    for (Index other = 0; !above[j] && j != largest && other < tree.size(); ++other) {
      const double apart = (figure.joints[other] - figure.joints[j]).norm();
      if (tree[other] != largest || apart >= least) continue;
      least = apart;
      from = other;
    }
    if (from) figure.bones.push_back({figure.joints[*from], figure.joints[j]});
  }
  return figure;
}

}  // namespace limber
