// Turns a mesh into the spheres and edges that the collapse begins with.
#pragma once

#include <optional>
#include <vector>

#include "limber/geometry/surface/mirror_map.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/sphere_mesh/collapse_sequence.h"

namespace limber {

// The space of the collapse: longest side of the box 1, mirror plane (if any) x = 0. p_mesh = axes (scale p) + origin
struct CollapseFrame {
  Mat3 axes = Mat3::Identity();  // a rotation
  Vec3 origin = Vec3::Zero();
  double scale = 1;

  static CollapseFrame of(const TriMesh& mesh, const std::optional<MirrorPlane>& mirror);
  Vec3f toCollapse(const Vec3f& p) const;
};

// A vertex without an image on a symmetric model: merged into `node` before the recorded collapse begins.
struct LooseVertex {
  Index vertex = 0;
  Index node = 0;
};

struct CollapseStart {
  CollapseInput input;
  std::vector<EdgeEnd> vertexEnds;  // per vertex: its node, crossing where it is on the image's side
  std::vector<Vec3f> nodeCenters;   // per node, x >= 0
  std::vector<LooseVertex> loose;   // in the order in which they merge
};

// points  the mesh's positions in the collapse's space
CollapseStart collapseStart(const TriMesh& mesh, const std::vector<Vec3f>& points, const SurfaceEdges& surface,
                            const std::optional<MirrorMap>& mirror);

}  // namespace limber
