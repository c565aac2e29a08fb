#include "limber/character/matching/plain_skeleton.h"

#include <cmath>

namespace limber {

namespace {

Vec3 evenScale(const Vec3& scale) {
  const Vec3 sizes = scale.cwiseAbs();
  const bool isEven = sizes.maxCoeff() == sizes.minCoeff();
  return isEven ? sizes : Vec3(Vec3::Constant(std::cbrt(sizes.prod())));
}

Vec3 signsOf(const Vec3& scale) {
  return scale.unaryExpr([](double axis) { return axis < 0 ? -1.0 : 1.0; });
}

}  // namespace

// A joint's global is Q D s, with a rotation Q, signs D and a length s. A child's rotation R below it turns as D R D
// does behind Q.
PlainSkeleton::PlainSkeleton(const Skeleton& original) : skeleton_(original) {
  for (Index j = 0; j < original.jointCount(); ++j) {
    const std::optional<Index>& parent = original.joints[j].parent;
    signs_.push_back(parent ? Vec3(signs_[*parent].cwiseProduct(signsOf(scales_[*parent]))) : Vec3(Vec3::Ones()));
    scales_.push_back(original.joints[j].rest.scale);
    Transform& rest = skeleton_.joints[j].rest;
    mirror(rest, j);
    rest.scale = evenScale(scales_[j]);
  }
}

void PlainSkeleton::mirror(Transform& local, Index joint) const {
  const Vec3& signs = signs_[joint];
  if (signs == Vec3::Ones()) return;
  local.translation = signs.cwiseProduct(local.translation);
  local.rotation.vec() = signs.prod() * signs.cwiseProduct(local.rotation.vec());
}

// The effect of a parent's scale, against that at rest, on the positions of its children.
void PlainSkeleton::takeScales(Pose& pose) const {
  constexpr double kScaled = 1e-3;  // ratio to the rest's, less 1; 1e-5 to 1e-2; less is rounding
  std::vector<double> factors;      // of each joint for its children
  for (Index j = 0; j < skeleton_.jointCount(); ++j) {
    const std::optional<Index>& parent = skeleton_.joints[j].parent;
    const double above = parent ? factors[*parent] : 1;
    if (above != 1) pose.locals[j].translation *= above;
    const double rest = skeleton_.joints[j].rest.scale.x();
    const double own = rest > 0 ? evenScale(pose.locals[j].scale).x() / rest : 1;
    factors.push_back(std::abs(own - 1) > kScaled ? above * own : above);
  }
}

PoseSequence PlainSkeleton::plain(PoseSequence frames) const {
  for (Pose& pose : frames.poses) {
    takeScales(pose);
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      mirror(pose.locals[j], j);
      pose.locals[j].scale = skeleton_.joints[j].rest.scale;
    }
  }
  return frames;
}

PoseSequence PlainSkeleton::original(PoseSequence frames) const {
  for (Pose& pose : frames.poses) {
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      mirror(pose.locals[j], j);
      pose.locals[j].scale = scales_[j];
    }
  }
  return frames;
}

}  // namespace limber
