#include "limber/rigging/auto_rigger.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "limber/core/names.h"
#include "limber/rigging/curve_skeleton_rigger.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

// The mesh without its loose vertices; nothing where it has none.
std::optional<TriMesh> withoutLooseVertices(const TriMesh& mesh) {
  std::vector<Index> kept(mesh.vertexCount(), kNoIndex);
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) kept[v] = 0;
  }
  if (mesh.triangles.empty() || std::find(kept.begin(), kept.end(), kNoIndex) == kept.end()) return std::nullopt;
  TriMesh result;
  for (Index v = 0; v < kept.size(); ++v) {
    if (kept[v] == kNoIndex) continue;
    kept[v] = result.vertexCount();
    result.positions.push_back(mesh.positions[v]);
  }
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({kept[t[0]], kept[t[1]], kept[t[2]]});
  return result;
}

template <AutoRigger method>
AutoRig rigSurface(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  const std::optional<TriMesh> surface = withoutLooseVertices(mesh);
  return method(surface ? *surface : mesh, options, progress);
}

constexpr RiggerMethod kMethods[] = {
    {"sphere-mesh", "handles where the model is thick, any number of them",
     "Thiery, Guy, Boubekeur: Sphere-Meshes, 2013", &rigSurface<rigWithSphereMesh>, false},
    {"curve-skeleton", "joints along curves through the middle of limbs, any number of them",
     "Au, Tai, Chu, Cohen-Or, Lee: Skeleton Extraction by Mesh Contraction, 2008", &rigSurface<rigWithCurveSkeleton>,
     false},
    {"template", "a named skeleton fitted into the model", "after Baran, Popović: Pinocchio, 2007",
     &rigSurface<rigWithTemplate>, true},
    {kPropRigger, "one joint for all of it: a thing that does not bend", "", &rigSurface<rigAsProp>, false},
};

}  // namespace

std::span<const RiggerMethod> riggerMethods() {
  return kMethods;
}

const RiggerMethod& findRigger(std::string_view name) {
  return findByName(kMethods, "rigger", name);
}

}  // namespace limber
