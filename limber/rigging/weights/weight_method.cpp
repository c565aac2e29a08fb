#include "limber/rigging/weights/weight_method.h"

#include <algorithm>
#include <optional>
#include <string>

#include "limber/core/text/names.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/loose_vertices.h"
#include "limber/rigging/weights/bone_distance.h"
#include "limber/rigging/weights/bone_heat.h"
#include "limber/rigging/weights/lattice/bounded_biharmonic.h"
#include "limber/rigging/weights/lattice/geodesic_voxel.h"
#include "limber/rigging/weights/specks.h"

namespace limber {

namespace {

// What the surface alone got, for the vertices of a mesh with loose ones, which take that of the nearest vertex of it.
WeightResult withLooseVertices(WeightResult result, const BareSurface& surface, const TriMesh& mesh) {
  std::vector<Index> from(mesh.vertexCount(), kNoIndex);
  for (Index v = 0; v < surface.source.size(); ++v) from[surface.source[v]] = v;
  for (Index& v : result.bridged) v = surface.source[v];
  const Bvh bvh(surface.mesh);
  for (Index v = 0; v < from.size(); ++v) {
    if (from[v] != kNoIndex) continue;
    from[v] = nearestCorner(surface.mesh, bvh.nearestPoint(mesh.position(v)));
    result.bridged.push_back(v);
  }
  std::sort(result.bridged.begin(), result.bridged.end());
  result.weights = expandWeights(result.weights, from);
  return result;
}

// The method, and what holds for all of them: loose vertices are no pieces, and change nothing of the surface's
// weights.
template <WeightFunction method>
WeightResult computed(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                      Progress& progress) {
  if (const std::optional<BareSurface> surface = withoutLooseVertices(mesh)) {
    WeightOptions ofSurface = options;
    if (!options.jointOf.empty()) {
      ofSurface.jointOf.clear();
      for (const Index v : surface->source) ofSurface.jointOf.push_back(options.jointOf[v]);
    }
    return withLooseVertices(computed<method>(surface->mesh, bones, ofSurface, progress), *surface, mesh);
  }
  WeightResult result = method(mesh, bones, options, progress);
  if (options.pieces != PieceMode::kSoft) holdSpecks(mesh, result.weights);
  return result;
}

constexpr WeightMethod kMethods[] = {
    {"bone-heat", "heat that flows from each bone over the surface",
     "Baran, Popović: Automatic Rigging and Animation of 3D Characters, 2007", &computed<&boneHeatWeights>},
    {"geodesic-voxel", "the ways to bones through the inside, on a grid",
     "Dionne, de Lasa: Geodesic Voxel Binding, 2013", &computed<&geodesicVoxelWeights>},
    {"bounded-biharmonic", "the smoothest weights through the inside that stay between 0 and 1",
     "Jacobson, Baran, Popović, Sorkine: Bounded Biharmonic Weights, 2011", &computed<&boundedBiharmonicWeights>},
    {"envelopes", "bones hold what is near them, whatever lies between", "", &computed<&envelopeWeights>},
    {"nearest-bone", "each vertex follows the nearest bone alone", "", &computed<&nearestBoneWeights>},
};

constexpr NamedPieceMode kPieceModes[] = {
    {"auto", "hard parts follow one joint each, others bend", PieceMode::kAuto},
    {"rigid", "every piece follows one joint", PieceMode::kRigid},
    {"soft", "every piece may bend", PieceMode::kSoft},
};

}  // namespace

std::span<const NamedPieceMode> pieceModes() {
  return kPieceModes;
}

PieceMode findPieceMode(std::string_view name) {
  return findByName(kPieceModes, "way to bind pieces", name).mode;
}

std::span<const WeightMethod> weightMethods() {
  return kMethods;
}

const WeightMethod& findWeightMethod(std::string_view name) {
  return findByName(kMethods, "skinning method", name);
}

}  // namespace limber
