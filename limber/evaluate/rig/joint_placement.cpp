#include "limber/evaluate/rig/joint_placement.h"

#include <cmath>
#include <optional>

#include "limber/core/text/numbers.h"
#include "limber/evaluate/motion/body_inside.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

constexpr int kChords = 8;

// From the joint above to the middle of those below, as far as there are any.
Vec3 boneAxis(const Skeleton& skeleton, const std::vector<Vec3>& positions, Index joint) {
  Vec3 below = Vec3::Zero();
  int count = 0;
  for (Index child = joint + 1; child < skeleton.jointCount(); ++child) {
    if (skeleton.joints[child].parent != joint) continue;
    below += positions[child];
    ++count;
  }
  const auto parent = skeleton.joints[joint].parent;
  const Vec3 end = count > 0 ? Vec3(below / count) : positions[joint];
  return end - (parent ? positions[*parent] : positions[joint]);
}

std::optional<double> offCenterAt(const BodyInside& body, const Vec3& position, const Vec3& axis) {
  if (!(axis.norm() > 0)) return std::nullopt;
  const Vec3 direction = axis.normalized(), side = direction.unitOrthogonal(), other = direction.cross(side);
  double sum = 0;
  int chords = 0;
  for (int i = 0; i < kChords; ++i) {
    const double angle = kPi * i / kChords;
    const Vec3 across = std::cos(angle) * side + std::sin(angle) * other;
    const std::optional<double> a = body.exitFrom(position, across), b = body.exitFrom(position, -across);
    if (!a || !b) continue;
    sum += std::abs(*a - *b) / (*a + *b);
    ++chords;
  }
  if (chords == 0) return std::nullopt;
  return sum / chords;
}

}  // namespace

JointPlacement measureJointPlacement(const SkinnedModel& model, const std::vector<bool>& counts) {
  const BodyInside body(model.mesh);
  const std::vector<Vec3> positions = restPositions(model.skeleton);
  double joints = 0, inside = 0, offCenter = 0, centered = 0;
  for (Index j = 0; j < model.skeleton.jointCount(); ++j) {
    if (!counts[j]) continue;
    ++joints;
    const bool isInside = body.contains(positions[j]);
    inside += isInside;
    const std::optional<double> off =
        isInside ? offCenterAt(body, positions[j], boneAxis(model.skeleton, positions, j)) : 1.0;
    if (!off) continue;
    offCenter += *off;
    ++centered;
  }
  JointPlacement result;
  if (joints > 0) result.inside = inside / joints;
  if (centered > 0) result.offCenter = offCenter / centered;
  return result;
}

}  // namespace limber
