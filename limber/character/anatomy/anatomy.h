// Which joint of a skeleton is what of a body: the one reading that matching, retargeting, limits, evaluation and the
// studio ask.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/joint_tree.h"
#include "limber/skeleton/pose.h"

namespace limber {

enum class PartKind {
  kTrunk,
  kNeck,
  kHead,
  kTail,
  kLeg,
  kArm,
  kWing,
  kFin,
  kFinger,
  kEar,
  kJaw,
  kEye,
  kHair,
  kProp,
  kAttachment,  // clothes, straps, breasts, leaf joints, controls: what belongs to no limb and moves with its carrier
  kOther
};
enum class Side { kCenter, kLeft, kRight };  // the body's own

inline constexpr std::size_t kPartKinds = 16;  // of PartKind
inline constexpr double kDoubtful = 0.75;      // probability: of what is less sure one in four may be wrong

std::string_view nameOf(PartKind kind);  // "leg"
std::string_view nameOf(Side side);      // "left"
std::optional<PartKind> partKindNamed(std::string_view name);
std::optional<Side> sideNamed(std::string_view name);
Side opposite(Side side);

// What a label rests on; bones that the file declares are names, too.
enum class Evidence { kForm, kNames, kBoth, kUser };
std::string_view nameOf(Evidence evidence);

// Joints that belong together, and the landmarks along them, as far as the part has them.
struct Part {
  PartKind kind = PartKind::kOther;
  Side side = Side::kCenter;
  Index pair = 0;               // 0: the foremost of its kind; of fingers the thumb or the innermost
  std::vector<Index> joints;    // along it, where it hangs first, with twist joints where they sit
  std::vector<Index> branches;  // what branches off it and is no part of its own: feathers, face bones, a second pelvis
  // Of legs and arms. `upper`: hip or shoulder; joints before it (collars, shoulder blades) are the limb's base.
  // `middle`: knee or elbow. `hock`: the raised heel, or wrist, of a digitigrade leg. `end`: ankle or wrist, or the
  // ball or hoof on which a digitigrade leg rests. `toes`: the first joint after the end, of feet.
  std::optional<Index> upper, middle, hock, end, toes;
  std::optional<std::size_t> carrier;  // the part to which it is attached; none for the trunk and for unattached parts
  double confidence = 0;               // probability that kind, side and landmarks are right
  Evidence evidence = Evidence::kForm;

  bool has(Index joint) const;
};

// Orthonormal; left = up x front.
struct Axes {
  Vec3 up = Vec3::UnitY(), front = Vec3::UnitZ();
  Vec3 left() const { return up.cross(front); }
};

struct Anatomy {
  Axes axes;                                       // in the skeleton's space
  double ground = 0;                               // height of the lowest joint of the body, along `axes.up`
  double size = 0;                                 // of the box around the body's joints, from corner to corner
  std::vector<Part> parts;                         // the trunk first; a part's carrier before it
  std::vector<std::optional<std::size_t>> partOf;  // #J
  double confidence = 0;                           // of the axes and of which side is left
  bool believesFile = true;                        // false: no body can have the bones that the file declares
  std::string_view convention;                     // whose names are certain here, "Mixamo"; empty: nobody's
  std::optional<Index> declaredHips;               // what the file or the convention calls the hips
  std::vector<Index> contradicted;                 // joints whose names in that convention the tree contradicts

  const Part* find(PartKind kind, Side side = Side::kCenter, Index pair = 0) const;
  Index pairsOf(PartKind kind) const;  // how many pairs (or single ones) there are
  // The trunk, the head, and the left and the right leg of the first pair; none unless all are there and read with a
  // confidence of kDoubtful or more.
  std::optional<std::array<const Part*, 4>> certainBody() const;
};

// A label that the user has set: all else is read around it.
struct FixedLabel {
  Index joint = 0;
  PartKind kind = PartKind::kOther;
};

struct AnatomyOptions {
  bool names = true;  // whether joints' names, and the bones that the file declares them to be, have a say
  std::span<const FixedLabel> fixed;
  // The pose is a frame of a motion, in which limbs may be anywhere: the sides of a convention's names count more than
  // what form says of left and right.
  bool sidesByNames = false;
};

// The body of a skeleton in a pose. A conditional random field over the folded skeleton (half_body.h): each joint's
// state (a kind, for limbs with the segment) has a score by where and how it lies and by its name, each pair of parent
// and child one for their states; the weights are learned from labelled skeletons (tools/fit_anatomy.cpp). Up, front
// and left are inferred along with the states: each possible direction is a hypothesis, and the likeliest is chosen.
// Confidences are the field's own marginals. Lafferty, McCallum, Pereira 2001; exact inference on trees. Bones that the
// file declares (Joint::declaredBone) are certain, and so are left and right where they have sides; all else is
// inferred around them. They are ignored only where no body can have them in that hierarchy.
//
// Any finite skeleton gets an answer; a body without any form (all joints at one position) has all joints in one trunk
// or in none. Throws Error kBadData where a position is not finite. Cost: about linear in the joints; 0.6 ms for 100.
Anatomy readAnatomy(const Skeleton& skeleton, const Pose& pose, const AnatomyOptions& options = {});
Anatomy readAnatomy(const Skeleton& skeleton, const AnatomyOptions& options = {});

// The skeleton with the declared bones that this reading of it believes: all or none.
Skeleton believedSkeleton(Skeleton skeleton, const Anatomy& anatomy);

}  // namespace limber
