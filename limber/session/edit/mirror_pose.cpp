#include "limber/session/edit/mirror_pose.h"

#include <algorithm>

#include "limber/core/known_error.h"

namespace limber {

namespace {

constexpr double kMirrorTolerance = 0.01;  // of the longest side, for joints that are images
constexpr double kMinWithImages = 0.8;     // of the joints, for a skeleton that is its own mirror image

MirrorPlane planeOfSkeleton(const RiggedModel& rig) {
  const std::vector<Affine> rest = restGlobals(rig.skeleton());
  const Vec3 left = rig.anatomy().axes.left();
  double offset = 0;
  int roots = 0;
  for (Index j = 0; j < rest.size(); ++j) {
    if (rig.skeleton().joints[j].parent) continue;
    offset += left.dot(rest[j].translation());
    ++roots;
  }
  return {left, roots > 0 ? offset / roots : 0};
}

Affine reflection(const MirrorPlane& plane) {
  Affine result = Affine::Identity();
  result.linear() -= 2 * plane.normal * plane.normal.transpose();
  result.translation() = 2 * plane.offset * plane.normal;
  return result;
}

// Midway between two motions of the same point.
Affine halfwayTransform(const Affine& a, const Affine& b, const Vec3& pivot) {
  const Transform ta = decompose(a), tb = decompose(b);
  Transform half;
  half.rotation = ta.rotation.slerp(0.5, tb.rotation);
  half.scale = 0.5 * (ta.scale + tb.scale);
  half.translation = Vec3::Zero();
  const Affine turned = half.toAffine();
  return Eigen::Translation3d(0.5 * (a * pivot + b * pivot) - turned * pivot) * turned;
}

}  // namespace

std::vector<Index> mirrorJoints(const Skeleton& skeleton, const MirrorPlane& plane, double tolerance) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  const Affine mirror = reflection(plane);
  std::vector<Index> nearest(globals.size(), kNoIndex);
  for (Index j = 0; j < nearest.size(); ++j) {
    const Vec3 image = mirror * Vec3(globals[j].translation());
    double best = tolerance;
    for (Index k = 0; k < nearest.size(); ++k) {
      const double distance = (globals[k].translation() - image).norm();
      if (distance > best || (distance == best && nearest[j] != kNoIndex)) continue;
      best = distance;
      nearest[j] = k;
    }
  }
  std::vector<Index> images(nearest);
  for (Index j = 0; j < images.size(); ++j) {
    if (nearest[j] != kNoIndex && nearest[nearest[j]] != j) images[j] = kNoIndex;
  }
  return images;
}

RigMirror mirrorOfRig(const RiggedModel& rig, MirrorPlane plane) {
  if (rig.anatomy().axes.left().dot(plane.normal) < 0) plane = {-plane.normal, -plane.offset};
  return {plane, mirrorJoints(rig.skeleton(), plane, kMirrorTolerance * longestSide(rig))};
}

RigMirror mirrorOfRig(const RiggedModel& rig) {
  if (const std::optional<MirrorMap> map = findMirror({rig.geometry().positions, rig.geometry().triangles})) {
    return mirrorOfRig(rig, map->plane);
  }
  RigMirror mirror = mirrorOfRig(rig, planeOfSkeleton(rig));
  const auto without = std::count(mirror.joints.begin(), mirror.joints.end(), kNoIndex);
  if (static_cast<double>(without) > (1 - kMinWithImages) * static_cast<double>(mirror.joints.size())) {
    throw KnownError(
        ErrorKind::kNothingMirrored,
        {ErrorCode::kUnsupported, "neither the model nor its skeleton is its own mirror image", rig.asset().name});
  }
  return mirror;
}

Pose mirrorPose(const Skeleton& skeleton, const Pose& pose, const MirrorPlane& plane, const std::vector<Index>& images,
                MirrorFrom from) {
  const std::vector<Affine> rest = restGlobals(skeleton), posed = poseGlobals(skeleton, pose);
  const Affine mirror = reflection(plane);
  std::vector<Affine> motions, globals(rest.size());
  for (Index j = 0; j < rest.size(); ++j) motions.push_back(posed[j] * rest[j].inverse(Eigen::Affine));

  Pose result = pose;
  for (Index j = 0; j < rest.size(); ++j) {
    const bool isLeft = plane.normal.dot(rest[j].translation()) > plane.offset;
    const bool stays =
        images[j] == kNoIndex || (images[j] != j && from != MirrorFrom::kBoth && isLeft == (from == MirrorFrom::kLeft));
    Affine motion = motions[j];
    if (!stays) motion = mirror * motions[images[j]] * mirror;
    if (images[j] == j && from != MirrorFrom::kBoth)
      motion = halfwayTransform(motions[j], motion, rest[j].translation());
    globals[j] = motion * rest[j];
    const std::optional<Index> parent = skeleton.joints[j].parent;
    result.locals[j] = decompose(parent ? Affine(globals[*parent].inverse(Eigen::Affine) * globals[j]) : globals[j]);
  }
  return result;
}

}  // namespace limber
