#include "limber/session/rigged_model.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/moving_parents.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/scene/node_edit.h"
#include "limber/session/refuse.h"

namespace limber {

namespace {

constexpr double kBoneFraction = 1.0 / 6, kMinFraction = 1e-3;

// The document has their names, too, so that a clip is found in what is saved of it.
void readOwnClips(RiggedModel& model, Asset& document) {
  std::vector<Clip> clips = readClips(document, model.binding(), document.warnings);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    Clip& clip = clips[c];
    if (clip.translations.empty() && clip.rotations.empty() && clip.scales.empty()) continue;
    const std::string wanted = clip.name.empty() ? "clip" : clip.name;
    const auto taken = [&](const std::shared_ptr<const Clip>& known) { return known->name == clip.name; };
    clip.name = wanted;
    for (int number = 2; std::any_of(model.clips.begin(), model.clips.end(), taken); ++number) {
      clip.name = fmt::format("{} {}", wanted, number);
    }
    document.document.animations[c].name = clip.name;
    model.clips.push_back(std::make_shared<const Clip>(std::move(clip)));
  }
}

// All of the document but its clips.
std::shared_ptr<RiggedModel> readRig(std::shared_ptr<const Asset> document) {
  auto model = std::make_shared<RiggedModel>(Character(std::move(document)));
  model->normals = std::make_shared<const std::vector<Vec3f>>(readNormals(model->asset(), model->geometry()));
  model->inverseBind = inverseBindOf(model->skeleton());
  model->weights = model->character.weights();
  normalizeWeights(model->weights);
  model->home = restPose(model->skeleton());
  model->radii = handleRadii(model->skeleton(), longestSide(*model));
  return model;
}

// A document has weights for all vertices that a node shows, or for none.
void completeWeights(SkinWeights& weights, const Geometry& geometry) {
  const auto used = [&](std::size_t v) { return weights.weights[v * weights.slots] > 0; };
  std::map<std::pair<Index, Index>, bool> skinned;
  for (const PrimitiveInstance& part : geometry.instances) {
    bool& any = skinned[{part.node, part.copy}];
    for (std::size_t i = 0; i < part.vertexCount && !any; ++i) any = used(part.firstVertex + i);
  }
  for (const PrimitiveInstance& part : geometry.instances) {
    if (!skinned[{part.node, part.copy}]) continue;
    for (std::size_t v = part.firstVertex; v < std::size_t{part.firstVertex} + part.vertexCount; ++v) {
      if (!used(v)) weights.weights[v * weights.slots] = 1;
    }
  }
}

BoundSurface boundSurface(const RiggedModel& model) {
  return {model.geometry().positions, model.geometry().triangles, model.weights};
}

bool holds(std::span<const std::shared_ptr<const Clip>> clips, const std::shared_ptr<const Clip>& clip) {
  return std::find(clips.begin(), clips.end(), clip) != clips.end();
}

}  // namespace

double longestSide(const RiggedModel& rig) {
  Box box;
  for (const Vec3f& position : rig.geometry().positions) box.add(position.cast<double>());
  return box.longestSide();
}

std::shared_ptr<RiggedModel> readRiggedModel(Asset document) {
  return readRig(std::make_shared<const Asset>(std::move(document)));
}

std::shared_ptr<const RiggedModel> openRiggedModel(const Asset& source) {
  if (!hasRig(source)) throw Error(ErrorCode::kBadArgument, "the model has no rig", source.name);
  const auto document = std::make_shared<Asset>(source.clone());
  joinBindPoses(*document);
  std::shared_ptr<RiggedModel> model = readRig(document);
  readOwnClips(*model, *document);
  return model;
}

std::shared_ptr<const RiggedModel> renameJoint(const RiggedModel& model, Index joint, const std::string& name) {
  if (name.empty()) refuseNoName("joint");
  const std::optional<Index> known = model.skeleton().find(name);
  if (known && *known != joint) refuseNameTaken("joint", name);
  auto renamed = std::make_shared<RiggedModel>(model);
  Asset asset = model.asset().clone();
  asset.document.nodes[model.binding().jointNode[joint]].name = name;
  renamed->character = model.character.renamed(std::move(asset));
  renamed->renamed = true;
  return renamed;
}

std::shared_ptr<const RiggedModel> withWeights(const RiggedModel& model, SkinWeights weights) {
  auto painted = std::make_shared<RiggedModel>(model);
  painted->weights = std::move(weights);
  painted->preparations = std::make_shared<DeformPreparations>();
  painted->edited = painted->painted = true;
  return painted;
}

Asset documentOf(const RiggedModel& model) {
  Asset document = model.asset().clone();
  if (!model.painted) return document;
  SkinWeights weights = model.weights;
  completeWeights(weights, model.geometry());
  replaceWeights(document, model.geometry(), model.binding(), weights);
  return document;
}

Asset assetWithClips(const RiggedModel& model, const Pose& pose, std::span<const std::shared_ptr<const Clip>> clips) {
  Asset asset = documentOf(model);
  writeNodePose(asset, model.binding(), pose);
  const bool untouched = std::all_of(model.clips.begin(), model.clips.end(),
                                     [&](const std::shared_ptr<const Clip>& own) { return holds(clips, own); });
  if (!untouched) {
    settleMovingParents(asset, model.binding());
    std::vector<bool> moves(asset.document.nodes.size(), false);
    for (const Index node : model.binding().jointNode) moves[node] = true;
    removeChannels(asset, [&](Index node, std::string_view path) { return moves[node] && path != "weights"; });
  }
  std::vector<Clip> added;
  for (const std::shared_ptr<const Clip>& clip : clips) {
    if (!untouched || !holds(model.clips, clip)) added.push_back(*clip);
  }
  addClips(asset, model.binding(), added);
  return asset;
}

std::shared_ptr<const RiggedModel> makeRiggedModel(const Asset& source, const AutoRigOptions& options,
                                                   Progress& progress) {
  Asset asset = source.clone();
  AutoRigReport report = autoRig(asset, options, progress);
  std::shared_ptr<RiggedModel> model = readRiggedModel(std::move(asset));
  model->report = std::move(report);
  model->home = readNodePose(model->asset(), model->binding());  // the bind pose but for rounding, and no node changes
  return model;
}

std::vector<double> handleRadii(const Skeleton& skeleton, double size) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<double> shortest(globals.size(), size);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (!parent) continue;
    const double length = (globals[j].translation() - globals[*parent].translation()).norm();
    shortest[j] = std::min(shortest[j], length);
    shortest[*parent] = std::min(shortest[*parent], length);
  }
  std::vector<double> radii;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const double radius = skeleton.joints[j].radius;
    radii.push_back(std::max(radius > 0 ? radius : kBoneFraction * shortest[j], kMinFraction * size));
  }
  return radii;
}

bool sameTransform(const Transform& a, const Transform& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs() && a.scale == b.scale;
}

bool samePose(const Pose& a, const Pose& b) {
  return std::equal(a.locals.begin(), a.locals.end(), b.locals.begin(), b.locals.end(), sameTransform);
}

PosedSurface posedSurface(const RiggedModel& model, const Pose& pose, const Deformer& deformer,
                          std::vector<Vec3f> normals) {
  const Index jointCount = model.skeleton().jointCount();
  std::vector<Affine> transforms(model.inverseBind.size());
  skinTransforms(poseGlobals(model.skeleton(), pose), model.inverseBind, transforms);
  const std::vector<Vec3> centers = restPositions(model.skeleton());
  PosedSurface surface{model.geometry().positions, std::move(normals)};
  std::vector<float> scratch(deformer.scratchSize(surface.positions.size(), jointCount));
  const auto prepared = model.preparations->of(deformer, boundSurface(model), jointCount);
  deformer.deform({surface.positions, surface.normals, model.weights, transforms, centers, prepared.get()},
                  {surface.positions, surface.normals}, scratch);
  return surface;
}

std::vector<Vec3f> posedPositions(const RiggedModel& model, const Pose& pose, const Deformer& deformer) {
  return posedSurface(model, pose, deformer, {}).positions;
}

std::shared_ptr<const DeformRows> deformRows(const RiggedModel& model, const Deformer& deformer) {
  if (!deformer.rows) return nullptr;
  const BoundSurface surface = boundSurface(model);
  return deformer.rows(surface, model.preparations->of(deformer, surface, model.skeleton().jointCount()));
}

}  // namespace limber
