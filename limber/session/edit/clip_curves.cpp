#include "limber/session/edit/clip_curves.h"

#include <algorithm>
#include <cmath>

#include "limber/session/refuse.h"

namespace limber {

namespace {

constexpr double kDegrees = 180 / EIGEN_PI;

template <class Visit>
void eachPose(const Movement& movement, const Skeleton& skeleton, std::span<const double> moments, const Visit& visit) {
  if (moments.empty()) return;
  const Clip* clip = movement.clip();
  if (!clip) refuse(ErrorKind::kNoClip, "no clip is chosen");
  Pose pose = restPose(skeleton);
  for (const double seconds : moments) {
    sampleClip(*clip, seconds, pose);
    visit(pose);
  }
}

// Degrees.
Vec3 rotationVector(const Quat& rotation) {
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return Vec3::Zero();
  return rotation.vec() / sine * (2 * std::atan2(sine, rotation.w()) * kDegrees);
}

// Whole turns are added until it is nearest to where it was.
Vec3 unwound(const Vec3& turn, const Vec3& last) {
  const double angle = turn.norm();
  if (angle < 1e-9) return turn;
  const Vec3 axis = turn / angle;
  return turn + axis * 360 * std::round((axis.dot(last) - angle) / 360);
}

}  // namespace

std::vector<double> evenMoments(const Movement& movement, double framesPerSecond, std::size_t most) {
  if (!(framesPerSecond > 0) || !std::isfinite(framesPerSecond)) {
    throw Error(ErrorCode::kBadArgument, "a rate is above 0 frames a second");
  }
  const Clip* clip = movement.clip();
  const double duration = clip ? clip->duration() : 0;
  if (!(duration > 0)) return {};
  const double wanted = std::ceil(duration * framesPerSecond - 1e-6), least = 1;
  const double steps = std::clamp(wanted, least, std::max(least, static_cast<double>(most) - 1));
  std::vector<double> moments;
  for (double k = 0; k <= steps; ++k) moments.push_back(k == steps ? duration : duration * k / steps);
  return moments;
}

std::vector<double> curveMoments(const Movement& movement, Index joint, double framesPerSecond, std::size_t most) {
  std::vector<double> moments = evenMoments(movement, framesPerSecond, most);
  if (!movement.chosen) return moments;
  for (const JointKeyTimes& of : editableKeys(movement.clips[*movement.chosen])) {
    if (of.joint == joint) moments.insert(moments.end(), of.seconds.begin(), of.seconds.end());
  }
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
  return moments;
}

std::vector<Vec3> jointPaths(const Movement& movement, const Skeleton& skeleton, std::span<const double> moments) {
  std::vector<Vec3> paths;
  eachPose(movement, skeleton, moments, [&](const Pose& pose) {
    const std::vector<Vec3> positions = posePositions(skeleton, pose);
    paths.insert(paths.end(), positions.begin(), positions.end());
  });
  return paths;
}

std::vector<CurvePoint> jointCurve(const Movement& movement, const Skeleton& skeleton, Index joint,
                                   std::span<const double> moments) {
  if (joint >= skeleton.jointCount()) throw Error(ErrorCode::kBadArgument, "there is no such joint");
  const Transform& rest = skeleton.joints[joint].rest;
  std::vector<CurvePoint> curve;
  eachPose(movement, skeleton, moments, [&](const Pose& pose) {
    CurvePoint point = pointFromRest(pose.locals[joint], rest);
    if (!curve.empty()) point.turn = unwound(point.turn, curve.back().turn);
    curve.push_back(point);
  });
  return curve;
}

std::vector<CurveTangent> curveTangents(const Movement& movement, const Skeleton& skeleton, Index joint) {
  constexpr double kStep = 1e-3;  // seconds
  std::vector<CurveTangent> tangents;
  if (!movement.chosen || movement.clips[*movement.chosen].base) return tangents;
  const Clip& clip = *movement.clip();
  const Transform& rest = skeleton.joints[joint].rest;
  for (const JointKeyTimes& of : keyTimesOfJoints(clip)) {
    for (const double seconds : of.seconds) {
      const std::optional<KeySlope> slope = of.joint == joint ? slopeAt(clip, {joint, seconds}) : std::nullopt;
      if (!slope) continue;
      Pose pose = restPose(skeleton);
      sampleClip(clip, seconds, pose);
      Transform local = pose.locals[joint];
      if (local.rotation.w() < 0) local.rotation.coeffs() *= -1;
      const auto turnAfter = [&](double step) {
        Transform after = local;
        after.rotation = Quat(Eigen::Vector4d(local.rotation.coeffs() + step * slope->rotation)).normalized();
        return pointFromRest(after, rest).turn;
      };
      const Vec3 before = turnAfter(-kStep), after = unwound(turnAfter(kStep), before);
      tangents.push_back({seconds, slope->tangents, {(after - before) / (2 * kStep), slope->translation}});
    }
  }
  return tangents;
}

CurvePoint pointFromRest(const Transform& local, const Transform& rest) {
  Quat turn = rest.rotation.conjugate() * local.rotation;
  if (turn.w() < 0) turn.coeffs() *= -1;
  return {rotationVector(turn), local.translation - rest.translation};
}

void setFromRest(Transform& local, const Transform& rest, const CurvePoint& point) {
  const double degrees = point.turn.norm();
  const Vec3 axis = degrees > 0 ? Vec3(point.turn / degrees) : Vec3(Vec3::UnitX());
  local.rotation = (rest.rotation * Quat(Eigen::AngleAxisd(degrees / kDegrees, axis))).normalized();
  local.translation = rest.translation + point.offset;
}

}  // namespace limber
