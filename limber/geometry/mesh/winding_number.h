// How often a surface winds round a point: 1 inside, 0 outside, in between where the surface has holes.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// The generalised winding number of triangles (Jacobson, Kavan, Sorkine-Hornung 2013): their signed solid angle over
// 4 pi. It tells inside from outside on meshes that are open, in many pieces, or cross themselves. Far clusters count
// by their expansion to the second order (Barill, Dickson, Schmidt, Levin, Jacobson 2018), near ones triangle by
// triangle.
//
// The clusters are the cells of an octree, found by sorting along a space-filling curve; the same for any number of
// threads. Cost: O(#F log #F) to build, about 45 bytes for each triangle; a query O(log #F) in practice.
class WindingNumber {
 public:
  // accuracy  a cluster counts as far from this many of its radii on; larger is nearer to the exact sum, and slower
  // flipped   #F, triangles that count as turned round; may be empty
  explicit WindingNumber(const TriMesh& mesh, const std::vector<bool>& flipped = {}, double accuracy = 2);

  // At any finite point; on the surface itself one of the values beside it, or between them.
  double at(const Vec3& point) const;

  // The sum of all solid angles, O(#F).
  double exactAt(const Vec3& point) const;

 private:
  struct Corners {
    Vec3f corners[3];
  };
  struct Node {
    Vec3f center = Vec3f::Zero();  // of the area
    float radius = 0;              // of a ball round it that holds the triangles
    Vec3f area = Vec3f::Zero();    // sum of the vector areas
    float first[6] = {};           // symmetric part of the first moment: xx yy zz, xy + yx, yz + zy, zx + xz
    Vec3f trace = Vec3f::Zero();   // of the second moment
    float second[10] = {};         // the second moment as a cubic form
    Index begin = 0, end = 0;      // triangles
    Index firstChild = 0;          // children stand side by side
    std::uint8_t childCount = 0;
  };

  void split(Index node, std::span<const std::uint64_t> codes, int level);
  void expand(Node& node) const;
  double far(const Node& node, const Vec3& away) const;

  std::vector<Corners> triangles_;  // in the order of the curve
  std::vector<Node> nodes_;         // parents before children
  double accuracy_;
};

// Which of a few points the surface winds round, however it faces: |winding number| above a half. By one pass over all
// triangles, which takes less than to build the octree. Cost: O(#points #F), in parallel.
std::vector<bool> areInside(const TriMesh& mesh, std::span<const Vec3> points);

}  // namespace limber
