#include "limber/character/anatomy/skeleton_reading.h"

#include <algorithm>

#include "limber/core/lazy.h"

namespace limber {

struct SkeletonReading::Readings {
  explicit Readings(const Skeleton& given) : skeleton(given) {}

  Skeleton skeleton;
  Lazy<BodyPieces> pieces;
};

SkeletonReading::SkeletonReading(const Skeleton& skeleton) : readings_(std::make_shared<const Readings>(skeleton)) {}

const Skeleton& SkeletonReading::skeleton() const {
  return readings_->skeleton;
}

bool SkeletonReading::hasJointsOf(const Skeleton& other) const {
  const auto isSame = [](const Joint& a, const Joint& b) {
    return a.name == b.name && a.declaredBone == b.declaredBone && a.parent == b.parent;
  };
  const std::vector<Joint>& own = skeleton().joints;
  return std::equal(own.begin(), own.end(), other.joints.begin(), other.joints.end(), isSame);
}

bool SkeletonReading::isOf(const Skeleton& other) const {
  const auto restsAlike = [](const Joint& a, const Joint& b) {
    return a.rest.translation == b.rest.translation && a.rest.rotation.coeffs() == b.rest.rotation.coeffs() &&
           a.rest.scale == b.rest.scale;
  };
  const std::vector<Joint>& own = skeleton().joints;
  return hasJointsOf(other) && std::equal(own.begin(), own.end(), other.joints.begin(), restsAlike);
}

const Anatomy& SkeletonReading::anatomy() const {
  return pieces().anatomy;
}

const BodyPieces& SkeletonReading::pieces() const {
  return readings_->pieces.get([&] { return BodyPieces(skeleton()); });
}

}  // namespace limber
