// Which joints of one skeleton take their motion from which joints of another.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/body_part.h"
#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/character/matching/twin_match.h"

namespace limber {

enum class MatchedBy { kName, kShape, kFile };

// A piece of the body that both skeletons have, with its joints in both, root to tip. Counts may differ: a trunk of
// three joints moves one of five.
struct JointMatch {
  BodyPart part;  // of kind kOther: joints of one name, or of one position in equal trees, distinguished by `piece`
  std::vector<Index> source, target;
  double confidence = 1;  // below kDoubtful: worth a look
  MatchedBy by = MatchedBy::kName;
};

// A part of one of them that has no partner in the other.
struct UnmatchedPart {
  BodyPart part;
  bool ofTarget = false;
  std::vector<Index> joints;
  std::optional<BodyPart> carrier;  // of the target: what it goes along with meanwhile, as it rests; none: it stays
};

struct SkeletonMap {
  std::vector<JointMatch> matches;  // parents before children
  std::vector<UnmatchedPart> left;  // of the labelled parts
  std::optional<Twins> twins;       // one skeleton under other names, turned or scaled: then each joint is matched
  bool unlikeBodies = false;        // limbs follow those of other kinds, from how these stand in the motion's mean
  bool jointByJoint = false;        // each joint moves as its partner does, and no limb is solved for: of one family of
                                    // animals, whose joints have the same names, and of bodies that stand otherwise

  // Of the skeletons that were matched, so that whoever uses the map reads neither again; none of a map out of a file.
  std::optional<SkeletonReading> source, target;

  const JointMatch* find(const BodyPart& part) const;
  // Two legs on one pelvis, no more and no wings: what moves as people do.
  bool isBiped() const;
  // Two pairs of legs or more on one pelvis.
  bool isQuadruped() const;
};

// "leftUpperArm"; of other joints the target joint's own name, behind "joint " where it is that of a part.
std::string nameOf(const JointMatch& match, const Skeleton& target);

// Twins (twin_match.h) joint by joint. Others by their anatomy: parts of the same kind, side and pair; limbs from
// landmark to landmark, between them by where joints lie along the limb; the pelvis where legs and spine part, trunk
// and neck as chains between it and the head, whatever their joints are called. What else hangs on the same matched
// parts goes by equal names (upper and lower case, separators and prefixes aside). Equal trees of no body go joint by
// joint. Throws Error kUnsupported where too little matches to move anything.
//
// unlikeBodies: limbs without a partner follow one of another kind as well, pair by pair along the body from front to
// back: forelegs and wings follow arms, a spider's eight legs a person's four limbs. After Hecker, Raabe, Enslow,
// DeWeese, Maynard, van Prooijen 2008, Real-time motion retargeting to highly varied user-created morphologies.
//
// sourcePose (#J locals), if given, is the pose in which the source's body is read, for one whose rest pose tells
// nothing (poseWithForm, rest_form.h). Twins are found by the rest poses all the same.
SkeletonMap matchSkeletons(const SkeletonReading& source, const SkeletonReading& target, bool unlikeBodies = false,
                           const Pose* sourcePose = nullptr);

// Throws Error kBadData naming the part: no joint, one that is not there, or one target joint in two parts.
void checkSkeletonMap(const SkeletonMap& map, const Skeleton& source, const Skeleton& target);

// A map as a file to correct and use again (docs/skeleton_map.schema.json): joints by name. Reading throws Error
// kBadData naming the match; joints that a skeleton does not have are an error, too.
std::string skeletonMapToJson(const SkeletonMap& map, const Skeleton& source, const Skeleton& target);
SkeletonMap skeletonMapFromJson(std::string_view text, const Skeleton& source, const Skeleton& target);

}  // namespace limber
