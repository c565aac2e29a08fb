// A named skeleton that is to be fitted into a model.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// Where a joint's position comes from.
enum class TemplateRole {
  kPlaced,   // read off the model, or pinned
  kBetween,  // follows from the placed joints above and below it
  kTip,      // where the last bone of a limb ends; no joint of the result
};

struct TemplateJoint {
  std::string name;
  std::optional<Index> parent;   // before the joint
  Vec3 position = Vec3::Zero();  // x to the body's left, y up from 0 (lowest) to 1 (highest), z to the front
  TemplateRole role = TemplateRole::kPlaced;
  std::optional<Index> mirror;  // the joint of the other side; none for joints of the middle
};

struct TemplateSkeleton {
  std::string name;
  std::vector<TemplateJoint> joints;

  Index jointCount() const { return static_cast<Index>(joints.size()); }
  std::optional<Index> find(std::string_view joint) const;
};

// Given positions in body space (AnatomicalFrame), one for each joint.
using TemplatePins = std::vector<std::optional<Vec3>>;

// Whether every pin has its mirror image: of the joint of the other side, of its own in the middle.
bool pinnedEvenly(const TemplateSkeleton& skeleton, const TemplatePins& pins);

// The templates that limber knows: humanoid, humanoid-fingers, quadruped, bird.
std::span<const TemplateSkeleton> templateSkeletons();
const TemplateSkeleton* findTemplate(std::string_view name);  // null where there is none

// A user's skeleton as a template: positions from its rest pose, in its own orientation (up is +Y, front +Z); every
// leaf gets a tip, unless it is one by its name ("..._end"). Sides are inferred from names (left and right, .L and
// .R), and their positions must mirror each other.
// Throws Error kBadData naming the joint: as checkSkeleton does; no joint at all; all joints at one height.
TemplateSkeleton templateFrom(const Skeleton& skeleton, std::string_view name);

}  // namespace limber
