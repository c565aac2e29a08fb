// Strings the stages together; holds no method of its own.
#include "limber/actions/rig/auto_rig.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/actions/rig/accessories.h"
#include "limber/actions/rig/figure_to_rig.h"
#include "limber/actions/rig/hanging_chains.h"
#include "limber/actions/rig/left_out_weights.h"
#include "limber/actions/rig/pins_outside.h"
#include "limber/actions/rig/stand_upright.h"
#include "limber/character/anatomy/skeleton_size.h"
#include "limber/core/known_error.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/rigging/rig_check.h"

namespace limber {

namespace {

// Puts an asset back as it was unless the work on it was completed. Stages change the document and append to
// buffers, and never touch bytes that were there: so the document and the lengths are enough to keep.
class Rollback {
 public:
  explicit Rollback(Asset& asset) : asset_(asset), document_(asset.document), warnings_(asset.warnings) {
    for (const Asset::Buffer& buffer : asset.buffers) sizes_.push_back(buffer.bytes.size());
  }
  Rollback(const Rollback&) = delete;
  Rollback& operator=(const Rollback&) = delete;
  ~Rollback() {
    if (done_) return;
    std::swap(asset_.document, document_);
    std::swap(asset_.warnings, warnings_);
    while (asset_.buffers.size() > sizes_.size()) asset_.buffers.pop_back();
    for (std::size_t b = 0; b < sizes_.size(); ++b) asset_.buffers[b].bytes.resize(sizes_[b]);
  }
  void commit() { done_ = true; }

 private:
  Asset& asset_;
  gltf::Document document_;
  Warnings warnings_;
  std::vector<std::size_t> sizes_;
  bool done_ = false;
};

[[noreturn]] void refuseRig(const Asset& asset) {
  throw Error(
      ErrorCode::kUnsupported, "the model has a rig of its own", asset.name,
      "`existing-rig: replace` takes it out first, `existing-rig: keep-skeleton` keeps its skeleton and makes only the "
      "weights anew");
}

// Joints that the file gives weight. Control joints (IK targets, poles, end sites) move no vertex and must not begin
// to.
std::vector<bool> deformingJoints(const SkinWeights& weights, Index jointCount) {
  std::vector<bool> deforms(jointCount, false);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    if (weights.weights[i] > 0) deforms[weights.joints[i]] = true;
  }
  if (std::none_of(deforms.begin(), deforms.end(), [](bool d) { return d; })) deforms.assign(jointCount, true);
  return deforms;
}

void moveBones(const WorkingFrame& from, const WorkingFrame& to, std::vector<Bone>& bones) {
  for (Bone& bone : bones) {
    bone.a = to.toWorking(from.toSource(bone.a));
    bone.b = to.toWorking(from.toSource(bone.b));
    bone.radius = bone.radius * from.scale / to.scale;
  }
}

// The bones of the character's own skeleton, in the working space.
std::vector<Bone> keptBones(const Character& character, const WorkingFrame& frame, Warnings& warnings) {
  const Skeleton& skeleton = character.binding().skeleton;
  const std::vector<bool> deforms = deformingJoints(character.weights(), skeleton.jointCount());
  const auto first = std::find(deforms.begin(), deforms.end(), true);
  if (deforms.size() > 1 && std::find(std::next(first), deforms.end(), true) == deforms.end()) {
    warnings.add("single-joint", "one joint alone moves the whole model, as in the file; the others move nothing",
                 skeleton.joints[static_cast<std::size_t>(first - deforms.begin())].name);
  }
  std::vector<Bone> bones = bonesOf(skeleton, deforms);
  moveBones({}, frame, bones);
  return bones;
}

// A skeleton of the working space in world space. Its joints are only moved apart: they keep rotation and scale.
Skeleton toWorld(Skeleton skeleton, const WorkingFrame& frame) {
  for (Joint& joint : skeleton.joints) {
    joint.rest.translation =
        joint.parent ? Vec3(frame.scale * joint.rest.translation) : frame.toSource(joint.rest.translation);
    joint.radius *= frame.scale;
  }
  return skeleton;
}

// What became of vertices that no bone reaches: which nodes they belong to, and a warning.
void reportBridged(const Asset& asset, const Geometry& geometry, const PreparedMesh& prepared,
                   const std::vector<Index>& pieceOf, const std::vector<Index>& bridged, AutoRigReport& report) {
  if (bridged.empty()) return;
  std::vector<bool> isBridged(prepared.mesh.vertexCount(), false), inPiece(prepared.mesh.vertexCount(), false);
  for (const Index v : bridged) {
    isBridged[v] = true;
    inPiece[pieceOf[v]] = true;
  }
  std::map<Index, BridgedNode> nodes;
  for (const PrimitiveInstance& instance : geometry.instances) {
    BridgedNode& node = nodes[instance.node];
    node.vertices += instance.vertexCount;
    for (Index v = 0; v < instance.vertexCount; ++v) {
      if (isBridged[prepared.weldedVertex[instance.firstVertex + v]]) ++node.bridged;
    }
  }
  for (auto& [index, node] : nodes) {
    if (node.bridged == 0) continue;
    node.name = asset.document.nodes[index].name;
    if (node.name.empty()) node.name = fmt::format("nodes[{}]", index);
    report.bridged.push_back(std::move(node));
  }
  std::stable_sort(report.bridged.begin(), report.bridged.end(),
                   [](const BridgedNode& a, const BridgedNode& b) { return a.bridged > b.bridged; });
  const std::string& where = report.bridged.front().name;
  report.warnings.add("bridged-pieces",
                      "pieces from which no bone is in sight took the weights of the surface nearest to them", where,
                      static_cast<std::size_t>(std::count(inPiece.begin(), inPiece.end(), true)));
  report.warnings.add("bridged-vertices", "vertices of such pieces", where, bridged.size());
}

// Methods would come to the same, after much work.
WeightResult boundToOneJoint(const TriMesh& mesh) {
  WeightResult result;
  result.weights.slots = 1;
  result.weights.joints.assign(mesh.vertexCount(), 0);
  result.weights.weights.assign(mesh.vertexCount(), 1.0f);
  return result;
}

struct Rigged {
  SkinWeights weights;           // for the source vertices
  std::optional<Skeleton> made;  // in world space; none where the asset's own was kept
  std::optional<Vec3> up;        // of the model, where that is sure
  std::vector<HangingChain> chains;
};

Rigged makeRig(const Asset& asset, const FigureToRig& input, const AutoRigOptions& options, AutoRigReport& report,
               Progress& progress) {
  const auto& [character, figure, pieceOf] = input;
  const Geometry& geometry = input.geometry();
  const PreparedMesh& prepared = figure.prepared;
  Rigged result;
  std::vector<Bone> bones;
  WeightOptions weights = options.weights;
  Accessories accessories;
  progress.stage("rig");
  if (options.existingRig == ExistingRig::kKeepSkeleton) {
    bones = keptBones(character, prepared.frame, report.warnings);
    report.joints = character.binding().skeleton.jointCount();
  } else {
    const RiggerMethod& rigger = findRigger(options.rigger);
    RiggerInput given = riggerInput(asset, input, options.rig, rigger.looksForLimbs);
    const PreparedMesh& surface = given.surfaceOf(input);
    WorkingFrame frame = surface.frame;
    accessories = std::move(given.accessories);
    if (options.onCheck && rigger.looksForLimbs) {
      progress.step("check");
      if (!given.options.memory) given.options.memory = std::make_shared<RigMemory>();
      options.onCheck(checkRigging(surface.mesh, given.options));
    }
    AutoRig rig = rigger.rig(surface.mesh, given.options, progress);
    if (given.bare && rig.isAbstained) {  // handles are for all of the model
      accessories = {};
      frame = prepared.frame;
      AutoRig handles = findRigger(AutoRigOptions().rigger).rig(prepared.mesh, options.rig, progress);
      rig.skeleton = std::move(handles.skeleton);
      rig.jointOf = std::move(handles.jointOf);
      rig.suggestions = std::move(handles.suggestions);
    }
    bones = bonesOf(rig.skeleton);
    weights.jointOf = std::move(rig.jointOf);
    if (!accessories.empty()) moveBones(frame, prepared.frame, bones);
    report.isAbstained = rig.isAbstained;
    report.rigger = rig.isAbstained ? AutoRigOptions().rigger : options.rigger;
    report.suggestions = std::move(rig.suggestions);
    report.matches = std::move(rig.matches);
    report.doubts = std::move(rig.doubts);
    report.warnings.append(rig.warnings);
    const double confidence = report.matches.empty() ? 0 : report.matches.front().confidence;
    const bool sure = options.rig.up || confidence > kSureTemplate;
    if (sure) result.up = rig.up;
    if (!sure && rig.up && confidence > kLikelyTemplate) warnMaybeLies(*rig.up, confidence, report.warnings);
    warnPinsOutside(prepared, options.rig.pins, report.warnings);
    result.made = toWorld(std::move(rig.skeleton), frame);
    if (confidence > kLikelyTemplate && !rig.isAbstained) warnUnlikelySize(*result.made, {}, report.warnings);
  }

  progress.stage("skin");
  WeightResult skin = result.made && result.made->jointCount() == 1
                          ? boundToOneJoint(prepared.mesh)
                          : findWeightMethod(options.skinning).compute(prepared.mesh, bones, weights, progress);
  report.warnings.append(skin.warnings);
  bindLeftOut(figure, skin.weights);
  const std::vector<HungAccessory> hung = accessories.empty()
                                              ? std::vector<HungAccessory>()
                                              : hangAccessories(geometry, prepared, accessories, skin.weights);
  std::set<Index> ofOthers(figure.innerShell.begin(), figure.innerShell.end());
  ofOthers.insert(figure.surroundings.begin(), figure.surroundings.end());
  for (const HungAccessory& accessory : hung) ofOthers.insert(accessory.vertices.begin(), accessory.vertices.end());
  std::erase_if(skin.bridged, [&](Index v) { return ofOthers.count(v) > 0; });
  reportBridged(asset, geometry, prepared, pieceOf, skin.bridged, report);
  if (options.chains && result.made && !report.matches.empty() && !report.isAbstained) {
    result.chains = chainsOfTails(*result.made);
  }
  if (!accessories.empty()) {
    if (options.chains) {
      for (HangingChain& chain : addChains(prepared, accessories, hung, *result.made, skin.weights)) {
        result.chains.push_back(std::move(chain));
      }
    }
    report.warnings.add("accessories", "things worn or held are no part of the body; each follows one joint or a chain",
                        fmt::format("{}", fmt::join(accessories.names, ", ")), accessories.names.size());
  }
  if (result.made) report.joints = result.made->jointCount();
  for (const HangingChain& chain : result.chains) report.chains.push_back(chain.name);
  result.weights = expandWeights(skin.weights, prepared.weldedVertex);
  return result;
}

AutoRigReport runStages(Asset& asset, const AutoRigOptions& options, Progress& progress) {
  AutoRigReport report;
  Rollback rollback(asset);
  const FigureToRig input = readFigureToRig(asset, options, report, progress);
  const Rigged rig = makeRig(asset, input, options, report, progress);

  progress.stage("write rig");
  if (rig.made) {
    writeSprings(asset, attachRig(asset, input.geometry(), *rig.made, rig.weights), rig.chains);
    if (rig.up) standUpright(asset, *rig.up, options.standUpright, report.warnings);
  } else {
    replaceWeights(asset, input.geometry(), input.character.binding(), rig.weights);
  }
  rollback.commit();
  completeReport(asset, report, progress);
  return report;
}

}  // namespace

AutoRigReport autoRig(Asset& asset, const AutoRigOptions& options, Progress& progress) {
  const bool looksForLimbs = findRigger(options.rigger).looksForLimbs;  // a name that is wrong is told before any work
  findWeightMethod(options.skinning);
  const bool rigged = hasRig(asset);
  if (options.chains && (!looksForLimbs || options.existingRig == ExistingRig::kKeepSkeleton)) {
    throw Error(ErrorCode::kBadArgument, "chains need a rigger that looks for limbs", asset.name,
                "choose the rigger template, or leave `chains` out");
  }
  if (rigged && options.existingRig == ExistingRig::kRefuse) refuseRig(asset);
  if (!rigged && options.existingRig == ExistingRig::kKeepSkeleton) {
    throw Error(ErrorCode::kBadArgument, "the model has no skeleton to keep", asset.name,
                "leave `existing-rig: keep-skeleton` out");
  }
  try {
    return runStages(asset, options, progress);
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

}  // namespace limber
