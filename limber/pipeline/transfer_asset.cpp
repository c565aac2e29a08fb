#include "limber/pipeline/transfer_asset.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/asset/geometry.h"
#include "limber/asset/json_text.h"
#include "limber/asset/rig_io.h"
#include "limber/core/known_error.h"
#include "limber/mesh/prepare.h"
#include "limber/pipeline/blend_shapes.h"
#include "limber/pipeline/joint_landmarks.h"
#include "limber/pipeline/report_json.h"
#include "limber/pipeline/transfer_colors.h"
#include "limber/transfer/offset_transfer.h"

namespace limber {

namespace {

// A model with a rig, as the transfer takes it, and how its vertices came to be those of the body.
struct SourceModel {
  Geometry geometry;
  PreparedMesh prepared;
  RiggedBody body;  // in world space
};

SourceModel readSource(const Asset& asset) {
  if (!hasRig(asset)) {
    throw KnownError(ErrorKind::kNoRig, {ErrorCode::kUnsupported, "has no rig to transfer", asset.name,
                                         "name the rigged model first, then the one that is to get its rig"});
  }
  SourceModel result;
  result.geometry = collectGeometry(asset);
  result.prepared = prepareMesh(result.geometry.positions, result.geometry.triangles);
  AssetSkeleton skeleton = readSkeleton(asset);
  const SkinWeights weights = readWeights(asset, result.geometry, skeleton);
  result.body.mesh = result.prepared.mesh;
  for (Vec3f& p : result.body.mesh.positions) p = result.prepared.frame.toSource(p.cast<double>()).cast<float>();
  SkinWeights& welded = result.body.weights;
  welded.slots = weights.slots;
  welded.joints.assign(std::size_t{result.body.mesh.vertexCount()} * weights.slots, 0);
  welded.weights.assign(welded.joints.size(), 0.0f);
  for (Index v = weights.vertexCount(); v-- > 0;) {  // the first vertex at a place that has weights counts
    if (!(weights.weightsOf(v)[0] > 0)) continue;
    const std::size_t at = std::size_t{result.prepared.weldedVertex[v]} * weights.slots;
    std::copy(weights.jointsOf(v).begin(), weights.jointsOf(v).end(), welded.joints.begin() + at);
    std::copy(weights.weightsOf(v).begin(), weights.weightsOf(v).end(), welded.weights.begin() + at);
  }
  normalizeWeights(welded);
  result.body.skeleton = std::move(skeleton.skeleton);
  result.body.skeleton.boneShape = BoneShape::kSegment;  // spheres fit the body that they were fitted to
  for (Joint& joint : result.body.skeleton.joints) joint.radius = 0;
  return result;
}

void removeOldRig(Asset& target, TransferReport& report) {
  std::set<Index> joints;
  for (const Json& skin : elements(target, "skins")) {
    for (const Json& joint : skin.at("joints")) joints.insert(joint.get<Index>());
  }
  const Index clips = elementCount(target, "animations");
  report.removedJoints = static_cast<Index>(joints.size());
  removeRig(target);
  report.removedClips = clips - elementCount(target, "animations");
}

std::vector<JointLandmark> templateLandmarks(const Asset& sourceAsset, const SourceModel& source,
                                             const Asset& targetAsset, const Geometry& target, TransferReport& report,
                                             Progress& progress) {
  progress.stage("fit target");
  const std::optional<FittedSkeleton> inTarget = fittedSkeleton(targetAsset, target, progress);
  if (!inTarget) {
    throw KnownError(ErrorKind::kNoLimbs,
                     {ErrorCode::kUnsupported, "has no limbs that can be told, so that no joint has a place in it",
                      targetAsset.name, "rig it by hand or with limber rig first: its own skeleton then tells"});
  }
  progress.stage("fit source");
  const std::optional<FittedSkeleton> inSource = fittedSkeleton(sourceAsset, source.geometry, progress);
  report.landmarksBy = inTarget->name;
  report.confidence = inTarget->confidence;
  if (inSource && inSource->name == inTarget->name) {
    return landmarksByTemplate(source.body.skeleton, inSource->skeleton, inTarget->skeleton,
                               source.prepared.frame.scale);
  }
  return commonLandmarks(source.body.skeleton, inTarget->skeleton);
}

std::vector<JointLandmark> findLandmarks(const Asset& sourceAsset, const SourceModel& source, const Asset& targetAsset,
                                         const Geometry& target, const std::optional<Skeleton>& own,
                                         TransferReport& report, Progress& progress) {
  if (!own) return templateLandmarks(sourceAsset, source, targetAsset, target, report, progress);
  report.landmarksBy = "its own skeleton";
  return commonLandmarks(source.body.skeleton, *own);
}

std::vector<std::string> transferShapes(const Asset& sourceAsset, const SourceModel& source, const RigTransfer& rig,
                                        Asset& target, const Geometry& geometry, const PreparedMesh& prepared) {
  const std::vector<BlendShape> shapes = readBlendShapes(sourceAsset, source.geometry);
  if (shapes.empty()) return {};
  const std::vector<Mat3> gradients = deformationGradients(rig.source, rig.registered);
  std::vector<BlendShape> carried;
  for (const BlendShape& shape : shapes) {
    std::vector<Vec3f> welded(rig.source.positions.size(), Vec3f::Zero());
    for (std::size_t v = shape.offsets.size(); v-- > 0;) {
      welded[source.prepared.weldedVertex[v]] = shape.offsets[v];
    }
    const std::vector<Vec3f> offsets = carriedOffsets(rig.source, gradients, welded, rig.points);
    BlendShape result{shape.name, {}};
    for (const Index v : prepared.weldedVertex) {
      result.offsets.push_back(static_cast<float>(prepared.frame.scale) * offsets[v]);
    }
    carried.push_back(std::move(result));
  }
  return addBlendShapes(target, geometry, carried);
}

// Landmarks go into the working space of the target, joints come back out of it.
RigTransfer transferInto(const PreparedMesh& prepared, const SourceModel& source, std::vector<JointLandmark> landmarks,
                         const RigTransferOptions& options, Progress& progress) {
  for (JointLandmark& landmark : landmarks) landmark.place = prepared.frame.toWorking(landmark.place);
  RigTransfer rig = transferRig(source.body, landmarks, prepared.mesh, options, progress);
  for (Vec3& place : rig.places) place = prepared.frame.toSource(place);
  return rig;
}

TransferReport runTransfer(const Asset& sourceAsset, Asset& target, const TransferAssetOptions& options,
                           Progress& progress) {
  TransferReport report;
  progress.stage("read geometry");
  const SourceModel source = readSource(sourceAsset);
  std::optional<Skeleton> own;
  if (hasRig(target)) {
    if (options.ownSkeleton) own = readSkeleton(target).skeleton;
    removeOldRig(target, report);
  }
  const Geometry geometry = collectGeometry(target);
  const PreparedMesh prepared = prepareMesh(geometry.positions, geometry.triangles);
  report.sourceVertices = source.body.mesh.vertexCount();
  report.targetVertices = prepared.mesh.vertexCount();
  report.warnings.append(prepared.warnings);

  std::vector<JointLandmark> landmarks = findLandmarks(sourceAsset, source, target, geometry, own, report, progress);
  report.landmarks = static_cast<Index>(landmarks.size());

  progress.stage("transfer");
  const RigTransfer rig = transferInto(prepared, source, std::move(landmarks), options.rig, progress);
  const Skeleton skeleton =
      movedSkeleton(source.body.skeleton, restGlobals(source.body.skeleton), rig.places, rig.turns);
  report.joints = skeleton.jointCount();
  report.gaps = rig.gaps;

  progress.stage("write rig");
  if (options.blendShapes) {
    report.blendShapes = transferShapes(sourceAsset, source, rig, target, geometry, prepared);
  }
  if (options.colors.at) {
    const LaidSource laid = {source.geometry, source.prepared, rig};
    transferColors(laid, options.colors, target, geometry, prepared);
  }
  attachRig(target, geometry, skeleton, expandWeights(rig.weights, prepared.weldedVertex));
  progress.finish();
  report.warnings.append(target.warnings);
  report.stages = progress.stages();
  return report;
}

}  // namespace

TransferReport transferOnto(const Asset& source, Asset& target, const TransferAssetOptions& options,
                            Progress& progress) {
  Asset result = target.clone();
  TransferReport report = [&] {
    try {
      return runTransfer(source, result, options, progress);
    } catch (const Error& error) {
      if (!error.where().empty()) throw;
      throwWithin(error, target.name);
    }
  }();
  target = std::move(result);
  return report;
}

Json toJson(const SurfaceGaps& gaps) {
  Json parts = Json::array();
  for (const PartGap& part : gaps.parts) {
    parts.push_back({{"part", part.part}, {"area", part.area}, {"rms", part.rms}, {"beyond", part.beyond}});
  }
  return {{"rms", gaps.rms},       {"p95", gaps.p95}, {"worst", gaps.worst},
          {"beyond", gaps.beyond}, {"limit", kGap},   {"parts", std::move(parts)}};
}

Json toJson(const TransferReport& report) {
  Json json;
  json["counts"] = {{"source_vertices", report.sourceVertices},
                    {"target_vertices", report.targetVertices},
                    {"joints", report.joints},
                    {"landmarks", report.landmarks},
                    {"removed_joints", report.removedJoints},
                    {"removed_clips", report.removedClips}};
  json["landmarks_by"] = report.landmarksBy;
  json["confidence"] = report.confidence;
  json["blend_shapes"] = report.blendShapes;
  json["gaps"] = toJson(report.gaps);
  json["seconds"] = totalSeconds(report.stages);
  json["stages"] = stagesJson(report.stages);
  json["warnings"] = toJson(report.warnings);
  return json;
}

}  // namespace limber
