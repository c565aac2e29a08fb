#include "limber/evaluate/rig/model_quality.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/geometry.h"
#include "limber/evaluate/rig/body_joints.h"
#include "limber/evaluate/rig/bone_coverage.h"
#include "limber/evaluate/rig/rig_symmetry.h"
#include "limber/evaluate/skin/model_poser.h"
#include "limber/evaluate/skin/range_of_motion.h"
#include "limber/evaluate/skin/self_penetration.h"
#include "limber/evaluate/skin/weight_metrics.h"
#include "limber/geometry/mesh/enclosed_volume.h"

namespace limber {

namespace {

constexpr double kNoVolume = 1e-6;  // of the longest side's cube: less holds nothing

double volumeAboutMiddle(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3f& p : positions) sum += p.cast<double>();
  const Vec3 middle = sum / static_cast<double>(std::max<std::size_t>(1, positions.size()));
  std::vector<Vec3f> moved;
  moved.reserve(positions.size());
  for (const Vec3f& p : positions) moved.push_back((p.cast<double>() - middle).cast<float>());
  return enclosedVolume(moved, triangles);
}

SurfaceChange changeOf(const TriMesh& rest, std::span<const Vec3f> posed, std::span<const Vec2f> uvs) {
  SurfaceChange change;
  change.stretch = surfaceStretch(rest.positions, posed, rest.triangles);
  if (!uvs.empty()) {
    const std::optional<double> before = textureStretch(uvs, rest.positions, rest.triangles),
                                after = textureStretch(uvs, posed, rest.triangles);
    if (before && after) change.texture = *after / *before - 1;
  }
  // Of open surfaces the volume depends on the origin: so the origin is the surface's middle, wherever the model is.
  const double side = longestSide(rest), before = volumeAboutMiddle(rest.positions, rest.triangles);
  if (std::abs(before) > kNoVolume * side * side * side) {
    change.volumeLoss = 1 - volumeAboutMiddle(posed, rest.triangles) / before;
  }
  return change;
}

SurfaceChange meanChange(std::span<const PoseChange> poses) {
  SurfaceChange mean;
  const double count = static_cast<double>(poses.size());
  double texture = 0, textured = 0;
  for (const PoseChange& one : poses) {
    mean.stretch.mean += one.change.stretch.mean / count;
    mean.stretch.p95 += one.change.stretch.p95 / count;
    mean.volumeLoss += std::max(0.0, one.change.volumeLoss) / count;
    texture += one.change.texture.value_or(0);
    textured += one.change.texture.has_value();
  }
  if (textured > 0) mean.texture = texture / textured;
  return mean;
}

std::optional<MotionQuality> measureMoving(const SkinnedModel& model, std::span<const Vec2f> uvs,
                                           const Deformer& deformer) {
  const std::vector<RangeOfMotionPose> range = rangeOfMotion(model.skeleton, readAnatomy(model.skeleton));
  if (range.empty()) return std::nullopt;
  MotionQuality result;
  result.deformer = deformer.name;
  std::vector<Pose> poses;
  ModelPoser poser(model, deformer);
  std::vector<Vec3f> posed(model.mesh.positions.size());
  for (const RangeOfMotionPose& one : range) {
    poser.pose(one.pose, posed);
    result.poses.push_back({std::string(one.name), changeOf(model.mesh, posed, uvs)});
    poses.push_back(one.pose);
  }
  result.mean = meanChange(result.poses);
  SelfPenetrationOptions options;
  options.deformer = &deformer;
  const SelfPenetration inside = measureSelfPenetration(model, poses, options);
  result.selfPenetration = inside.mean;
  if (inside.worst > 0) result.maxPenetrating = range[inside.worstFrame].name;
  return result;
}

// #S, 0 where a primitive has none; empty where none has any.
std::vector<Vec2f> textureCoordinates(const Asset& asset, const Geometry& geometry) {
  std::vector<Vec2f> uvs;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const gltf::Primitive& primitive = asset.document.meshes[instance.mesh].primitives[instance.primitive];
    const std::optional<Index> accessor = primitive.attributes.find("TEXCOORD_0");
    if (!accessor) continue;
    const std::vector<float> values = readFloats(asset, *accessor);
    if (values.size() != std::size_t{2} * instance.vertexCount) continue;
    uvs.resize(geometry.positions.size(), Vec2f::Zero());
    for (Index v = 0; v < instance.vertexCount; ++v) {
      uvs[instance.firstVertex + v] = {values[2 * std::size_t{v}], values[2 * std::size_t{v} + 1]};
    }
  }
  return uvs;
}

Json orNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json changeJson(const SurfaceChange& change) {
  return {{"stretch", change.stretch.mean},
          {"stretch_p95", change.stretch.p95},
          {"texture_stretch", orNull(change.texture)},
          {"volume_loss", change.volumeLoss}};
}

Json motionJson(const MotionQuality& motion) {
  Json json = changeJson(motion.mean);
  json["deformer"] = motion.deformer;
  json["self_penetration"] = motion.selfPenetration;
  json["most_penetrating"] = motion.maxPenetrating.empty() ? Json(nullptr) : Json(motion.maxPenetrating);
  json["poses"] = Json::array();
  for (const PoseChange& one : motion.poses) {
    Json pose = changeJson(one.change);
    pose["pose"] = one.pose;
    json["poses"].push_back(std::move(pose));
  }
  return json;
}

std::string motionText(const MotionQuality& motion) {
  const SurfaceChange& mean = motion.mean;
  const auto most = std::max_element(motion.poses.begin(), motion.poses.end(), [](const auto& a, const auto& b) {
    return a.change.stretch.mean < b.change.stretch.mean;
  });
  std::string text = fmt::format("stretch       mean {:.1f} %, 95th percentile {:.1f} %; most in \"{}\"\n",
                                 100 * mean.stretch.mean, 100 * mean.stretch.p95, most->pose);
  text += fmt::format("texture       {}\n",
                      mean.texture ? fmt::format("stretched {:.1f} % more than at rest", 100 * *mean.texture)
                                   : std::string("no coordinates"));
  text += fmt::format("volume        {:.1f} % lost\n", 100 * mean.volumeLoss);
  text += fmt::format("inside        {:.1f} % of the vertices go into the body", 100 * motion.selfPenetration);
  if (!motion.maxPenetrating.empty()) text += fmt::format("; most in \"{}\"", motion.maxPenetrating);
  return text + fmt::format("\n              (means over {} poses, by {})\n", motion.poses.size(), motion.deformer);
}

}  // namespace

ModelQuality measureModel(const SkinnedModel& given, std::span<const Vec2f> uvs, const Deformer& deformer) {
  checkWeights(given.weights, given.skeleton.jointCount());
  SkinnedModel model = given;
  model.weights = strongestFour(given.weights);
  const SkinnedModel welded = weldedModel(model);
  const std::vector<bool> counts = countedJoints(model);
  ModelQuality quality;
  quality.joints = model.skeleton.jointCount();
  const auto idle = std::count(counts.begin(), counts.end(), false);
  if (quality.joints > 0) quality.idleJoints = static_cast<double>(idle) / quality.joints;
  quality.placement = measureJointPlacement(welded, counts);
  quality.coverage = boneCoverage(welded, counts);
  quality.asymmetry = jointAsymmetry(welded, counts);
  quality.weights = measureWeights(welded);
  quality.motion = measureMoving(model, uvs, deformer);
  return quality;
}

ModelQuality measureModel(const Character& character, const Deformer& deformer) {
  return measureModel(readSkinnedModel(character), textureCoordinates(character.document(), character.surface()),
                      deformer);
}

Json toJson(const ModelQuality& q) {
  return {{"joints", q.joints},
          {"idle_joints", q.idleJoints},
          {"joints_inside", q.placement.inside},
          {"joints_off_center", q.placement.offCenter},
          {"coverage", orNull(q.coverage)},
          {"asymmetry", orNull(q.asymmetry)},
          {"weight_islands", q.weights.islands},
          {"influences", q.weights.influences},
          {"roughness", q.weights.roughness},
          {"motion", q.motion ? motionJson(*q.motion) : Json(nullptr)}};
}

std::string toText(const ModelQuality& q) {
  std::string text = fmt::format("joints        {}, of which {:.0f} % move nothing\n", q.joints, 100 * q.idleJoints);
  text += fmt::format("placement     {:.0f} % inside; {:.2f} off the middle (0 in it, 1 on the surface)\n",
                      100 * q.placement.inside, q.placement.offCenter);
  text += "coverage      " + (q.coverage ? fmt::format("{:.1f} % of the surface has a bone near\n", 100 * *q.coverage)
                                         : std::string("no part of the surface has an inside\n"));
  text += "asymmetry     " + (q.asymmetry ? fmt::format("{:.2f} % of the longest side\n", *q.asymmetry)
                                          : std::string("the surface is not symmetric\n"));
  text += fmt::format("weights       {:.2f} joints a vertex; roughness {:.3f}; {:.2f} % in islands\n",
                      q.weights.influences, q.weights.roughness, 100 * q.weights.islands);
  return text + (q.motion ? motionText(*q.motion) : std::string("no part of the body moves\n"));
}

}  // namespace limber
