#include "limber/session/drag.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/error.h"
#include "limber/ik/rotation.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

constexpr double kGrazing = 1e-3;  // cosine between a ray and its plane's normal below which they do not meet

Vec3 unit(const Vec3& v, const char* what) {
  const double length = v.norm();
  if (!(length > 0) || !std::isfinite(length)) {
    throw Error(ErrorCode::kBadArgument, std::string(what) + " has no direction");
  }
  return v / length;
}

// With inverse kinematics, moving a joint pulls it by its limb; else the held ones alone are pulled.
std::vector<HeldTarget> targetsOf(const DragScene& scene, Index joint, bool pullsJoint, const Vec3& position) {
  std::vector<HeldTarget> targets;
  if (!scene.ik) return targets;
  if (pullsJoint) targets.push_back({joint, position});
  for (const HeldTarget& target : scene.held) {
    if (target.joint != joint) targets.push_back(target);
  }
  return targets;
}

}  // namespace

Drag::Drag(DragScene scene, Index joint, DragMode mode, const Ray& ray, const Vec3& view)
    : scene_(std::move(scene)),
      joint_(joint),
      mode_(mode),
      globals_(poseGlobals(*scene_.skeleton, scene_.start)),
      depth_((globals_[joint].translation() - ray.origin).dot(unit(view, "the view"))),
      targets_(targetsOf(scene_, joint, mode == DragMode::kMove && limbBase(*scene_.skeleton, joint),
                         globals_[joint].translation())),
      pull_(*scene_.skeleton, targets_, scene_.limits, scene_.solver),
      pullsJoint_(!targets_.empty() && targets_.front().joint == joint) {
  // A ray that misses the plane at first takes the joint by its middle.
  gripAtStart_ = grip(ray, view).value_or(globals_[joint].translation());
}

std::optional<Pose> Drag::at(const Ray& ray, const Vec3& view) {
  const std::optional<Vec3> now = grip(ray, view);
  if (!now) return std::nullopt;
  Pose pose = scene_.start;
  if (mode_ == DragMode::kTurn) {
    turn(*now, unit(view, "the view"), pose);
  } else if (pullsJoint_) {
    targets_.front().position = globals_[joint_].translation() + (*now - gripAtStart_);
  } else {
    slide(*now - gripAtStart_, pose);
  }
  pull_.solve(pose, targets_);
  return pose;
}

Pose Drag::turned(const Vec3& axis, double degrees) {
  Pose pose = scene_.start;
  const Quat rotation(Eigen::AngleAxisd(degrees * kPi / 180, unit(axis, "the axis")));
  swing(joint_, globals_[joint_].translation(), rotation, pose);
  pull_.solve(pose, targets_);
  return pose;
}

// Where the ray meets the plane that faces the camera at the joint's distance.
std::optional<Vec3> Drag::grip(const Ray& ray, const Vec3& view) const {
  const Vec3 direction = unit(ray.direction, "the ray");
  const double cosine = direction.dot(unit(view, "the view"));
  if (cosine < kGrazing || !ray.origin.allFinite()) return std::nullopt;
  return ray.origin + depth_ / cosine * direction;
}

void Drag::slide(const Vec3& offset, Pose& pose) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint_].parent;
  const Mat3 above = parent ? Mat3(globals_[*parent].linear()) : Mat3(Mat3::Identity());
  const Vec3 local = above.inverse() * offset;
  if (local.allFinite()) pose.locals[joint_].translation += local;
}

void Drag::turn(const Vec3& grip, const Vec3& view, Pose& pose) const {
  const Skeleton& skeleton = *scene_.skeleton;
  const std::optional<Index> parent = skeleton.joints[joint_].parent;
  const Vec3 own = globals_[joint_].translation();
  if (!parent) {
    return swing(joint_, own, fromRotationVector(view.cross(gripAtStart_ - grip) / scene_.rollRadius), pose);
  }
  const Vec3 pivot = globals_[*parent].translation();
  const auto lever = [&](const Vec3& point) { return Vec3(point - pivot - view.dot(point - pivot) * view); };
  const Vec3 before = lever(gripAtStart_), after = lever(grip);
  const double angle = std::atan2(view.dot(before.cross(after)), before.dot(after));
  const Quat rotation(Eigen::AngleAxisd(angle, view));
  // Where bones are segments, the one that ends here belongs to the joint above; it turns where nothing else hangs on
  // it. A sphere's joint swings itself.
  const std::vector<Index> siblings = childrenOf(skeleton)[*parent];
  const bool turnsParent = skeleton.boneShape == BoneShape::kSegment && siblings.size() == 1;
  swing(turnsParent ? *parent : joint_, pivot, rotation, pose);
}

// Turns a joint, with what hangs on it, about a point in the world.
void Drag::swing(Index joint, const Vec3& pivot, const Quat& rotation, Pose& pose) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint].parent;
  const Affine above = parent ? globals_[*parent] : Affine::Identity();
  const Quat aboveRotation = decompose(above).rotation;
  Transform& local = pose.locals[joint];
  const Vec3 moved = above.inverse(Eigen::Affine) * Vec3(pivot + rotation * (globals_[joint].translation() - pivot));
  if (moved.allFinite()) local.translation = moved;
  local.rotation = (aboveRotation.conjugate() * rotation * aboveRotation * local.rotation).normalized();
  if (scene_.limits) local.rotation = nearestAllowed(scene_.limits->joints[joint], local.rotation);
}

}  // namespace limber
