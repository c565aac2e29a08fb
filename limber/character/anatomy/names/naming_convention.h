// Naming conventions of skeletons: what programs, capture systems and file formats call the joints of a body, as data.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/part_states.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// What a convention calls a joint.
enum class JointRole : unsigned char {
  kRoot,        // above the body: no part of it
  kHelper,      // IK targets, poles, position markers: no part of the body
  kAttachment,  // clothes, breasts, correctives, and what else is attached to the body
  kHips,
  kTrunk,
  kSpineToHead,  // a numbered spine that goes on into neck and head: its last joint is the head
  kNeck,
  kHead,
  kJaw,
  kEye,
  kTip,  // where the bone of its parent ends
  kCollar,
  kUpperArm,  // with twist joints of it, as have the next ones
  kLowerArm,
  kHand,
  kLegBase,  // between the hips and the upper leg
  kUpperLeg,
  kLowerLeg,
  kHock,
  kFoot,
  kToes,
  kPalm,  // a metacarpal whose finger its name does not say
  kThumb,
  kIndex,
  kMiddle,
  kRing,
  kLittle,
  kTail,
  kHair,
  kEar,
  kWing
};

// The names of one role, separated by spaces. In a name
//   @          is the side, as NamingConvention::sides writes it; % the same as NamingConvention::otherSides does
//   # ## ###   is the joint's number in its chain, from 1, of one, two or three digits at least
//   [...]      is left out of the first joint of a chain, so that numbers begin with the second
//   ~          at its beginning: of variants, which are read; the convention's own files have another name
//   =          at its beginning: without the convention's prefix
// Several names without a number are those of a chain, from its beginning; a numbered one behind them counts the joints
// that follow. Upper and lower case, blanks and separators (_ . - :) make no difference to readers.
struct RoleNames {
  JointRole role = JointRole::kHelper;
  std::string_view names;
  int pair = 0;  // of legs: 0 the fore legs of animals, or the only pair, 1 the hind legs
};

// How the lower body and the arms are attached.
enum class TorsoTree : unsigned char {
  kHipsCarryAll,     // legs and spine are children of the hips, arms of the chest
  kLowerBodyBeside,  // legs are children of the hips, which lie beside the spine on a joint of their own
  kArmsOnNeck        // as the first, but the arms are children of the neck
};

struct NamingConvention {
  std::string_view name;                            // "Mixamo"
  std::string_view prefix;                          // that its own files put before every name; may be any or none
  std::array<std::string_view, 2> sides;            // left, right
  std::array<std::string_view, 2> otherSides = {};  // likewise, of the few names that write it differently
  std::span<const RoleNames> roles;
  std::string_view documentation;  // where the names are documented: a page, or a repository and a file
  TorsoTree torso = TorsoTree::kHipsCarryAll;
};

// Humans first, then animals.
std::span<const NamingConvention> namingConventions();

// What a joint is by its convention.
struct NamedRole {
  JointRole role = JointRole::kHelper;
  Side side = Side::kCenter;
  int pair = 0;
};

struct ConventionMatch {
  const NamingConvention* convention = nullptr;
  std::vector<std::optional<NamedRole>> roles;  // #J; none: the convention does not name it
  std::vector<std::optional<Index>> partners;   // #J, the joint of the other side with the same name
  // Joints that the names say to be something that the tree contradicts, as a shin above its thigh: what their names
  // say is evidence, no more, and they have no role.
  std::vector<Index> contradicted;
};

// The convention that names most of the skeleton's joints, where it names enough of a body (kMinCoreJoints), most of
// what it names is attached as the body's parts are, and the limbs are those of its bodies (no animal on arms, no third
// bone). Any prefix that all names have is passed over, and numbers that exporters put behind every name. Cost: a few
// look-ups a joint, 20 us for 60 joints.
std::optional<ConventionMatch> findConvention(const Skeleton& skeleton);

// Mean position of the joints that have one of these roles; none where no joint has. jointRoles, positions: #J.
std::optional<Vec3> meanPosition(std::span<const std::optional<NamedRole>> jointRoles, std::span<const Vec3> positions,
                                 std::initializer_list<JointRole> roles);

// The segment of a limb, or the part, that a role is; none for those that may be several things (tips, helpers, ...).
std::optional<PartState> stateOf(JointRole role);

// A chain's joint as the convention spells it: `number` counts from 0 along the joints of that role. Empty where the
// convention has no such name.
std::string conventionName(const NamingConvention& convention, JointRole role, Side side, std::size_t number,
                           int pair = 0);

// All names that the convention's own files may have of a role, with the numbers of up to `count` joints.
std::vector<std::string> conventionNames(const NamingConvention& convention, JointRole role, Side side,
                                         std::size_t count);

}  // namespace limber
