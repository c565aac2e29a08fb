// Poses a rigged Asset: the joints' nodes, or the mesh itself for good.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/actions/motion/own_binds.h"
#include "limber/actions/pose/pose_edits.h"
#include "limber/character/character.h"
#include "limber/deform/linear_blend.h"
#include "limber/document/scene/shape_surface.h"
#include "limber/skeleton/ik/ik_problem.h"
#include "limber/skeleton/ik/limits/limits.h"
#include "limber/skeleton/pose.h"

namespace limber {

struct PoseOptions {
  std::string solver = "whole-body";  // of ikMethods()
  IkOptions ik;
};

// What became of one reach, in the order of the edits.
struct ReachReport {
  std::string joint;
  double distance = 0;  // left, metres
  IkOutcome outcome = IkOutcome::kReached;
};

// Changes `pose`, given in the world's space, as the edits say but for their tasks. Limits (none: null) are kept by the
// joints that reach, and bend the joints that were turned. Throws Error kBadArgument, with the edit's `where`, on a
// joint that is not there (and lists some that are), a base that is not above its joint, and a joint that reaches for
// two points.
std::vector<ReachReport> editPose(const Skeleton& skeleton, Pose& pose, const PoseEdits& edits,
                                  const JointLimits* limits = nullptr, const PoseOptions& options = {});

// The vertices of a rigged character as its joints stand in `pose`, in world space, with normals where the file has some
// (zero elsewhere); blend shapes come first, with the weights that the nodes have.
//
// skeleton  its binding(), or moving(), of the document as it is: where a bind pose lies in the world follows from how
//           the nodes stand, so a skeleton read before writeNodePose is not that of the document after it
// deformer  of deformers()
struct PosedGeometry {
  Geometry geometry;           // moved
  std::vector<Vec3f> normals;  // #S
};
PosedGeometry posedGeometry(const Character& character, const AssetSkeleton& skeleton, const Pose& pose,
                            const Deformer& deformer = kLinearBlendDeformer);

// The same for many poses: what the deformer needs is prepared once. Skins that were bound in several poses are moved by
// their own inverse binds each, but by deformers that look at the whole surface (those with a preparation): by the binds
// of withJoinedBinds.
class AssetPoser {
 public:
  AssetPoser(const Character& character, const AssetSkeleton& skeleton, const Deformer& deformer);
  AssetPoser(const AssetPoser&) = delete;
  AssetPoser& operator=(const AssetPoser&) = delete;

  // With blend shapes as the nodes have them, or with weights of readShapeWeights(document, ...).
  PosedGeometry posed(const Pose& pose) const { return moved(bound_, pose, shapes_); }
  PosedGeometry posed(const Pose& pose, const ShapeWeights& shapes) const;
  const SkinWeights& weights() const { return weights_; }  // #S rows, each with a sum of 1 or 0

 private:
  bool isJoined() const { return &whole_.document() != &character_.document(); }
  PosedGeometry moved(PosedGeometry surface, const Pose& pose, const ShapeWeights& shapes) const;

  Character character_, whole_;  // as it is given, and inOneBindPose()
  Skeleton skeleton_;
  const Deformer& deformer_;
  ShapeWeights shapes_;  // as the nodes have them
  PosedGeometry bound_;
  SkinWeights weights_;
  std::vector<Vec3> centers_;  // of joints
  std::shared_ptr<const DeformPreparation> prepared_;
  std::optional<OwnBinds> ownBinds_;
};

}  // namespace limber
