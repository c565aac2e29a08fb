#include "limber/adapters/rig_by_program.h"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/actions/rig/figure_geometry.h"
#include "limber/actions/rig/figure_to_rig.h"
#include "limber/actions/rig/left_out_weights.h"
#include "limber/adapters/returned_rig.h"
#include "limber/core/known_error.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber {

namespace {

// Of the longest side: a returned joint is matched to one this near.
constexpr double kSameJoint = 0.01;

void checkCanRig(const Asset& asset, const Adapter& adapter, const AutoRigOptions& options) {
  if (adapter.kind != AdapterKind::kRig) {
    throw Error(ErrorCode::kBadArgument, fmt::format("is of kind {}, not a rigger", adapterKindName(adapter.kind)),
                adapter.name);
  }
  findWeightMethod(options.skinning);
  if (options.existingRig == ExistingRig::kKeepSkeleton) {
    throw Error(ErrorCode::kBadArgument, "makes a skeleton of its own", adapter.name,
                "leave `existing-rig: keep-skeleton` out");
  }
  if (hasRig(asset) && options.existingRig == ExistingRig::kRefuse) {
    throw Error(ErrorCode::kUnsupported, "the model has a rig of its own", asset.name,
                "`existing-rig: replace` takes it out first");
  }
}

Bytes inputFor(const HandedModel& handed, const Adapter& adapter) {
  return adapter.inputFormat == AdapterFormat::kObj ? handedObj(handed.mesh) : writeGlb(meshAsset(handed.mesh));
}

Affine worldOf(const WorkingFrame& frame) {
  Affine map = Affine::Identity();
  map.linear() *= frame.scale;
  map.translation() = frame.offset;
  return map;
}

// What the source vertices have, at the first of those that were welded to each vertex handed over.
SkinWeights handedWeights(const SkinWeights& source, const PreparedMesh& prepared, const HandedModel& handed) {
  std::vector<std::optional<Index>> sourceOf(handed.mesh.positions.size());
  for (std::size_t s = prepared.weldedVertex.size(); s-- > 0;) {
    if (const auto& v = handed.vertexOf[prepared.weldedVertex[s]]) sourceOf[*v] = static_cast<Index>(s);
  }
  std::vector<Index> taken;
  for (const auto& s : sourceOf) taken.push_back(*s);
  SkinWeights weights = expandWeights(source, taken);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    if (!(weights.weightsOf(v)[0] > 0)) bindTo(0, v, weights);
  }
  normalizeWeights(weights);
  return weights;
}

// The skeleton's joint for each returned one, by its name or else its position; none for unmatched ones. No two are
// the same joint.
std::vector<std::optional<Index>> sameJoints(const Skeleton& returned, const Skeleton& own) {
  const std::vector<Affine> returnedAt = restGlobals(returned), ownAt = restGlobals(own);
  std::vector<std::optional<Index>> same(returned.joints.size());
  std::vector<bool> isTaken(own.joints.size(), false);
  for (std::size_t r = 0; r < same.size(); ++r) {
    same[r] = own.find(returned.joints[r].name);
    if (same[r]) isTaken[*same[r]] = true;
  }
  for (std::size_t r = 0; r < same.size(); ++r) {
    if (same[r]) continue;
    double nearest = kSameJoint;
    for (Index j = 0; j < own.jointCount(); ++j) {
      const double distance = (ownAt[j].translation() - returnedAt[r].translation()).norm();
      if (isTaken[j] || distance >= nearest) continue;
      nearest = distance;
      same[r] = j;
    }
    if (same[r]) isTaken[*same[r]] = true;
  }
  return same;
}

// Weights over the skeleton's own joints.
void renameJoints(SkinWeights& weights, const Skeleton& returned, const Skeleton& own, const std::string& name) {
  const std::vector<std::optional<Index>> same = sameJoints(returned, own);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    if (!(weights.weights[i] > 0)) continue;
    const auto& joint = same[weights.joints[i]];
    if (!joint) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("the joint '{}' is none of the model's", returned.joints[weights.joints[i]].name), name,
                  "the program must keep the skeleton that it is given");
    }
    weights.joints[i] = *joint;
  }
}

}  // namespace

AutoRigReport rigByProgram(Asset& asset, const Adapter& adapter, const AutoRigOptions& options, Progress& progress) {
  checkCanRig(asset, adapter, options);
  try {
    AutoRigReport report;
    Asset rigged = asset.clone();
    const FigureToRig toRig = readFigureToRig(rigged, options, report, progress);
    const FigureSurface& figure = toRig.figure;
    const PreparedMesh& prepared = figure.prepared;

    progress.stage("rig");
    const HandedModel handed = handedModel(prepared.mesh, adapter);
    const Bytes input = inputFor(handed, adapter);
    const ProgramOutput output = runProgram(adapter, {input}, progress);
    ReturnedRig rig = readReturnedRig(output, adapter, prepared.mesh, handed, options.weights.maxInfluences);
    report.rigger = adapter.name;
    report.joints = rig.skeleton.jointCount();
    report.warnings.append(rig.warnings);

    progress.stage("skin");
    if (rig.weights) {
      report.skinning = adapter.name;
    } else {
      WeightResult skin =
          findWeightMethod(options.skinning).compute(prepared.mesh, bonesOf(rig.skeleton), options.weights, progress);
      report.warnings.append(skin.warnings);
      rig.weights = std::move(skin.weights);
    }
    bindLeftOut(figure, *rig.weights);
    progress.stage("write rig");
    attachRig(rigged, toRig.geometry(), movedSkeleton(rig.skeleton, worldOf(prepared.frame)),
              expandWeights(*rig.weights, prepared.weldedVertex));
    asset = std::move(rigged);
    completeReport(asset, report, progress);
    return report;
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

Warnings weightsByProgram(Asset& asset, const Adapter& adapter, const WeightOptions& options, Progress& progress) {
  if (adapter.kind != AdapterKind::kWeights) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("is of kind {}, no skinning method", adapterKindName(adapter.kind)), adapter.name);
  }
  try {
    progress.stage("weights");
    Asset weighed = asset.clone();
    joinBindPoses(weighed);
    const Character character(weighed);
    const AssetSkeleton& own = character.binding();
    const Geometry& geometry = character.shapedSurface();
    const FigureSurface figure = figureOf(geometry, geometry.triangles);
    const PreparedMesh& prepared = figure.prepared;
    const HandedModel handed = handedModel(prepared.mesh, adapter);
    const Skeleton working = movedSkeleton(own.skeleton, worldOf(prepared.frame).inverse());
    Asset given = meshAsset(handed.mesh);
    attachRig(given, collectGeometry(given), movedSkeleton(working, toHandedSpace(adapter.inputUp, adapter.inputSize)),
              handedWeights(character.weights(), prepared, handed));
    const Bytes input = writeGlb(given);
    const ProgramOutput output = runProgram(adapter, {input}, progress);
    ReturnedRig rig = readReturnedRig(output, adapter, prepared.mesh, handed, options.maxInfluences);
    if (!rig.weights) throw Error(ErrorCode::kBadData, "gave no weights", adapter.name);
    renameJoints(*rig.weights, rig.skeleton, working, adapter.name);
    bindLeftOut(figure, *rig.weights);
    replaceWeights(weighed, geometry, own, expandWeights(*rig.weights, prepared.weldedVertex));
    asset = std::move(weighed);
    return rig.warnings;
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

}  // namespace limber
