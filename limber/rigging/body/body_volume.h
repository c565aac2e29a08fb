// The inside of a model as a template needs it: the depth of each position, the middle of its parts, and their ends.
#pragma once

#include <memory>
#include <vector>

#include "limber/geometry/mesh/signed_distance.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// A ball inside the model that touches the surface on more than one side.
struct MedialSphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

struct BodyVolume {
  std::unique_ptr<const SignedDistance> distance;
  std::vector<MedialSphere> spheres;  // deepest first, a few hundred
};

// Whole pieces that are turned inside out are turned back first; inside is where the winding number says so.
//
// mesh  as prepareMesh makes it: longest side 1
// Throws Error kUnsupported where nothing lies inside (a flat sheet), or inside and outside cannot be told apart. Cost:
// O(#F log #F), and a grid of 80 cells along the longest side.
BodyVolume measureBody(const TriMesh& mesh);

// An end of a limb, or of a bump.
struct LimbTip {
  Vec3 position = Vec3::Zero();
  double reach = 0;  // of the path to it from the paths to the tips before it; the first from the middle
  double depth = 0;  // the greatest along that path: about 0.5 reach and more for what is no longer than it is thick
};

// The ends of limbs, each as far from the middle, inside the model, as it goes thereabouts. Farthest first, by the path
// to the ends before it and the paths there.
std::vector<LimbTip> limbTips(const BodyVolume& body);

}  // namespace limber
