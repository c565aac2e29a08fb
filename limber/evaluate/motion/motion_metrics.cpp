#include "limber/evaluate/motion/motion_metrics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/counted.h"
#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/motion/limbs/roughness.h"

namespace limber {

namespace {

constexpr double kPlantedHeight = 0.03, kPlantedSpeed = 0.15;  // heights, heights a second
constexpr double kPlantedSeconds = 0.1;
constexpr double kSeenSeconds = 1.0 / 30;  // to each side of a frame, when detecting whether a joint rests

using Positions = std::vector<std::vector<Vec3>>;  // of each frame, #J

Positions positionsOf(const BodyKinematics& kinematics, const PoseSequence& frames) {
  Positions positions;
  BodyFrame frame;
  for (const Pose& pose : frames.poses) {
    kinematics.globals(pose, frame);
    positions.push_back(frame.positions);
  }
  return positions;
}

// The joints of feet and toes, pairwise.
std::vector<Index> standingJoints(const RetargetSetup& setup, MapSide side) {
  if (setup.person) return soleJoints(setup.map, side);
  std::vector<Index> joints;
  for (const AnimalLeg& leg : setup.animalLegs) {
    const LegJoints& own = side == MapSide::kSource ? leg.source : leg.target;
    joints.push_back(own.end);
    if (own.toes) joints.push_back(*own.toes);
  }
  return joints;
}

// One skeleton's motion as the measures see it.
struct Seen {
  Seen(const RetargetSetup& setup, MapSide s, const PoseSequence& sequence, const ShownJoints* shown)
      : side(s),
        neutral(s == MapSide::kSource ? setup.sourceNeutral : setup.targetNeutral),
        rest(shown ? shown->rest : neutral.restPositions),
        positions(shown
                      ? shown->frames
                      : positionsOf(s == MapSide::kSource ? setup.sourceKinematics : setup.targetKinematics, sequence)),
        height(standingHeight(setup, s)),
        ground(s == MapSide::kSource ? setup.sourceGround : setup.targetGround),
        lowest(s == MapSide::kSource ? setup.sourceLowest : setup.targetLowest) {}

  // Of a joint over where it is when standing, in heights.
  double above(std::size_t frame, Index joint) const {
    return (positions[frame][joint].y() - ground - (neutral.positions[joint].y() - lowest)) / height;
  }
  // In heights a second, from `reach` frames before to as many after.
  Vec3 velocity(std::size_t frame, Index joint, double seconds, std::size_t reach = 1) const {
    const std::size_t before = frame > reach ? frame - reach : 0, after = std::min(frame + reach, positions.size() - 1);
    const double time = static_cast<double>(after - before) * seconds;
    return (positions[after][joint] - positions[before][joint]) / (time * height);
  }

  MapSide side;
  const NeutralPose& neutral;
  std::vector<Vec3> rest;
  Positions positions;
  double height, ground, lowest;
};

std::vector<bool> plantedFrames(const Seen& seen, Index joint, double seconds) {
  const std::size_t count = seen.positions.size();
  std::vector<bool> planted(count);
  const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(kSeenSeconds / seconds)));
  for (std::size_t f = 0; f < count; ++f) {
    const double speed = seen.velocity(f, joint, seconds, reach).norm();
    planted[f] = seen.above(f, joint) < kPlantedHeight && speed < kPlantedSpeed;
  }
  const auto least = static_cast<std::size_t>(std::ceil(kPlantedSeconds / seconds));
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && planted[end] == planted[begin]) ++end;
    if (planted[begin] && end - begin < least) {
      std::fill(planted.begin() + static_cast<std::ptrdiff_t>(begin),
                planted.begin() + static_cast<std::ptrdiff_t>(end), false);
    }
    begin = end;
  }
  return planted;
}

void measureFeet(const RetargetSetup& setup, const Seen& source, const Seen& target, double seconds,
                 MotionMetrics& metrics) {
  const std::vector<Index> from = standingJoints(setup, MapSide::kSource), to = standingJoints(setup, MapSide::kTarget);
  double count = 0, agreed = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::vector<bool> planted = plantedFrames(source, from[i], seconds);
    for (std::size_t f = 0; f < planted.size(); ++f) {
      metrics.penetration = std::max(metrics.penetration, -target.above(f, to[i]));
      metrics.sourcePenetration = std::max(metrics.sourcePenetration, -source.above(f, from[i]));
      if (!planted[f]) continue;
      const Vec3 speed = target.velocity(f, to[i], seconds), sourceSpeed = source.velocity(f, from[i], seconds);
      metrics.sliding += std::hypot(speed.x(), speed.z());
      metrics.sourceSliding += std::hypot(sourceSpeed.x(), sourceSpeed.z());
      agreed += target.above(f, to[i]) < 1.5 * kPlantedHeight && speed.norm() < 1.5 * kPlantedSpeed;
      ++count;
    }
  }
  // Toes that the target alone has.
  for (const Side side : kSides) {
    const std::optional<Index> toes =
        toesOf(*setup.target, setup.map, MapSide::kTarget, side, target.neutral.restPositions);
    if (!toes || std::find(to.begin(), to.end(), *toes) != to.end()) continue;
    for (std::size_t f = 0; f < target.positions.size(); ++f)
      metrics.penetration = std::max(metrics.penetration, -target.above(f, *toes));
  }
  metrics.planted = count / static_cast<double>(std::max<std::size_t>(1, from.size() * source.positions.size()));
  metrics.contactAgreement = count > 0 ? agreed / count : 1;
  metrics.sliding = count > 0 ? metrics.sliding / count : 0;
  metrics.sourceSliding = count > 0 ? metrics.sourceSliding / count : 0;
}

void measureLimbs(const RetargetSetup& setup, const Seen& source, const Seen& target, MotionMetrics& metrics) {
  double bones = 0, limbs = 0;
  for (const LimbPair& limb : limbPairs(setup)) {
    const std::vector<Index>&s = limb.source, &t = limb.target;
    if (s.size() < 3) continue;
    const auto length = [](const Seen& seen, const std::vector<Index>& j) {
      const std::vector<Vec3>& rest = seen.rest;
      return (rest[j[1]] - rest[j[0]]).norm() + (rest[j[2]] - rest[j[1]]).norm();
    };
    const double sourceLength = length(source, s), targetLength = length(target, t);
    for (std::size_t f = 0; f < source.positions.size(); ++f) {
      const std::vector<Vec3>&a = source.positions[f], &b = target.positions[f];
      for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 from = a[s[i + 1]] - a[s[i]], to = b[t[i + 1]] - b[t[i]];
        metrics.boneDirection += std::atan2(from.cross(to).norm(), from.dot(to)) * 180 / kPi;
        ++bones;
      }
      metrics.endEffector += ((b[t[2]] - b[t[0]]) / targetLength - (a[s[2]] - a[s[0]]) / sourceLength).norm();
      ++limbs;
    }
  }
  metrics.boneDirection = bones > 0 ? metrics.boneDirection / bones : 0;
  metrics.endEffector = limbs > 0 ? metrics.endEffector / limbs : 0;
}

// Mean angle between the turns from rest that both make, of joints that follow one each.
double meanTurnError(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& target) {
  double sum = 0, count = 0;
  BodyFrame from, to;
  for (std::size_t f = 0; f < source.poses.size(); ++f) {
    setup.sourceKinematics.globals(source.poses[f], from);
    setup.targetKinematics.globals(target.poses[f], to);
    for (const JointMatch& match : setup.map.matches) {
      if (match.source.size() > 1 || match.target.size() > 1) continue;
      const Index s = match.source.front(), t = match.target.front();
      const Quat turn = from.rotations[s] * setup.sourceNeutral.rotations[s].conjugate();
      sum += angleBetween(turn * setup.targetNeutral.rotations[t], to.rotations[t]) * 180 / kPi;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

// Frames at which the source jumps.
std::vector<bool> cutsOf(const RetargetSetup& setup, const Positions& source, double seconds) {
  std::vector<bool> cuts(source.size());
  for (std::size_t f = 1; f < cuts.size(); ++f) cuts[f] = isCut(setup, source[f - 1], source[f], seconds);
  return cuts;
}

// Of the limbs' joints as they stand, in heights.
double jointsJerk(const RetargetSetup& setup, const Seen& seen, const std::vector<bool>& cuts) {
  double sum = 0;
  for (const LimbPair& limb : limbPairs(setup)) {
    for (const Index joint : limb.of(seen.side)) {
      Path path;
      for (const std::vector<Vec3>& positions : seen.positions) path.push_back(positions[joint] / seen.height);
      sum += squaredJerk(path, cuts, 0, cuts.size());
    }
  }
  return sum;
}

double bonesJerk(const RetargetSetup& setup, const Seen& seen, const std::vector<bool>& cuts) {
  BodyPaths body(setup, seen.side, seen.rest);
  for (const std::vector<Vec3>& positions : seen.positions) body.add(positions);
  return squaredJerk(body.paths(), cuts, 0, cuts.size());
}

void measureJerk(const RetargetSetup& setup, const Seen& source, const Seen& target, double seconds,
                 MotionMetrics& metrics) {
  const std::vector<bool> cuts = cutsOf(setup, source.positions, seconds);
  const auto ratio = [&](const auto& jerkOf) {
    return jerkRatio(jerkOf(setup, source, cuts), jerkOf(setup, target, cuts), cuts.size());
  };
  metrics.jerk = ratio(bonesJerk);
  metrics.jointJerk = ratio(jointsJerk);
}

void checkFrames(const PoseSequence& one, const PoseSequence& other) {
  if (one.poses.size() != other.poses.size() || one.poses.size() < 5) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("motions of {} and {} frames cannot be compared", one.poses.size(), other.poses.size()), "",
                "both need the same moments, at least 5");
  }
}

}  // namespace

ShownJoints shownJoints(const Skeleton& original, const PoseSequence& frames, const Quat& toBody) {
  const auto positionsOf = [&](const std::vector<Affine>& globals) {
    std::vector<Vec3> positions;
    for (const Affine& global : globals) positions.push_back(toBody * Vec3(global.translation()));
    return positions;
  };
  ShownJoints shown{positionsOf(restGlobals(original)), {}};
  for (const Pose& pose : frames.poses) shown.frames.push_back(positionsOf(poseGlobals(original, pose)));
  return shown;
}

MotionMetrics measureMotion(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& target,
                            const ShownJoints* shownSource, const ShownJoints* shownTarget) {
  checkFrames(source, target);
  const Seen from(setup, MapSide::kSource, source, shownSource), to(setup, MapSide::kTarget, target, shownTarget);
  MotionMetrics metrics;
  metrics.frames = static_cast<Index>(source.poses.size());
  metrics.matched = static_cast<Index>(setup.map.matches.size());
  metrics.height = to.height;
  metrics.sourceHeight = from.height;
  metrics.hasLegs = hasLegs(setup);
  if (metrics.hasLegs) {
    measureFeet(setup, from, to, source.frameSeconds, metrics);
    measureLimbs(setup, from, to, metrics);
  } else {
    metrics.boneDirection = meanTurnError(setup, source, target);
  }
  measureJerk(setup, from, to, source.frameSeconds, metrics);
  return metrics;
}

JointError jointErrorOf(const RetargetSetup& setup, const PoseSequence& truth, const PoseSequence& target,
                        const ShownJoints* shownTruth, const ShownJoints* shownTarget) {
  checkFrames(truth, target);
  const Seen right(setup, MapSide::kTarget, truth, shownTruth), given(setup, MapSide::kTarget, target, shownTarget);
  JointError error;
  double count = 0;
  for (std::size_t f = 0; f < truth.poses.size(); ++f) {
    const std::vector<Vec3>&a = right.positions[f], &b = given.positions[f];
    const Vec3 shift = pelvisOf(setup.map, MapSide::kTarget, b) - pelvisOf(setup.map, MapSide::kTarget, a);
    for (const JointMatch& match : setup.map.matches) {
      const Vec3 off = b[match.target.front()] - a[match.target.front()];
      error.global += off.squaredNorm();
      error.rootRelative += (off - shift).squaredNorm();
      ++count;
    }
  }
  const double scale = 1 / (count * right.height * right.height);
  return {error.global * scale, error.rootRelative * scale};
}

std::string toText(const MotionMetrics& m) {
  std::string text;
  const auto line = [&](const char* name, const std::string& value) { text += fmt::format("{:<22}{}\n", name, value); };
  line("frames", fmt::format("{}, {} of the body", m.frames, counted(m.matched, "part")));
  line(m.hasLegs ? "bone direction" : "turns of joints", fmt::format("{:.2f} degrees", m.boneDirection));
  if (m.hasLegs) {
    line("end effectors", fmt::format("{:.2f} % of the limb", 100 * m.endEffector));
    line("planted", fmt::format("{:.1f} % of the feet's frames", 100 * m.planted));
    line("foot sliding", fmt::format("{:.2f} cm/s ({:.4f} heights/s), source {:.4f}", 100 * m.sliding * m.height,
                                     m.sliding, m.sourceSliding));
    line("ground penetration", fmt::format("{:.1f} mm ({:.4f} heights), source {:.4f}", 1000 * m.penetration * m.height,
                                           m.penetration, m.sourcePenetration));
  }
  line("jerk", fmt::format("{:.3f} times the source's, {:.3f} of the joints' places", m.jerk, m.jointJerk));
  if (m.hasLegs) line("contact agreement", fmt::format("{:.1f} %", 100 * m.contactAgreement));
  if (const auto& inside = m.selfPenetration) {
    line("self-penetration", fmt::format("{:.2f} % of the vertices, {:.2f} % in frame {}", 100 * inside->mean,
                                         100 * inside->worst, inside->worstFrame));
  }
  if (m.jointError) {
    line("joint error", fmt::format("{:.3g} of height squared, {:.3g} relative to the root", m.jointError->global,
                                    m.jointError->rootRelative));
  }
  return text;
}

Json toJson(const MotionMetrics& m) {
  Json json = {{"frames", m.frames},
               {"matched_parts", m.matched},
               {"has_legs", m.hasLegs},
               {"bone_direction_degrees", m.boneDirection}};
  if (m.hasLegs) {
    json["end_effector_share"] = m.endEffector;
    json["planted_share"] = m.planted;
    json["sliding_heights_per_second"] = m.sliding;
    json["sliding_centimetres_per_second"] = 100 * m.sliding * m.height;
    json["source_sliding_heights_per_second"] = m.sourceSliding;
    json["penetration_heights"] = m.penetration;
    json["penetration_millimetres"] = 1000 * m.penetration * m.height;
    json["source_penetration_heights"] = m.sourcePenetration;
  }
  json["jerk_ratio"] = m.jerk;
  json["joint_jerk_ratio"] = m.jointJerk;
  if (m.hasLegs) json["contact_agreement"] = m.contactAgreement;
  json["height_metres"] = m.height;
  if (const auto& inside = m.selfPenetration) {
    json["self_penetration_share"] = inside->mean;
    json["worst_self_penetration_share"] = inside->worst;
    json["worst_self_penetration_frame"] = inside->worstFrame;
  }
  if (m.jointError) {
    json["joint_error"] = m.jointError->global;
    json["root_relative_joint_error"] = m.jointError->rootRelative;
  }
  return json;
}

}  // namespace limber
