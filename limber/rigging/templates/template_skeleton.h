// A named skeleton that is to be fitted into a model, with what is known of how models differ from it.
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
  kPlaced,   // searched for in the model
  kBetween,  // follows from the placed joints above and below it
  kTip,      // the end of a limb: searched for at the model's ends; no joint of the result
};

struct TemplateJoint {
  std::string name;
  std::optional<Index> parent;   // before the joint
  Vec3 position = Vec3::Zero();  // x to the body's left, y up from 0 (lowest) to 1 (highest), z to the front
  TemplateRole role = TemplateRole::kPlaced;
  double lengthSpread = 0.4;  // standard deviation of the logarithm of the bone's length (from the placed joint above)
  double turnSpread = 0.5;    // of its direction, radians
  std::optional<Index> mirror;  // the joint of the other side; none for joints of the middle
};

struct TemplateSkeleton {
  std::string name;
  std::string summary;  // one line for --help
  std::vector<TemplateJoint> joints;
  // #J, the joints' positions in the neutral pose, if those of `joints` are of another pose; else empty. In another
  // pose each side has its own positions, neither is the mirror image of the other.
  std::vector<Vec3> standing = {};
  bool bent() const { return !standing.empty(); }

  Index jointCount() const { return static_cast<Index>(joints.size()); }
  std::optional<Index> find(std::string_view joint) const;
};

// The nearest joint above that is not one between; the root, which may be one, where there is no other. Not of the
// root.
Index placedAbove(const TemplateSkeleton& skeleton, Index joint);

// The templates that limber knows: humanoid, humanoid-fingers, quadruped, bird.
std::span<const TemplateSkeleton> templateSkeletons();
// Throws Error kBadArgument that lists the names there are.
const TemplateSkeleton& findTemplate(std::string_view name);

struct TemplateVariant {
  TemplateSkeleton skeleton;
  double cost = 0;  // to be added to an embedding's: how rare such bodies are
};

// The template itself; for a person also with shorter legs, a larger head and longer arms, as toys and cartoons have
// them; for a four-legged animal also with a low head and a long body; for a bird also as it flies.
std::vector<TemplateVariant> templateVariants(const TemplateSkeleton& skeleton);

// A user's skeleton as a template: positions from its rest pose, in its own orientation (up is +Y, front +Z); joints
// that part the tree, end it or bend it are placed, the others lie between; every leaf gets a tip, unless it is one by
// its name ("..._end"). Sides are inferred from names (left and right, .L and .R), and their positions must mirror each
// other.
// Throws Error kBadData naming the joint: as checkSkeleton does; no joint at all; all joints at one height.
TemplateSkeleton templateFrom(const Skeleton& skeleton, std::string_view name);

}  // namespace limber
