// A model with its rig, ready to be posed: what a session works on between two changes of the rig.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limber/actions/rig/auto_rig.h"
#include "limber/character/character.h"
#include "limber/deform/deform_preparations.h"
#include "limber/deform/linear_blend.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/clip/clip.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct TransferReport;

// Never changed once made, so that a session's undo steps share it. Copies share the document and its readings: a rig
// whose weights alone are others costs no more than those.
struct RiggedModel {
  explicit RiggedModel(Character read) : character(std::move(read)) {}

  Character character;              // with the rig, its joints' nodes as in the file; see documentOf for its weights
  std::vector<Affine> inverseBind;  // #J
  std::vector<double> radii;        // #J metres, of the handles to take hold of; above 0
  std::shared_ptr<const std::vector<Vec3f>> normals;  // #S, zero where the file has none
  SkinWeights weights;                                // #S, each used vertex sums to 1
  // For the surface and `weights`; shared with copies that have the same.
  std::shared_ptr<DeformPreparations> preparations = std::make_shared<DeformPreparations>();
  Pose home;  // as the joints stand in a fresh rig's file; the bind pose of a rig that was there
  std::optional<AutoRigReport> report;             // none for a rig that no rigger made: the file's, another model's
  std::shared_ptr<const TransferReport> transfer;  // of a rig that came from another model, else null
  std::vector<std::shared_ptr<const Clip>> clips;  // the file's own that move joints; names unique
  bool renamed = false;                            // joints are not called as they were
  bool edited = false;                             // by hand: weights painted; joints added, deleted, hung elsewhere
  bool painted = false;                            // `weights` are not those of the document

  const Asset& asset() const { return character.document(); }
  const AssetSkeleton& binding() const { return character.binding(); }
  const Skeleton& skeleton() const { return binding().skeleton; }
  const Anatomy& anatomy() const { return character.anatomy(); }
  const Geometry& geometry() const { return character.surface(); }  // #S vertices in world space, bound
};

// `source` with the rig that it has. Throws Error kBadArgument where it has none.
std::shared_ptr<const RiggedModel> openRiggedModel(const Asset& source);

// A document with a rig, without its clips. Throws as readSkeleton and collectGeometry do.
std::shared_ptr<RiggedModel> readRiggedModel(Asset document);

// A copy of `source`, rigged as autoRig does. Errors and cost as there.
std::shared_ptr<const RiggedModel> makeRiggedModel(const Asset& source, const AutoRigOptions& options,
                                                   Progress& progress);

// The same with another name for a joint, and for its node. Throws Error kBadArgument where the name is empty or
// another joint's.
std::shared_ptr<const RiggedModel> renameJoint(const RiggedModel& model, Index joint, const std::string& name);

// The same with other weights for all vertices.
std::shared_ptr<const RiggedModel> withWeights(const RiggedModel& model, SkinWeights weights);

// A copy of its document that has its weights. What a node shows and no joint holds stays without a skin; a vertex
// without weights beside some that have them follows joint 0.
Asset documentOf(const RiggedModel& model);

// The document with its joints standing in `pose` and with these clips in it; clips of the file's own that are not
// among them go.
Asset assetWithClips(const RiggedModel& model, const Pose& pose, std::span<const std::shared_ptr<const Clip>> clips);

// How thick handles are: the radius of a joint's sphere or, where the skeleton has none, a sixth of its shortest bone;
// at least a thousandth of `size`.
std::vector<double> handleRadii(const Skeleton& skeleton, double size);

// Of the box round the bound surface, metres.
double longestSide(const RiggedModel& model);

// Bit for bit.
bool sameTransform(const Transform& a, const Transform& b);
bool samePose(const Pose& a, const Pose& b);

// The vertices as the joints stand in `pose`; unit normals where `normals`, those as bound, are given. The first time
// that a deformer is asked for, it is prepared.
//
// deformer  of deformers()
struct PosedSurface {
  std::vector<Vec3f> positions, normals;
};
PosedSurface posedSurface(const RiggedModel& model, const Pose& pose, const Deformer& deformer,
                          std::vector<Vec3f> normals);
std::vector<Vec3f> posedPositions(const RiggedModel& model, const Pose& pose,
                                  const Deformer& deformer = kLinearBlendDeformer);

// What a graphics card bends the surface with; null where the deformer has no rows.
std::shared_ptr<const DeformRows> deformRows(const RiggedModel& model, const Deformer& deformer);

}  // namespace limber
