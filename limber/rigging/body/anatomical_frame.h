// The orientation of a model: its up, front and left, and the plane between left and right.
#pragma once

#include <optional>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

// Body space: x to the left of the body, y up from 0 (lowest) to 1 (highest), z to the front; x = 0 is the plane
// between left and right.
struct AnatomicalFrame {
  Mat3 axes = Mat3::Identity();  // rows: left, up and front in the mesh's space
  Vec3 origin = Vec3::Zero();    // in the mesh's space
  double height = 1;             // of the mesh along up
  double asymmetry = 1;          // 0 where both halves are the same; about 1 where they have nothing in common

  bool symmetric() const;
  Vec3 toBody(const Vec3& point) const { return axes * (point - origin) / height; }
  Vec3 fromBody(const Vec3& position) const { return origin + height * (axes.transpose() * position); }
  Vec3 mirrored(const Vec3& point) const;  // both in the mesh's space
};

// The frame of a body whose up and front are given (unit vectors, right angles between them); finds the plane between
// left and right.
AnatomicalFrame frameAlong(const TriMesh& mesh, const BodyVolume& body, const Vec3& up, const Vec3& front);

// Hypotheses of the body's orientation, likeliest first: all that agree with the given directions (unit vectors along
// axes). Without up: +Y, then +Z, then the others. Both fronts of each plane of symmetry are among them. A body that is
// symmetric to no plane across the axes, but to another, is rotated or leans: its hypotheses are the orientations along
// that plane, with ups nearest to these.
std::vector<AnatomicalFrame> possibleFrames(const TriMesh& mesh, const BodyVolume& body, const std::optional<Vec3>& up,
                                            const std::optional<Vec3>& front);

}  // namespace limber
