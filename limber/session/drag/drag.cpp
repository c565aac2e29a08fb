#include "limber/session/drag/drag.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/session/edit/clip_curves.h"
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

bool isBelow(const Skeleton& skeleton, Index joint, Index above) {
  for (std::optional<Index> j = skeleton.joints[joint].parent; j; j = skeleton.joints[*j].parent) {
    if (*j == above) return true;
  }
  return false;
}

Quat reflected(const Quat& rotation, const Mat3& reflection) {
  if (reflection.isIdentity(0)) return rotation;
  return Quat(Mat3(reflection * rotation.toRotationMatrix() * reflection));
}

}  // namespace

Drag::Drag(DragScene scene, Index joint, DragMode mode, const Ray& ray, const Vec3& view)
    : scene_(std::move(scene)),
      mode_(mode),
      moved_(scene_.followers),
      globals_(poseGlobals(*scene_.skeleton, scene_.start)),
      depth_((globals_[joint].translation() - ray.origin).dot(unit(view, "the view"))) {
  const Skeleton& skeleton = *scene_.skeleton;
  moved_.insert(moved_.begin(), {joint, Mat3::Identity()});
  // With inverse kinematics, moving a joint pulls it by its limb.
  for (std::size_t m = 0; m < moved_.size(); ++m) {
    const bool pulled = scene_.ik && mode == DragMode::kMove && limbBase(skeleton, moved_[m].joint);
    (pulled ? pulled_ : slid_).push_back(m);
  }
  // What hangs on a joint that slides goes along with it.
  std::erase_if(slid_, [&, all = slid_](std::size_t m) {
    return std::any_of(all.begin(), all.end(),
                       [&](std::size_t other) { return isBelow(skeleton, moved_[m].joint, moved_[other].joint); });
  });
  if (scene_.ik) {
    const auto pinnedTargetOf = [&](Index j) {
      return std::find_if(scene_.pinned.begin(), scene_.pinned.end(),
                          [&](const PinnedTarget& t) { return t.joint == j; });
    };
    for (const std::size_t m : pulled_) {
      PinnedTarget target{moved_[m].joint, globals_[moved_[m].joint].translation()};
      if (const auto value = pinnedTargetOf(target.joint); value != scene_.pinned.end())
        target.rotation = value->rotation;
      targets_.push_back(target);
    }
    for (const PinnedTarget& value : scene_.pinned) {
      const bool moves = std::any_of(moved_.begin(), moved_.end(),
                                     [&](const DragFollower& follower) { return follower.joint == value.joint; });
      if (!moves) targets_.push_back(value);
    }
  }
  pull_.emplace(skeleton, targets_, scene_.limits, scene_.solver);
  // A ray that misses the plane at first takes the joint by its middle.
  gripAtStart_ = grip(ray, view).value_or(globals_[joint].translation());
}

std::optional<Pose> Drag::at(const Ray& ray, const Vec3& view, bool snapping) {
  const std::optional<Vec3> now = grip(ray, view);
  if (!now) return std::nullopt;
  if (mode_ == DragMode::kMove) {
    const Vec3 offset = *now - gripAtStart_;
    return moved(snapping ? snappedOffset(offset) : offset);
  }
  if (mode_ == DragMode::kScale) {
    const double scale = scaleUnderPointer(*now, unit(view, "the view"));
    return scaled(snapping ? snapScale(scale) : scale);
  }
  const Quat turn = turnUnderPointer(*now, unit(view, "the view"));
  const Quat rotation = snapping ? snapTurn(scene_.snap, turn) : turn;
  Pose pose = scene_.start;
  for (const DragFollower& m : moved_) turnAboutParent(m.joint, reflected(rotation, m.reflection), pose);
  pull_->solve(pose, targets_);
  return pose;
}

Pose Drag::moved(const Vec3& offset) {
  Pose pose = scene_.start;
  for (std::size_t p = 0; p < pulled_.size(); ++p) {
    const DragFollower& m = moved_[pulled_[p]];
    targets_[p].position = globals_[m.joint].translation() + m.reflection * offset;
  }
  for (const std::size_t m : slid_) slide(moved_[m].joint, moved_[m].reflection * offset, pose);
  pull_->solve(pose, targets_);
  return pose;
}

Pose Drag::carried(const Vec3& offset, const Vec3& turn) {
  Pose pose = scene_.start;
  const Quat rotation = fromRotationVector(turn * kPi / 180);
  std::vector<PinnedTarget> targets = targets_;  // other moves of this drag do not turn what they pull
  for (std::size_t p = 0; p < pulled_.size(); ++p) {
    const DragFollower& m = moved_[pulled_[p]];
    const Affine& start = globals_[m.joint];
    targets[p].position = start.translation() + m.reflection * offset;
    targets[p].rotation = reflected(rotation, m.reflection) * decompose(start).rotation;
  }
  for (const std::size_t s : slid_) {
    const DragFollower& m = moved_[s];
    swing(m.joint, globals_[m.joint].translation(), reflected(rotation, m.reflection), pose);
    slide(m.joint, m.reflection * offset, pose);
  }
  pull_->solve(pose, targets);
  return pose;
}

Pose Drag::turned(const Vec3& axis, double degrees) {
  Pose pose = scene_.start;
  const Quat rotation(Eigen::AngleAxisd(degrees * kPi / 180, unit(axis, "the axis")));
  for (const DragFollower& m : moved_) {
    swing(m.joint, globals_[m.joint].translation(), reflected(rotation, m.reflection), pose);
  }
  pull_->solve(pose, targets_);
  return pose;
}

Pose Drag::scaled(double scale) const {
  if (!std::isfinite(scale) || !(scale > 0)) throw Error(ErrorCode::kBadArgument, "the scale is not above 0");
  Pose pose = scene_.start;
  for (const DragFollower& m : moved_) pose.locals[m.joint].scale *= scale;
  return pose;
}

Pose Drag::turnedTo(const Vec3& turn) {
  Pose pose = scene_.start;
  for (const DragFollower& m : moved_) {
    const Quat rotation = turnTo(m.imageOf.value_or(m.joint), turn);
    swing(m.joint, globals_[m.joint].translation(), reflected(rotation, m.reflection), pose);
  }
  pull_->solve(pose, targets_);
  return pose;
}

// Where the ray meets the plane that faces the camera at the joint's distance.
std::optional<Vec3> Drag::grip(const Ray& ray, const Vec3& view) const {
  const Vec3 direction = unit(ray.direction, "the ray");
  const double cosine = direction.dot(unit(view, "the view"));
  if (cosine < kGrazing || !ray.origin.allFinite()) return std::nullopt;
  return ray.origin + depth_ / cosine * direction;
}

Vec3 Drag::snappedOffset(const Vec3& offset) const {
  const Vec3 position = globals_[joint()].translation();
  return snapPosition(scene_.snap, position + offset) - position;
}

void Drag::slide(Index joint, const Vec3& offset, Pose& pose) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint].parent;
  const Mat3 above = parent ? Mat3(globals_[*parent].linear()) : Mat3(Mat3::Identity());
  const Vec3 local = above.inverse() * offset;
  if (local.allFinite()) pose.locals[joint].translation += local;
}

// How far the dragged joint turns about its parent as the camera sees it; a root rolls.
Quat Drag::turnUnderPointer(const Vec3& grip, const Vec3& view) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint()].parent;
  if (!parent) return fromRotationVector(view.cross(gripAtStart_ - grip) / scene_.rollRadius);
  const Vec3 pivot = globals_[*parent].translation();
  const auto lever = [&](const Vec3& point) { return Vec3(point - pivot - view.dot(point - pivot) * view); };
  const Vec3 before = lever(gripAtStart_), after = lever(grip);
  const double angle = std::atan2(view.dot(before.cross(after)), before.dot(after));
  return Quat(Eigen::AngleAxisd(angle, view));
}

// Grows evenly as the pointer goes up; downwards the inverse, so that it stays above 0.
double Drag::scaleUnderPointer(const Vec3& grip, const Vec3& view) const {
  const Vec3& up = scene_.snap.up;
  const Vec3 onScreen = up - view.dot(up) * view;
  if (onScreen.isZero(0)) return 1;
  const double rise = (grip - gripAtStart_).dot(onScreen.normalized()) / scene_.rollRadius;
  return rise < 0 ? 1 / (1 - rise) : 1 + rise;
}

// In the world, from how the joint stood at the start to how it is to stand.
Quat Drag::turnTo(Index joint, const Vec3& turn) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint].parent;
  const Quat above = parent ? decompose(globals_[*parent]).rotation : Quat::Identity();
  Transform wanted = scene_.start.locals[joint];
  setFromRest(wanted, scene_.skeleton->joints[joint].rest, {turn, Vec3::Zero()});
  return above * wanted.rotation * scene_.start.locals[joint].rotation.conjugate() * above.conjugate();
}

void Drag::turnAboutParent(Index joint, const Quat& rotation, Pose& pose) const {
  const Skeleton& skeleton = *scene_.skeleton;
  const std::optional<Index> parent = skeleton.joints[joint].parent;
  if (!parent) return swing(joint, globals_[joint].translation(), rotation, pose);
  // Where bones are segments, the one that ends here belongs to the joint above; it turns where nothing else hangs on
  // it. A sphere's joint swings itself.
  const std::vector<Index> siblings = childrenOf(skeleton)[*parent];
  const bool turnsParent = skeleton.boneShape == BoneShape::kSegment && siblings.size() == 1;
  swing(turnsParent ? *parent : joint, globals_[*parent].translation(), rotation, pose);
}

// Turns a joint, with what hangs on it, about a point in the world.
void Drag::swing(Index joint, const Vec3& pivot, const Quat& rotation, Pose& pose) const {
  const std::optional<Index> parent = scene_.skeleton->joints[joint].parent;
  const Affine above = parent ? globals_[*parent] : Affine::Identity();
  const Quat aboveRotation = decompose(above).rotation;
  Transform& local = pose.locals[joint];
  const Vec3 lever = globals_[joint].translation() - pivot;
  const Vec3 moved = above.inverse(Eigen::Affine) * Vec3(pivot + rotation * lever);
  if (!lever.isZero(0) && moved.allFinite()) local.translation = moved;
  local.rotation = (aboveRotation.conjugate() * rotation * aboveRotation * local.rotation).normalized();
  if (scene_.limits) local.rotation = nearestAllowed(scene_.limits->joints[joint], local.rotation);
}

}  // namespace limber
