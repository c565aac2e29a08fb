#include "limber/actions/transfer/transfer_asset.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/actions/report_json.h"
#include "limber/actions/rig/accessories.h"
#include "limber/actions/rig/figure_geometry.h"
#include "limber/actions/rig/joint_landmarks.h"
#include "limber/actions/rig/left_out_weights.h"
#include "limber/actions/transfer/transfer_colors.h"
#include "limber/core/known_error.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/blend_shapes.h"
#include "limber/document/scene/shape_surface.h"
#include "limber/document/unique_names.h"
#include "limber/geometry/mesh/face_orientation.h"
#include "limber/rigging/transfer/offset_transfer.h"

namespace limber {

namespace {

// A model with a rig, as the transfer takes it, and how its vertices came to be those of the body.
struct SourceModel {
  Character character;
  PreparedMesh prepared;  // without accessories and vertices of no triangle: their weldedVertex is kNoIndex
  RiggedBody body;        // in world space

  const Asset& document() const { return character.document(); }
  const Geometry& geometry() const { return character.shapedSurface(); }
};

void dropUnusedVertices(PreparedMesh& prepared) {
  TriMesh& mesh = prepared.mesh;
  std::vector<Index> kept(mesh.positions.size(), kNoIndex);
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) kept[v] = 0;
  }
  Index count = 0;
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (kept[v] == kNoIndex) continue;
    mesh.positions[count] = mesh.positions[v];
    kept[v] = count++;
  }
  mesh.positions.resize(count);
  for (Triangle& t : mesh.triangles) {
    for (Index& v : t) v = kept[v];
  }
  for (Index& v : prepared.weldedVertex) v = kept[v];
}

// What both models wear or hold, by the words that tell it, is part of both bodies: the one cape lies on the other.
void leaveInCommon(Accessories& a, Accessories& b) {
  const std::vector<std::string> words = a.words;
  for (auto& [own, others] : {std::pair{&a, b.words}, std::pair{&b, words}}) {
    for (Index& accessory : own->ofTriangle) {
      if (accessory != kNoIndex && std::count(others.begin(), others.end(), own->words[accessory]))
        accessory = kNoIndex;
    }
  }
}

std::vector<std::string> namesOnSurface(const Accessories& accessories) {
  std::vector<std::string> names;
  for (Index i = 0; i < accessories.names.size(); ++i) {
    if (std::count(accessories.ofTriangle.begin(), accessories.ofTriangle.end(), i)) {
      names.push_back(accessories.names[i]);
    }
  }
  return names;
}

PreparedMesh prepareBody(const Geometry& geometry, const Accessories& accessories) {
  if (accessories.empty()) return figureOf(geometry, geometry.triangles).prepared;
  return figureOf(geometry, bodyTriangles(geometry, accessories)).prepared;
}

void checkHasRig(const Character& source) {
  if (source.hasRig()) return;
  throw KnownError(ErrorKind::kNoRig, {ErrorCode::kUnsupported, "has no rig to transfer", source.document().name,
                                       "name the rigged model first, then the one that is to get its rig"});
}

SourceModel readSource(const Character& character, const Accessories& accessories) {
  SourceModel result{character, {}, {}};
  result.prepared = prepareBody(result.geometry(), accessories);
  dropUnusedVertices(result.prepared);
  const SkinWeights& weights = character.weights();
  result.body.mesh = result.prepared.mesh;
  for (Vec3f& p : result.body.mesh.positions) p = result.prepared.frame.toSource(p.cast<double>()).cast<float>();
  SkinWeights& welded = result.body.weights;
  welded.slots = weights.slots;
  welded.joints.assign(std::size_t{result.body.mesh.vertexCount()} * weights.slots, 0);
  welded.weights.assign(welded.joints.size(), 0.0f);
  for (Index v = weights.vertexCount(); v-- > 0;) {  // the first vertex with weights at a position counts
    if (result.prepared.weldedVertex[v] == kNoIndex || !(weights.weightsOf(v)[0] > 0)) continue;
    const std::size_t at = std::size_t{result.prepared.weldedVertex[v]} * weights.slots;
    std::copy(weights.jointsOf(v).begin(), weights.jointsOf(v).end(), welded.joints.begin() + at);
    std::copy(weights.weightsOf(v).begin(), weights.weightsOf(v).end(), welded.weights.begin() + at);
  }
  normalizeWeights(welded);
  result.body.skeleton = character.binding().skeleton;
  result.body.skeleton.boneShape = BoneShape::kSegment;  // spheres fit the body that they were fitted to
  for (Joint& joint : result.body.skeleton.joints) joint.radius = 0;
  return result;
}

std::vector<JointLandmark> templateLandmarks(const SourceModel& source, const Asset& targetAsset,
                                             const Geometry& target, TransferReport& report, Progress& progress) {
  progress.stage("fit target");
  const std::optional<FittedSkeleton> inTarget = fittedSkeleton(targetAsset, target, progress);
  if (!inTarget) {
    throw KnownError(ErrorKind::kNoLimbs,
                     {ErrorCode::kUnsupported, "has no limbs that can be told, so that no joint has a place in it",
                      targetAsset.name, "rig it by hand or with limber rig first: its own skeleton then tells"});
  }
  progress.stage("fit source");
  const std::optional<FittedSkeleton> inSource = fittedSkeleton(source.document(), source.geometry(), progress);
  report.landmarksBy = inTarget->name;
  report.confidence = inTarget->confidence;
  if (inSource && inSource->name == inTarget->name) {
    return landmarksByTemplate(source.body.skeleton, inSource->skeleton, inTarget->skeleton,
                               source.prepared.frame.scale);
  }
  return commonLandmarks(source.body.skeleton, inTarget->skeleton);
}

std::vector<JointLandmark> findLandmarks(const SourceModel& source, const Asset& targetAsset, const Geometry& target,
                                         const std::optional<Skeleton>& own, TransferReport& report,
                                         Progress& progress) {
  if (!own) return templateLandmarks(source, targetAsset, target, report, progress);
  report.landmarksBy = "its own skeleton";
  return commonLandmarks(source.body.skeleton, *own);
}

std::vector<std::string> transferShapes(const SourceModel& source, const RigTransfer& rig, Asset& target,
                                        const Geometry& geometry, const FigureSurface& figure) {
  const std::vector<BlendShape> shapes = readBlendShapes(source.document(), source.geometry());
  if (shapes.empty()) return {};
  const PreparedMesh& prepared = figure.prepared;
  const std::vector<Mat3> gradients = deformationGradients(rig.source, rig.registered);
  const std::vector<Index> outer = outerVertices(figure);
  std::vector<BlendShape> carried;
  for (const BlendShape& shape : shapes) {
    std::vector<Vec3f> welded(rig.source.positions.size(), Vec3f::Zero());
    for (std::size_t v = shape.offsets.size(); v-- > 0;) {
      if (source.prepared.weldedVertex[v] != kNoIndex) welded[source.prepared.weldedVertex[v]] = shape.offsets[v];
    }
    std::vector<Vec3f> offsets = carriedOffsets(rig.source, gradients, welded, rig.points);
    for (std::size_t i = 0; i < outer.size(); ++i) offsets[figure.innerShell[i]] = offsets[outer[i]];
    for (const Index v : figure.surroundings) offsets[v].setZero();
    BlendShape result{shape.name, {}};
    for (const Index v : prepared.weldedVertex) {
      result.offsets.push_back(static_cast<float>(prepared.frame.scale) * offsets[v]);
    }
    carried.push_back(std::move(result));
  }
  return addBlendShapes(target, geometry, carried);
}

// The target as the transfer takes it: with the vertices of all of it, but no triangles of its accessories.
struct TargetModel {
  Geometry geometry;
  FigureSurface figure;
  Accessories accessories;
  TriMesh body;
};

TargetModel readTarget(Geometry geometry, Accessories accessories) {
  TargetModel result;
  result.geometry = std::move(geometry);
  result.figure = figureOf(result.geometry, result.geometry.triangles);
  result.accessories = std::move(accessories);
  result.body = result.figure.prepared.mesh;
  if (result.accessories.empty()) return result;
  result.body.triangles.clear();
  std::vector<bool> isLeftOut(result.body.vertexCount(), false);
  for (const Index v : result.figure.innerShell) isLeftOut[v] = true;
  for (const Index v : result.figure.surroundings) isLeftOut[v] = true;
  for (const auto& [a, b, c] : bodyTriangles(result.geometry, result.accessories)) {
    const std::vector<Index>& welded = result.figure.prepared.weldedVertex;
    const Triangle t = {welded[a], welded[b], welded[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0] && !isLeftOut[t[0]]) result.body.triangles.push_back(t);
  }
  mendFaces(result.body);
  return result;
}

// Landmarks go into the working space of the target, joints come back out of it.
RigTransfer transferInto(const TargetModel& target, const SourceModel& source, std::vector<JointLandmark> landmarks,
                         const RigTransferOptions& options, Progress& progress) {
  const WorkingFrame& frame = target.figure.prepared.frame;
  for (JointLandmark& landmark : landmarks) landmark.position = frame.toWorking(landmark.position);
  RigTransfer rig = transferRig(source.body, landmarks, target.body, options, progress);
  for (Vec3& position : rig.positions) position = frame.toSource(position);
  bindLeftOut(target.figure, rig.weights);
  if (!target.accessories.empty()) {
    hangAccessories(target.geometry, target.figure.prepared, target.accessories, rig.weights);
  }
  return rig;
}

// A rig's joints keep their names: nodes of the target that have one of these, as those of an old rig that hold more
// than it, are the ones to get another.
void freeNames(const Skeleton& skeleton, Asset& target) {
  UniqueNames names;
  std::set<std::string> ofJoints;
  for (const Joint& joint : skeleton.joints) ofJoints.insert(names.add(joint.name));
  for (const gltf::Node& node : target.document.nodes) {
    if (!ofJoints.count(node.name)) names.add(node.name);
  }
  for (gltf::Node& node : target.document.nodes) {
    if (ofJoints.count(node.name)) node.name = names.add(node.name);
  }
}

TransferReport runTransfer(const Character& giver, const Character& taker, Asset& target,
                           const TransferAssetOptions& options, Progress& progress) {
  TransferReport report;
  progress.stage("read geometry");
  checkHasRig(giver);
  std::optional<Skeleton> own;
  if (taker.hasRig()) {
    if (options.ownSkeleton) own = taker.binding().skeleton;
    joinBindPoses(target);
    const RemovedRig removed = takeRigOut(target);
    report.removedJoints = removed.joints;
    report.removedClips = removed.clips;
  }
  const Geometry& sourceGeometry = giver.shapedSurface();
  Geometry geometry = shapedGeometry(target);
  Accessories ofSource = findAccessories(giver.document(), sourceGeometry),
              ofTarget = findAccessories(target, geometry);
  leaveInCommon(ofSource, ofTarget);
  const SourceModel source = readSource(giver, ofSource);
  const TargetModel bare = readTarget(std::move(geometry), std::move(ofTarget));
  report.sourceVertices = source.body.mesh.vertexCount();
  report.targetVertices = bare.figure.prepared.mesh.vertexCount();
  report.warnings.append(bare.figure.prepared.warnings);
  if (const std::vector<std::string> hung = namesOnSurface(bare.accessories); !hung.empty()) {
    report.warnings.add("accessories", "things worn or held are no part of the body; each follows one joint",
                        fmt::format("{}", fmt::join(hung, ", ")), hung.size());
  }

  std::vector<JointLandmark> landmarks = findLandmarks(source, target, bare.geometry, own, report, progress);
  report.landmarks = static_cast<Index>(landmarks.size());

  progress.stage("transfer");
  const RigTransfer rig = transferInto(bare, source, std::move(landmarks), options.rig, progress);
  const Skeleton skeleton =
      movedSkeleton(source.body.skeleton, restGlobals(source.body.skeleton), rig.positions, rig.turns);
  report.joints = skeleton.jointCount();
  report.gaps = rig.gaps;

  progress.stage("write rig");
  if (options.blendShapes) {
    report.blendShapes = transferShapes(source, rig, target, bare.geometry, bare.figure);
  }
  if (options.colors.at) {
    const LaidSource laid = {source.geometry(), source.prepared, rig};
    transferColors(laid, options.colors, target, bare.geometry, bare.figure);
  }
  freeNames(skeleton, target);
  attachRig(target, bare.geometry, skeleton, expandWeights(rig.weights, bare.figure.prepared.weldedVertex));
  progress.finish();
  report.warnings.append(target.warnings);
  report.stages = progress.stages();
  return report;
}

}  // namespace

TransferReport transferOnto(const Character& source, Asset& target, const TransferAssetOptions& options,
                            Progress& progress) {
  Asset result = target.clone();
  TransferReport report = [&] {
    try {
      return runTransfer(source.inOneBindPose(), target, result, options, progress);
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
