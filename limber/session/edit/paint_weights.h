// Weights painted onto the surface with a brush.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limber/geometry/surface/surface_distance.h"
#include "limber/session/command.h"
#include "limber/session/drag/pick.h"
#include "limber/session/edit/mirror_pose.h"
#include "limber/session/rigged_model.h"

namespace limber {

// The surface as a brush runs over it: welded, as bound, in metres. One for all rigs of the same Geometry.
class PaintSurface {
 public:
  explicit PaintSurface(std::shared_ptr<const Geometry> geometry);

  const std::shared_ptr<const Geometry>& geometry() const { return geometry_; }
  const SurfaceDistance& distance() const { return distance_; }
  Index weldedVertex(Index source) const { return weldedVertex_[source]; }
  // The vertices at the position of a welded one, ascending; never empty.
  std::span<const Index> sources(Index welded) const { return sources_.of(welded); }
  // Found when it is asked for first; none where the model is not its own mirror image.
  const std::optional<MirrorMap>& mirror() const;

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::vector<Index> weldedVertex_;
  SurfaceDistance distance_;
  Grouped<Index> sources_;  // by welded vertex
  mutable bool soughtMirror_ = false;
  mutable std::optional<MirrorMap> mirror_;
};

// A stroke as it grows. Its result depends on where the brush has been, not on how often or in which order: at each
// vertex the nearest dab counts, and changes the weights from before the stroke. Vertices at one position (seams) get
// equal weights.
class WeightStroke {
 public:
  // `rig` and `surface` must outlive it; locked: #J. Throws Error kBadArgument for a joint that is not there or locked,
  // a strength that is not between 0 and 1, a radius that is not above 0; kUnsupported for both sides of a model that
  // is not its own mirror image.
  WeightStroke(const RiggedModel& rig, const PaintSurface& surface, std::vector<bool> locked,
               const PaintWeights& settings);

  // Throws Error kBadArgument for a dab beside the surface; then none of them counts.
  void add(std::span<const SurfaceDab> dabs);
  SkinWeights weights() const;

 private:
  void paint(SkinWeights& weights) const;
  void smooth(SkinWeights& weights) const;
  void reach(Index welded, double amount, std::vector<double>& amounts);

  const RiggedModel& rig_;
  const PaintSurface& surface_;
  std::vector<bool> locked_;
  PaintWeights settings_;
  std::optional<Index> joint_, image_, heir_, imageHeir_;
  std::vector<double> amounts_, imageAmounts_;  // #W, 0 to 1: how near the brush came, on this side and on the other
  std::vector<Index> touched_;                  // welded vertices with either above 0
};

// One side's weights for the other, joint by joint and vertex by vertex; what lies on the plane becomes symmetric.
// Joints without an image keep their part. Throws Error kUnsupported where the model is not its own mirror image.
SkinWeights mirroredWeights(const RiggedModel& rig, const PaintSurface& surface, const std::vector<bool>& locked,
                            MirrorFrom from);

// What painting needs again for every dab, kept between them.
class Brush {
 public:
  // Where the ray meets the surface as the deformer bends it in that pose.
  std::optional<SurfaceHit> hit(const Ray& ray, const std::shared_ptr<const RiggedModel>& rig, const Pose& pose,
                                const Deformer& deformer);
  const PaintSurface& surface(const RiggedModel& rig);
  // The weights that the stroke would leave. Cheapest where it is the last one with further dabs.
  SkinWeights preview(const std::shared_ptr<const RiggedModel>& rig, const std::vector<bool>& locked,
                      const PaintWeights& stroke);

 private:
  std::unique_ptr<PaintSurface> surface_;
  std::shared_ptr<const RiggedModel> pickedRig_, paintedRig_;
  Pose pickedPose_;
  const Deformer* pickedDeformer_ = nullptr;
  std::unique_ptr<SurfacePicker> picker_;
  std::unique_ptr<WeightStroke> stroke_;
  PaintWeights painted_;
  std::vector<bool> paintedLocks_;
};

}  // namespace limber
