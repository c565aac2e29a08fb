// The light of a photographer's studio: soft key, fill and rim under a bright ceiling, with soft shadows.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Light from one direction, with the depth map that tells what the model hides from it.
struct DirectionalLight {
  Mat3 axes = Mat3::Identity();  // rows: across, up, towards the light
  Vec3 color = Vec3::Zero();
  bool castsOnGround = true;
  std::vector<float> depth;  // resolution^2, the surface nearest to the light
};

// Some sixty directional lights that together stand for large soft lamps and a ceiling. Shadows of the lamps, darkness
// in folds and the contact shadow on the ground all follow from them.
class StudioLight {
 public:
  // The lamps stand relative to a camera at that azimuth (degrees). Shadows are those of the given triangles, on each
  // other and on the ground, which lies at that height.
  // Cost: one small depth map per light, in parallel.
  StudioLight(std::span<const Vec3f> positions, std::span<const Triangle> triangles, double azimuth,
              double groundHeight);

  struct Shade {
    Vec3 diffuse = Vec3::Zero();   // irradiance over pi
    Vec3 specular = Vec3::Zero();  // of a satin surface
  };
  // point, unit normal (on the viewer's side) and unit direction to the viewer, in world space
  Shade shade(const Vec3& point, const Vec3& normal, const Vec3& toViewer) const;
  // The same for something that no shadow falls on (handles inside the model).
  Shade shadeUnshadowed(const Vec3& normal, const Vec3& toViewer) const;

  // Part of the light that reaches the ground there, 0 to 1. Smooth: it is kept as a blurred map.
  double groundLight(const Vec3& point) const;
  double groundHeight() const { return groundHeight_; }

 private:
  double visibility(const DirectionalLight& light, const Vec3& point) const;
  void renderDepth(DirectionalLight& light, std::span<const Vec3f> positions,
                   std::span<const Triangle> triangles) const;
  void bakeGround();

  std::vector<DirectionalLight> lights_;
  Vec3 center_ = Vec3::Zero();
  double radius_ = 1;  // of the sphere round the model
  double texelsPerUnit_ = 1;
  double groundHeight_ = 0;
  std::vector<float> ground_;
};

}  // namespace limber
