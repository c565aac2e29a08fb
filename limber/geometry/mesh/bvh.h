// A tree of boxes over the triangles of a mesh: what a ray meets, and the surface point nearest to a point.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// A point of the surface: sum over k of weights[k] * position of the triangle's k-th corner.
struct SurfacePoint {
  Index triangle = 0;
  Vec3 weights = Vec3::Zero();  // barycentric, each in [0, 1], sum 1
  Vec3 position = Vec3::Zero();
  double distance = 0;  // from the point asked about; for a ray the parameter t
};

// The corner of its triangle that the point is nearest to by its weights; the first of several.
Index nearestCorner(const TriMesh& mesh, const SurfacePoint& point);

// Bounding volume hierarchy of up to four children a node, built by the surface area heuristic over binned centroids
// (Wald 2007). The tree is the same for any number of threads. It keeps a copy of the corners; the mesh may go.
//
// Rays meet both sides of a triangle, and a ray through a shared edge or corner meets at least one of the triangles
// there (Woop, Benthin, Wald 2013, in double precision). Triangles of zero area are met by no ray, but count as surface
// for nearest points.
//
// Cost: O(#F log #F) to build, at most 85 bytes for each triangle; queries O(log #F) in practice.
class Bvh {
 public:
  explicit Bvh(const TriMesh& mesh);
  // Only over the named triangles (in range, any order).
  Bvh(const TriMesh& mesh, std::span<const Index> triangles);

  // Whether the open segment from `from` to `to` passes through a triangle. Triangles that have a corner exactly at
  // `from` do not count, nor does a hit within `margin` of either end.
  bool segmentBlocked(const Vec3& from, const Vec3& to, double margin = 0) const;

  // The first triangle that origin + t * direction meets for 0 < t < maxT. `direction` need not be a unit vector.
  std::optional<SurfacePoint> firstHit(const Vec3& origin, const Vec3& direction, double maxT) const;

  // The nearest point of the surface. Ties go to the lowest triangle. Throws Error kBadArgument for a tree without
  // triangles.
  SurfacePoint nearestPoint(const Vec3& point) const;

  Index triangleCount() const { return static_cast<Index>(leaves_.size()); }

 private:
  struct Leaf {  // one triangle
    Vec3f corners[3];
    Index triangle;
  };
  struct Node;
  struct NodeDeleter {
    void operator()(Node* nodes) const;
  };
  struct Item;
  struct Ray;
  friend class BvhBuilder;

  void build(const TriMesh& mesh, std::vector<Item>& items);

  std::vector<Leaf> leaves_;
  std::unique_ptr<Node[], NodeDeleter> nodes_;
};

}  // namespace limber
