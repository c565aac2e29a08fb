// Whether a model is its own mirror image, and which vertex is whose image.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// Points p with normal . p == offset. The positive side is the model's left where the normal is +X and it faces +Z.
struct MirrorPlane {
  Vec3 normal = Vec3::UnitX();
  double offset = 0;
};

struct MirrorMap {
  MirrorPlane plane;
  std::vector<Index> image;  // per vertex: its mirror image; itself if it is on the plane; kNoIndex where it has none
};

// Looks for a mirror plane at which at least 98 of 100 vertices, and of the surface's area, have an image within three
// thousandths of the longest side of modelBox (a model set in a pose by hand may be no nearer). Planes across x, z and
// y are tried in this order, through the middle of the box and through the centroid, then those across the principal
// axes; the first that fits is taken. Connectivity does not matter. Where there is none, the sides may also only look
// equal, as those of scans and sculptures: the first plane is taken at which 98 of 100 vertices and of the area,
// mirrored, lie within 15 thousandths of the surface (of a sample of both), and three quarters of the vertices have an
// image within that, or within the distance of neighbors, at most 30 thousandths. Images are mutual: image[image[v]]
// == v. There is none, too, once `progress` (if given; only asked for this, from any thread) is cancelled. Cost: O(#V
// log #V).
std::optional<MirrorMap> findMirror(const TriMesh& mesh, const Progress* progress = nullptr);

}  // namespace limber
