// A mesh approximated by spheres, any number of them, read off one recorded collapse.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/surface/mirror_map.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/sphere_mesh/collapse_sequence.h"
#include "limber/rigging/sphere_mesh/joined_nodes.h"
#include "limber/rigging/sphere_mesh/sphere_mesh_builder.h"

namespace limber {

// One number of spheres. Indices in it are handles: 0 to spheres.size().
struct SphereMeshLevel {
  std::vector<Sphere> spheres;    // in the space of the mesh
  std::vector<double> weights;    // fraction of the surface that each sphere represents, by area
  std::vector<Index> images;      // its mirror image, itself on the plane, kNoIndex if none; empty without symmetry.
                                  // Of two images the first is on the plane's positive side
  std::vector<VertexPair> edges;  // between neighbours, first < second, ordered; they connect all spheres
  std::vector<double> borders;  // per edge: length of the border between the surfaces that the two represent, 0 between
                                // pieces that are apart; empty where it is not known
};

struct LimbCount {
  Index limbs = 0;          // that are at least a quarter as long as the longest
  Index fewestHandles = 1;  // at which each that is at least half as long as the longest has one of its own at its end
};

// Sphere-Meshes: Shape Approximation using Spherical Quadric Error Metrics; Thiery, Guy, Boubekeur; 2013.
//
// The collapse starts from every vertex as a sphere of radius 0 and merges neighbours, cheapest first, into the sphere
// that is nearest to the planes of all triangles that either represented (SphereQuadric). Separate pieces are linked
// where they are nearest; fragments that float count for less (strayFractions). On a model that is its own mirror image
// a merge and its image are one step, so that spheres come in exact mirror pairs or lie exactly on the plane, at every
// count up to the number of vertices that have an image.
class SphereMesh {
 public:
  // Records the whole collapse. Of a model with more than maxStartNodes vertices (pairs of images count as one) it
  // begins with such as are near each other joined (joinNearNodes), which it would merge first. Throws Error kBadData
  // for a mesh without vertices, kLimit for more than 2^30. Cost: O(#V log #V), two to four microseconds a vertex; 0.9
  // kB a vertex while it runs.
  static SphereMesh build(const TriMesh& mesh, Progress& progress, Index maxStartNodes = kMaxStartNodes);

  Index vertexCount() const { return static_cast<Index>(vertexEnds_.size()); }
  // As many as vertices, but on models of more than maxStartNodes.
  Index maxSpheres() const { return sequence_.initialCount + static_cast<Index>(loose_.size()); }
  const std::optional<MirrorPlane>& mirror() const { return mirror_; }

  // Throws Error kBadArgument unless 1 <= count <= maxSpheres(). Cost: O(count log #V).
  SphereMeshLevel level(Index count) const;
  // For each vertex the sphere of level(count) that represents it. Cost: O(#V).
  std::vector<Index> vertexHandles(Index count) const;

  // How far the surface's tangent planes are from the spheres, root mean square over its area, in units of the mesh,
  // for each count from 0 (infinite) to maxCount; never more for a larger count. Cost: O(maxCount).
  std::vector<double> errors(Index maxCount) const;

  // Cost: O(#limbs).
  LimbCount limbs() const;

  // The record itself, in the collapse's own space.
  const CollapseSequence& sequence() const { return sequence_; }

 private:
  struct Cut;
  struct BorderedEdge;

  Cut cutAt(Index count) const;
  void listNodes(Cut& cut) const;
  void appendLoose(const Cut& cut, SphereMeshLevel& level, std::vector<BorderedEdge>& edges) const;
  std::vector<BorderedEdge> edgesOf(const Cut& cut) const;
  EdgeEnd climb(EdgeEnd end, const Cut& cut) const;
  Sphere toMesh(const Vec3f& center, float radius, bool image) const;

  CollapseSequence sequence_;
  std::vector<EdgeEnd> vertexEnds_;  // per vertex: its node, crossing where it is on the image's side
  std::vector<Vec3f> nodeCenters_;   // per node
  std::vector<float> nodeWeights_;   // per node, of one of a pair
  std::vector<LooseVertex> loose_;
  std::vector<Vec3f> loosePositions_;  // in the mesh's space
  std::optional<MirrorPlane> mirror_;
  CollapseFrame frame_;
};

}  // namespace limber
