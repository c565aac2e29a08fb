#include "limber/pipeline/left_out_weights.h"

#include <algorithm>

#include "limber/mesh/bvh.h"

namespace limber {

void bindLeftOut(const FigureSurface& surface, SkinWeights& weights) {
  for (const Index v : surface.surroundings) bindTo(0, v, weights);
  if (surface.innerShell.empty()) return;
  const TriMesh& mesh = surface.prepared.mesh;
  const Bvh bvh(mesh);
  for (const Index v : surface.innerShell) {
    const SurfacePoint nearest = bvh.nearestPoint(mesh.position(v));
    Eigen::Index corner = 0;
    nearest.weights.maxCoeff(&corner);
    const Index from = mesh.triangles[nearest.triangle][static_cast<std::size_t>(corner)];
    std::copy_n(weights.joints.begin() + std::ptrdiff_t{from} * weights.slots, weights.slots,
                weights.joints.begin() + std::ptrdiff_t{v} * weights.slots);
    std::copy_n(weights.weights.begin() + std::ptrdiff_t{from} * weights.slots, weights.slots,
                weights.weights.begin() + std::ptrdiff_t{v} * weights.slots);
  }
}

}  // namespace limber
