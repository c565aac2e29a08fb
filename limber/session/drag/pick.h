// What a pointer points at.
#pragma once

#include <optional>
#include <span>

#include "limber/geometry/mesh/bvh.h"
#include "limber/session/command.h"
#include "limber/session/rigged_model.h"

namespace limber {

struct PickHit {
  Index joint = 0;
  bool onHandle = false;  // else on the surface: the joint that holds it most
  Vec3 position = Vec3::Zero();
  double distance = 0;         // along the ray, in metres
  Vec3 inside = Vec3::Zero();  // of the surface: midway to where the ray leaves it again; of a handle its position
};

// The handle that the ray meets first; else, of those that it passes within `slope` times their distance, the one it
// passes closest to as seen from the ray's origin: small handles are as large as a finger. A slope of 0 takes them as
// they are.
//
// centers, radii  #J spheres
std::optional<PickHit> pickHandle(const Ray& ray, std::span<const Vec3> centers, std::span<const double> radii,
                                  double slope);

// A point of the posed surface, for a brush.
struct SurfaceHit {
  SurfaceDab dab;  // the same point on the surface as bound
  Vec3 position = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  // of the triangle, towards where the ray came from
  Index joint = 0;              // that holds it most
  Vec3 inside = Vec3::Zero();   // as of PickHit
};

// A tree of the posed surface, for many rays.
class SurfacePicker {
 public:
  // `model` must outlive it. Cost: that of posedPositions and O(#F log #F).
  SurfacePicker(const RiggedModel& model, const Pose& pose, const Deformer& deformer = kLinearBlendDeformer);
  std::optional<SurfaceHit> hit(const Ray& ray) const;

 private:
  const RiggedModel& model_;
  TriMesh posed_;
  Bvh tree_;
};

// The point of the posed surface that the ray meets first. Cost: O(#F log #F), a tree of the posed surface.
std::optional<PickHit> pickSurface(const Ray& ray, const RiggedModel& model, const Pose& pose,
                                   const Deformer& deformer = kLinearBlendDeformer);

}  // namespace limber
