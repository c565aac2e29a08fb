#include "limber/session/drag/measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/plain_skeleton.h"
#include "limber/core/error.h"
#include "limber/geometry/mesh/enclosed_volume.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr float kInfluence = 1.0f / 256;
constexpr double kMinVolume = 1e-6;  // of the box: less is no inside

float weightOf(const SkinWeights& weights, Index vertex, Index joint) {
  float sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.jointsOf(vertex)[k] == joint) sum += weights.weightsOf(vertex)[k];
  }
  return sum;
}

// No joint occurs twice among a vertex's used slots.
double difference(const SkinWeights& weights, Index a, Index b) {
  double sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    const float ofA = weights.weightsOf(a)[k], ofB = weights.weightsOf(b)[k];
    if (ofA > 0) sum += std::abs(ofA - weightOf(weights, b, weights.jointsOf(a)[k]));
    if (ofB > 0 && weightOf(weights, a, weights.jointsOf(b)[k]) == 0) sum += ofB;
  }
  return sum;
}

void measureWeights(const RiggedModel& rig, SessionMeasures& measures) {
  const SkinWeights& weights = rig.weights;
  double influences = 0, differences = 0;
  for (const float weight : weights.weights) influences += weight > kInfluence;
  for (const Triangle& t : rig.geometry().triangles) {
    for (int c = 0; c < 3; ++c) differences += difference(weights, t[c], t[(c + 1) % 3]);
  }
  measures.influences = influences / std::max<double>(1, weights.vertexCount());
  measures.smoothness = differences / std::max<double>(1, 3.0 * static_cast<double>(rig.geometry().triangles.size()));
}

void measureSurface(const SessionState& state, SessionMeasures& measures) {
  const Geometry& bound = state.rig->geometry();
  const std::vector<Vec3f> posed = posedPositions(*state.rig, state.pose, findDeformer(state.deformer));
  double change = 0, length = 0;
  for (const Triangle& t : bound.triangles) {
    for (int c = 0; c < 3; ++c) {
      const Index a = t[c], b = t[(c + 1) % 3];
      const double before = (bound.positions[b] - bound.positions[a]).norm();
      change += std::abs((posed[b] - posed[a]).norm() - before);
      length += before;
    }
  }
  measures.stretch = length > 0 ? change / length : 0;
  Box box;
  for (const Vec3f& position : bound.positions) box.add(position.cast<double>());
  const double before = enclosedVolume(bound.positions, bound.triangles);
  const double room = box.longestSide() * box.longestSide() * box.longestSide();
  if (std::abs(before) > kMinVolume * room) measures.volume = enclosedVolume(posed, bound.triangles) / before - 1;
}

void measureTargets(const SessionState& state, SessionMeasures& measures) {
  const std::vector<Affine> globals = poseGlobals(state.rig->skeleton(), state.pose);
  for (const PinnedTarget& target : state.targets) {
    const double distance = (globals[target.joint].translation() - target.position).norm();
    measures.targetDistance = std::max(measures.targetDistance.value_or(0), distance);
  }
}

std::optional<MotionMetrics> measureClip(const SessionState& state) {
  const Movement& movement = state.movement;
  if (!movement.chosen || !movement.clips[*movement.chosen].source) return std::nullopt;
  const ClipSource& source = *movement.clips[*movement.chosen].source;
  const Skeleton &from = source.motion->skeleton, &to = state.rig->skeleton();
  const Clip original = asItRests(*source.motion, from).clips[source.clip];
  Motion result;
  result.skeleton = to;
  result.clips.push_back(*movement.clip());
  const Clip moved = asItRests(std::move(result), to).clips.front();
  try {
    const double rate = frameRateOf(original);
    const PlainSkeleton plainFrom(from), plainTo(to);
    const PoseSequence theirs = plainFrom.plain(sampleFrames(from, original, rate));
    PoseSequence ours = plainTo.plain(sampleFrames(to, moved, rate));
    ours.poses.resize(theirs.poses.size(), ours.poses.back());
    RetargetOptions standing;
    standing.characterOnGround = true;
    const RetargetSetup setup(plainFrom.skeleton(), plainTo.skeleton(), source.map, standing, &theirs);
    const MotionMetrics metrics = measureMotion(setup, theirs, ours);
    return metrics.hasLegs ? std::optional(metrics) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;  // a motion too short
  }
}

}  // namespace

SessionMeasures measureSession(const Session& session) {
  const SessionState& state = session.state();
  SessionMeasures measures;
  measures.joints = state.rig->skeleton().jointCount();
  measureWeights(*state.rig, measures);
  measureSurface(state, measures);
  measureTargets(state, measures);
  measures.motion = measureClip(state);
  return measures;
}

Json measuresToJson(const SessionMeasures& measures) {
  return {{"joints", measures.joints},
          {"influences", measures.influences},
          {"smoothness", measures.smoothness},
          {"stretch", measures.stretch},
          {"volume", measures.volume},
          {"target_distance", measures.targetDistance ? Json(*measures.targetDistance) : Json(nullptr)},
          {"motion", measures.motion ? toJson(*measures.motion) : Json(nullptr)}};
}

}  // namespace limber
