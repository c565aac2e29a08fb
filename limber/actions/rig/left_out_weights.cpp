#include "limber/actions/rig/left_out_weights.h"

#include <algorithm>

#include "limber/geometry/mesh/bvh.h"

namespace limber {

std::vector<Index> outerVertices(const FigureSurface& surface) {
  if (surface.innerShell.empty()) return {};
  const TriMesh& mesh = surface.prepared.mesh;
  const Bvh bvh(mesh);
  std::vector<bool> isLeftOut(mesh.vertexCount(), false);
  for (const Index v : surface.innerShell) isLeftOut[v] = true;
  std::vector<Index> outer = surface.innerShell;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    if (surface.innerShellOuter[i] != kNoIndex) outer[i] = surface.innerShellOuter[i];
    if (isLeftOut[outer[i]]) outer[i] = nearestCorner(mesh, bvh.nearestPoint(mesh.position(outer[i])));
  }
  return outer;
}

void bindLeftOut(const FigureSurface& surface, SkinWeights& weights) {
  for (const Index v : surface.surroundings) bindTo(0, v, weights);
  const std::vector<Index> outer = outerVertices(surface);
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(outer[i]) * weights.slots;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(surface.innerShell[i]) * weights.slots;
    std::copy_n(weights.joints.begin() + from, weights.slots, weights.joints.begin() + to);
    std::copy_n(weights.weights.begin() + from, weights.slots, weights.weights.begin() + to);
  }
}

}  // namespace limber
