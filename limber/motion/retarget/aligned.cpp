#include "limber/motion/retarget/aligned.h"

#include <algorithm>

#include "limber/core/rotation.h"

namespace limber {

namespace {

// #joints + 1 fractions along a part, from 0 to 1: where each joint's bone begins, and the end. The last bone is as
// long as the others are on average.
std::vector<double> fractionsAlong(const std::vector<Index>& joints, const std::vector<Vec3>& positions) {
  std::vector<double> coordinates = {0};
  for (std::size_t i = 1; i < joints.size(); ++i) {
    coordinates.push_back(coordinates.back() + (positions[joints[i]] - positions[joints[i - 1]]).norm());
  }
  const double length = coordinates.back();
  if (length <= 0) {
    for (std::size_t i = 0; i <= joints.size(); ++i) {
      if (i < coordinates.size()) coordinates[i] = static_cast<double>(i);
    }
    coordinates.push_back(static_cast<double>(joints.size()));
  } else {
    coordinates.push_back(length + length / static_cast<double>(joints.size() - 1));
  }
  for (double& position : coordinates) position /= coordinates.back();
  return coordinates;
}

}  // namespace

AlignedRetargeter::AlignedRetargeter(const RetargetSetup& setup)
    : setup_(setup), root_(setup), follows_(setup.target->jointCount()) {
  for (const JointMatch& match : setup.map.matches) follow(match);
  for (const Side side : kSides)
    followLine(body_part::leg(side, Segment::kMiddle), body_part::leg(side, Segment::kEnd));
  targetFrame_.rotations.resize(setup.target->jointCount());
  targetFrame_.positions.resize(setup.target->jointCount());
}

// A shin with a hock is followed as one bone by a shin without.
void AlignedRetargeter::followLine(const BodyPart& part, const BodyPart& nextPart) {
  const JointMatch *match = setup_.map.find(part), *next = setup_.map.find(nextPart);
  if (!setup_.person || !match || !next) return;
  const std::vector<Vec3>&from = setup_.sourceNeutral.positions, &to = setup_.targetNeutral.positions;
  const Index begin = match->source.front(), end = next->source.front();
  if (!isBent(match->source, end, from) || isBent(match->target, next->target.front(), to)) return;
  for (const Index joint : match->target) {
    Follow& each = follows_[joint];
    each.line = Line{begin, end, (from[end] - from[begin]).normalized()};
    if (!each.sources.empty()) continue;
    each.sources = {{each.source, 1, setup_.sourceNeutral.rotations[each.source].conjugate()}};
    each.after = setup_.targetNeutral.rotations[joint];
  }
}

void AlignedRetargeter::follow(const JointMatch& match) {
  const std::vector<Quat>&from = setup_.sourceNeutral.rotations, &to = setup_.targetNeutral.rotations;
  const std::vector<double> fromFractions = fractionsAlong(match.source, setup_.sourceNeutral.restPositions);
  const std::vector<double> toFractions = fractionsAlong(match.target, setup_.targetNeutral.restPositions);
  for (std::size_t t = 0; t < match.target.size(); ++t) {
    const Index joint = match.target[t];
    Follow& each = follows_[joint];
    each.moved = true;
    std::vector<WeightedSource> sources;
    for (std::size_t s = 0; s < match.source.size(); ++s) {
      const bool inPairs = match.source.size() == match.target.size();
      const double overlap =
          std::min(fromFractions[s + 1], toFractions[t + 1]) - std::max(fromFractions[s], toFractions[t]);
      const double weight = inPairs ? (s == t ? 1 : 0) : overlap / (toFractions[t + 1] - toFractions[t]);
      if (weight > 1e-6) sources.push_back({match.source[s], weight, from[match.source[s]].conjugate()});
    }
    if (sources.empty()) {
      // A bone without length: what is above it.
      std::size_t s = 0;
      while (s + 1 < match.source.size() && fromFractions[s + 1] <= toFractions[t]) ++s;
      sources.push_back({match.source[s], 1, from[match.source[s]].conjugate()});
    }
    each.source = sources.front().source;
    if (sources.size() == 1) {
      each.after = sources.front().fromNeutral * to[joint];
    } else {
      each.after = to[joint];
      each.sources = std::move(sources);
    }
  }
}

Quat AlignedRetargeter::rotationOf(const Follow& follow) const {
  if (follow.sources.empty()) return sourceFrame_.rotations[follow.source] * follow.after;
  // Each on the side of the one before: along a snake that coils the last may be turned right round from the first.
  Quat before = sourceFrame_.rotations[follow.source] * follow.sources.front().fromNeutral;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const WeightedSource& source : follow.sources) {
    Quat turn = sourceFrame_.rotations[source.source] * source.fromNeutral;
    if (turn.dot(before) < 0) turn.coeffs() = -turn.coeffs();
    sum += source.weight * turn.coeffs();
    before = turn;
  }
  Quat turn(Eigen::Vector4d(sum.normalized()));
  if (const std::optional<Line>& line = follow.line) {
    const Vec3 displacement = sourceFrame_.positions[line->end] - sourceFrame_.positions[line->begin];
    turn = shortestRotation(turn * line->neutral, displacement) * turn;
  }
  return turn * follow.after;
}

void AlignedRetargeter::next(const Pose& source, double, Pose& target) {
  setup_.sourceKinematics.globals(source, sourceFrame_);
  const BodyKinematics& kinematics = setup_.targetKinematics;
  for (Index j = 0; j < setup_.target->jointCount(); ++j) {
    Transform& local = target.locals[j];
    local.translation = setup_.target->joints[j].rest.translation;
    local.scale = setup_.target->joints[j].rest.scale;
    const Quat above = kinematics.parentRotation(j, targetFrame_);
    if (follows_[j].moved) {
      targetFrame_.rotations[j] = rotationOf(follows_[j]);
      local.rotation = (above.conjugate() * targetFrame_.rotations[j]).normalized();
    } else {
      local.rotation = setup_.target->joints[j].rest.rotation;
      targetFrame_.rotations[j] = above * local.rotation;
    }
  }
  kinematics.update(target, targetFrame_);
  root_.apply(source, sourceFrame_, target, targetFrame_);
}

std::unique_ptr<FrameRetargeter> makeAligned(const RetargetSetup& setup) {
  return std::make_unique<AlignedRetargeter>(setup);
}

}  // namespace limber
