#include "limber/character/matching/retarget_setup.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "limber/character/anatomy/anatomy.h"
#include "limber/core/known_error.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

struct GroundReading {
  // Hip heights; 0.03 to 0.15; a motion whose feet come this near to their positions in rest pose has the rest pose's
  // ground; set by hand (0.015 before).
  double sameGround = 0.08;
  // Hip heights over the origin; 0.3 to 0.9; from there on a rest pose does not stand on it; set on a swimmer's clip.
  double flies = 0.5;
  // Set by hand.
  double still = 0.4;         // hip heights a second; 0.2 to 0.7; a lowest foot joint slower than this rests
  double fewStand = 0.05;     // fraction of frames; 0.01 to 0.2; below it the feet never rest (a run)
  double belowGround = 0.05;  // fraction of frames; 0 to 0.1; that may lie below the ground, for noise
};
constexpr GroundReading kGroundReading;

double lowest(const std::vector<Index>& joints, const std::vector<Vec3>& positions) {
  double y = std::numeric_limits<double>::infinity();
  for (const Index joint : joints) y = std::min(y, positions[joint].y());
  return y;
}

// A person's legs on that side, with all that is attached to them, matched or not.
std::vector<Index> legJoints(const SkeletonMap& map, MapSide side, const Skeleton& skeleton) {
  std::vector<Index> joints;
  for (const Side each : kSides) {
    const std::optional<Index> upper =
        map.isBiped() ? firstOfPart(map, side, body_part::leg(each, Segment::kUpper)) : std::nullopt;
    for (Index j = 0; upper && j < skeleton.jointCount(); ++j) {
      if (isAncestorOrSelf(skeleton, *upper, j)) joints.push_back(j);
    }
  }
  return joints;
}

// Feet where both have them. Else a person's legs: of one joint more or less, they end on the ground all the same.
std::vector<Index> groundJoints(const SkeletonMap& map, MapSide side, const Skeleton& skeleton) {
  std::vector<Index> joints = soleJoints(map, side);
  if (joints.empty()) joints = legJoints(map, side, skeleton);
  return joints.empty() ? matchedJoints(map, side) : joints;
}

// Legs of one joint each, which is at the hip: nothing in the skeleton says where they end.
bool endAtHips(const SkeletonMap& map, MapSide side, const Skeleton& skeleton) {
  const std::vector<Index> legs = legJoints(map, side, skeleton);
  const auto isHip = [&](Index joint) {
    const std::optional<Index>& parent = skeleton.joints[joint].parent;
    return !parent || std::find(legs.begin(), legs.end(), *parent) == legs.end();
  };
  return !legs.empty() && std::all_of(legs.begin(), legs.end(), isHip);
}

// How far the skin of joints goes below the lowest of them.
double skinBelow(const std::vector<Index>& joints, const NeutralPose& pose, const BodySkin* skin) {
  double below = 0;
  for (std::size_t i = 0; skin && i < skin->joints.size(); ++i) {
    const Index joint = skin->joints[i];
    if (std::find(joints.begin(), joints.end(), joint) == joints.end()) continue;
    const double height = pose.positions[joint].y() + (pose.rotations[joint] * skin->positions[i]).y();
    below = std::max(below, lowest(joints, pose.positions) - height);
  }
  return below;
}

// From the pelvis to the head.
double trunkLength(const SkeletonMap& map, MapSide side, const NeutralPose& pose) {
  const std::optional<Index> head = firstOfPart(map, side, body_part::kHead);
  return head ? (pose.positions[*head] - pelvisOf(map, side, pose.positions)).norm() : 0;
}

// What of a body is lowest when it stands, and how far below that the ground is: 0 but for legs that end at the hips.
struct Footing {
  std::vector<Index> joints;
  double below = 0;

  double ground(const std::vector<Vec3>& positions) const { return lowest(joints, positions) - below; }
};

// Heights of the lowest foot joint over a motion, in all frames and while it is still.
struct LowestHeights {
  std::vector<double> all, standing;
  std::size_t soleDown = 0;  // frames in which its sole does not look up
};
LowestHeights lowestHeights(const BodyKinematics& kinematics, const NeutralPose& neutral,
                            const std::vector<Index>& soles, double hipHeight, const PoseSequence& motion) {
  LowestHeights heights;
  BodyFrame frame, before;
  for (const Pose& pose : motion.poses) {
    kinematics.globals(pose, frame);
    const auto low = std::min_element(
        soles.begin(), soles.end(), [&](Index a, Index b) { return frame.positions[a].y() < frame.positions[b].y(); });
    heights.all.push_back(frame.positions[*low].y());
    const Quat turn = frame.rotations[*low] * neutral.rotations[*low].conjugate();
    if ((turn * Vec3::UnitY()).y() > 0) ++heights.soleDown;
    const double stillDistance = kGroundReading.still * hipHeight * motion.frameSeconds;
    const bool still =
        !before.positions.empty() && (frame.positions[*low] - before.positions[*low]).norm() < stillDistance;
    if (still) heights.standing.push_back(heights.all.back());
    std::swap(frame, before);
  }
  return heights;
}

double quantile(std::vector<double>& values, double fraction) {
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size()));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

// A rest pose that hangs about the origin instead of standing on it tells nothing about the ground.
bool isOnGround(double ground, double hipHeight) {
  return ground > -0.25 * hipHeight && ground < kGroundReading.flies * hipHeight;
}

// The rest pose's ground where the motion comes down to it, or where soles look up throughout, as a swimmer's; else the
// middle height of what is lowest and still. People who sit down, lie or jump about are still at many heights, so that
// middle alone says too little.
double measuredGround(LowestHeights heights, double restGround, double hipHeight) {
  if (std::abs(quantile(heights.all, kGroundReading.belowGround) - restGround) < kGroundReading.sameGround * hipHeight)
    return restGround;
  const bool afloat =
      static_cast<double>(heights.soleDown) < kGroundReading.fewStand * static_cast<double>(heights.all.size());
  if (afloat && isOnGround(restGround, hipHeight)) return restGround;
  const bool isStanding =
      static_cast<double>(heights.standing.size()) > kGroundReading.fewStand * static_cast<double>(heights.all.size());
  return isStanding ? quantile(heights.standing, 0.25) : quantile(heights.all, kGroundReading.belowGround);
}

double legLength(const SkeletonMap& map, MapSide side, const NeutralPose& pose) {
  double length = 0;
  for (const Side each : kSides) {
    const auto at = [&](Segment segment) -> std::optional<Vec3> {
      const std::optional<Index> joint = firstOfPart(map, side, body_part::leg(each, segment));
      return joint ? std::optional(pose.restPositions[*joint]) : std::nullopt;
    };
    const auto upper = at(Segment::kUpper), lower = at(Segment::kMiddle), foot = at(Segment::kEnd);
    if (upper && lower && foot) length = std::max(length, (*lower - *upper).norm() + (*foot - *lower).norm());
  }
  return length;
}

double hipHeight(const SkeletonMap& map, MapSide side, const NeutralPose& pose, const Footing& footing) {
  return pelvisOf(map, side, pose.positions).y() - footing.ground(pose.positions);
}

// Legs that end at the hips: by the skin, else as long for the trunk as the other body's, or as the trunk itself.
void findLegEnds(const RetargetSetup& setup, Footing& source, Footing& target) {
  const bool sourceEnds = !endAtHips(setup.map, MapSide::kSource, *setup.source),
             targetJointsEnd = !endAtHips(setup.map, MapSide::kTarget, *setup.target);
  if (!targetJointsEnd) target.below = skinBelow(target.joints, setup.targetNeutral, setup.options.skin.get());
  const bool targetEnds = targetJointsEnd || target.below > 0;
  const double sourceTrunk = trunkLength(setup.map, MapSide::kSource, setup.sourceNeutral),
               targetTrunk = trunkLength(setup.map, MapSide::kTarget, setup.targetNeutral);
  double legs = 1;  // trunks
  if (sourceEnds) {
    legs = hipHeight(setup.map, MapSide::kSource, setup.sourceNeutral, source) / sourceTrunk;
  } else if (targetEnds) {
    legs = hipHeight(setup.map, MapSide::kTarget, setup.targetNeutral, target) / targetTrunk;
  }
  if (!sourceEnds) source.below = legs * sourceTrunk;
  if (!targetEnds) target.below = legs * targetTrunk;
}

// Mean height, over the lowest matched joint, of the joints that legs begin at.
double legHeight(const std::vector<AnimalLeg>& legs, const SkeletonMap& map, MapSide side, const NeutralPose& pose) {
  double sum = 0;
  for (const AnimalLeg& leg : legs) {
    sum += pose.positions[(side == MapSide::kSource ? leg.source : leg.target).upper].y();
  }
  return sum / static_cast<double>(legs.size()) - lowest(matchedJoints(map, side), pose.positions);
}

// The direction that bodies other than a person's face; their limbs say which.
Axes axesOf(const Skeleton& skeleton, const SkeletonReading& reading, bool person) {
  if (person) return {};
  return reading.isOf(skeleton) ? reading.anatomy().axes : readAnatomy(skeleton).axes;
}

// The map's, where its skeleton has these joints: mirrored axes and uneven scales may be gone (PlainSkeleton).
SkeletonReading readingOf(const Skeleton& skeleton, const std::optional<SkeletonReading>& known) {
  return known && known->hasJointsOf(skeleton) ? *known : SkeletonReading(skeleton);
}

std::vector<Index> tailOf(const Anatomy& anatomy) {
  const Part* tail = anatomy.find(PartKind::kTail);
  return tail ? tail->joints : std::vector<Index>();
}

// With the matched limbs of bodies of another kind at their mean rotation over the motion: a person's arms hang,
// whatever the rest pose, and a foreleg that follows one rests on the ground. A twin target takes that pose by
// rotations alone: feet on roots of their own, moved elsewhere in that frame, would make the source's legs longer or
// shorter than its twin's.
Pose restOf(const Skeleton& source, std::span<const Pose> motion, const SkeletonMap& map) {
  Pose rest = uprightPose(source, motion, map, MapSide::kSource);
  if (map.twins) return turnedAlone(source, std::move(rest));
  if (!map.unlikeBodies) return rest;
  for (const JointMatch& match : map.matches) {
    const PartKind kind = match.part.kind;
    if (kind != PartKind::kLeg && kind != PartKind::kArm && kind != PartKind::kWing && kind != PartKind::kFin) continue;
    for (const Index joint : match.source) {
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      for (const Pose& pose : motion) {
        const Eigen::Vector4d turn = pose.locals[joint].rotation.coeffs();
        sum += sum.dot(turn) < 0 ? Eigen::Vector4d(-turn) : turn;
      }
      if (sum.norm() > 0) rest.locals[joint].rotation = Quat(Eigen::Vector4d(sum.normalized()));
    }
  }
  return rest;
}

// A map of the hips alone, or joints that all lie at one position, leave nothing to scale by.
void checkSize(double size, const char* whose, const SkeletonMap& map) {
  if (size > 0 && std::isfinite(size)) return;
  throw KnownError(
      ErrorKind::kTooFewMatched,
      {ErrorCode::kBadData, fmt::format("the matched joints do not tell how large the {}'s body is", whose),
       map.matches.size() == 1 ? nameOf(map.matches.front().part) : "",
       "match parts that lie further apart, such as hips, head and feet"});
}

}  // namespace

bool isSizedByTrunk(const Skeleton& source, const Skeleton& target, const SkeletonMap& map, const BodySkin* skin) {
  const std::vector<Index> legs = legJoints(map, MapSide::kTarget, target);
  const bool hasSkin = skin && std::any_of(skin->joints.begin(), skin->joints.end(), [&](Index joint) {
                         return std::find(legs.begin(), legs.end(), joint) != legs.end();
                       });
  return endAtHips(map, MapSide::kSource, source) || (endAtHips(map, MapSide::kTarget, target) && !hasSkin);
}

RetargetSetup::RetargetSetup(const Skeleton& from, const Skeleton& to, SkeletonMap matches,
                             const RetargetOptions& asked, const PoseSequence* motion)
    : source(&from),
      target(&to),
      map((checkSkeletonMap(matches, from, to), std::move(matches))),
      sourceReading(readingOf(from, map.source)),
      targetReading(readingOf(to, map.target)),
      options(asked),
      person(map.isBiped()),
      rootFollows(person              ? RootFollows::kPelvis
                  : map.isQuadruped() ? RootFollows::kHindquarters
                                      : RootFollows::kEachJoint),
      sourceRest(restOf(from, motion ? std::span(motion->poses) : std::span<const Pose>(), map)),
      targetRest(map.twins ? poseAsTwin(from, sourceRest, to, *map.twins) : restPose(to)),
      sourceNeutral(neutralPose(from, sourceRest, map, MapSide::kSource, axesOf(from, sourceReading, person))),
      targetNeutral(map.twins ? neutralPoseIn((sourceNeutral.toBody * map.twins->turn.conjugate()).normalized(), to,
                                              targetRest, map, MapSide::kTarget)
                              : neutralPose(to, targetRest, map, MapSide::kTarget, axesOf(to, targetReading, person))),
      sourceKinematics(from, sourceNeutral.toBody),
      targetKinematics(to, targetNeutral.toBody) {
  Footing sourceFooting{groundJoints(map, MapSide::kSource, from)},
      targetFooting{groundJoints(map, MapSide::kTarget, to)};
  if (person) {
    findLegEnds(*this, sourceFooting, targetFooting);
    sourceHipHeight = hipHeight(map, MapSide::kSource, sourceNeutral, sourceFooting);
    targetHipHeight = hipHeight(map, MapSide::kTarget, targetNeutral, targetFooting);
  } else {
    const BodySize one = bodySize(map, MapSide::kSource, sourceNeutral),
                   other = bodySize(map, MapSide::kTarget, targetNeutral);
    const bool stand = rootFollows == RootFollows::kHindquarters || (one.isStanding() && other.isStanding());
    sourceHipHeight = stand ? one.height : one.across;
    targetHipHeight = stand ? other.height : other.across;
    animalLegs = limber::animalLegs(map, from, to, sourceNeutral, targetNeutral);
  }
  checkSize(sourceHipHeight, "motion", map);
  checkSize(targetHipHeight, "character", map);
  scale = targetHipHeight / sourceHipHeight;
  if (!animalLegs.empty()) {
    scale = legHeight(animalLegs, map, MapSide::kTarget, targetNeutral) /
            legHeight(animalLegs, map, MapSide::kSource, sourceNeutral);
  }
  const double sourceLegs = person ? legLength(map, MapSide::kSource, sourceNeutral) : 0;
  const double targetLegs = legLength(map, MapSide::kTarget, targetNeutral);
  if (sourceLegs > 0 && targetLegs > 0) {
    if (options.rootScale == RootScale::kHipHeight) legFraction = targetLegs / sourceLegs / scale;
    if (options.rootScale == RootScale::kLegLength) scale = targetLegs / sourceLegs;
  }
  if (options.rootScale == RootScale::kNone) scale = 1;

  sourceLowest = sourceFooting.ground(sourceNeutral.positions);
  targetLowest = targetFooting.ground(targetNeutral.positions);
  const double restGround = sourceFooting.ground(sourceNeutral.restPositions);
  sourceGround = options.sourceGround.value_or(restGround);
  if (!options.sourceGround && motion && !motion->poses.empty() && sourceFooting.below == 0) {
    const LowestHeights heights =
        lowestHeights(sourceKinematics, sourceNeutral, sourceFooting.joints, sourceHipHeight, *motion);
    sourceGround = measuredGround(heights, restGround, sourceHipHeight);
  }
  // If the skeletons' rest poses are about the origin, a person is put at the source's height, and any other body,
  // whose displacement is from rest, as far from there as the source.
  targetGround = targetFooting.ground(targetNeutral.restPositions);
  // What rests in the air flies: its feet have no ground to keep to.
  const bool flies =
      targetGround >= kGroundReading.flies * targetHipHeight && rootFollows != RootFollows::kHindquarters;
  if (flies || map.unlikeBodies) animalLegs.clear();
  if (!animalLegs.empty()) targetTail = tailOf(targetReading.anatomy());
  if (!isOnGround(targetGround, targetHipHeight)) {
    if (!person)
      targetGround += scale * (sourceGround - restGround);
    else if (!options.characterOnGround)
      targetGround = sourceGround * scale;
  }
  sameBody = isSameBody();
  // Two that rest at one height are in one space: where the recording's ground is not that of its rest pose, neither is
  // the target's.
  const auto restsAt = [](const Skeleton& skeleton, const Footing& footing, const BodyKinematics& kinematics) {
    BodyFrame frame;
    kinematics.globals(restPose(skeleton), frame);
    return footing.ground(frame.positions);
  };
  const double apart =
      restsAt(to, targetFooting, targetKinematics) - scale * restsAt(from, sourceFooting, sourceKinematics);
  const bool oneSpace = std::abs(apart) < kGroundReading.sameGround * targetHipHeight;
  if (person && sameBody && oneSpace && !options.sourceGround) targetGround = scale * sourceGround;
}

// All bones alike, of whatever size; the rounding of scales that are not even is no difference.
bool RetargetSetup::isTwin(const Twins& twins) const {
  constexpr double kOff = 1e-4;  // hip heights of the target, and ratio of sizes; 1e-6 to 1e-3; rounding only
  if (std::abs(scale / twins.scale - 1) > kOff) return false;
  const std::vector<Vec3> from = posePositions(*source, turnedAlone(*source, sourceRest)),
                          to = posePositions(*target, targetRest);
  std::vector<Index> roots(to.size());
  for (Index t = 0; t < to.size(); ++t) {
    const std::optional<Index>& parent = target->joints[t].parent;
    roots[t] = parent ? roots[*parent] : t;
    const Vec3 displacement = twins.scale * (twins.turn * (from[twins.sourceOf[t]] - from[twins.sourceOf[roots[t]]]));
    if ((displacement - (to[t] - to[roots[t]])).norm() > kOff * targetHipHeight) return false;
  }
  return true;
}

bool RetargetSetup::isSameBody() const {
  const std::vector<Vec3>&from = sourceNeutral.positions, &to = targetNeutral.positions;
  if (map.twins) return isTwin(*map.twins);
  if (std::abs(scale - 1) > 1e-9) return false;
  const auto isAt = [&](Index s, Index t) { return (from[s] - to[t]).norm() <= 1e-6 * targetHipHeight; };
  Index alike = 0;
  while (alike < from.size() && from.size() == to.size() && isAt(alike, alike)) ++alike;
  if (alike == to.size()) return true;
  // Or the target lacks joints of the source, and all that it has follow one.
  std::size_t followed = 0;
  for (const JointMatch& match : map.matches) {
    if (match.source.size() > 1 || match.target.size() > 1) return false;
    if (!isAt(match.source.front(), match.target.front())) return false;
    ++followed;
  }
  return followed == to.size();
}

Vec3 RetargetSetup::positionOf(const Vec3& pelvis) const {
  Vec3 position = scale * pelvis;
  // By the legs about where they carry it; wholly down on the ground.
  const double height = (pelvis.y() - sourceGround) / sourceHipHeight, below = std::clamp(height, 0.0, 1.0);
  const double byLegs = (legFraction - 1) * (height > 1 ? height - 1 : below * (below - 1));
  position.y() = targetGround + scale * sourceHipHeight * (height + byLegs);
  return position;
}

}  // namespace limber
