#include "limber/rigging/auto_rigger.h"

#include <optional>
#include <utility>
#include <vector>

#include "limber/core/text/names.h"
#include "limber/geometry/mesh/loose_vertices.h"
#include "limber/rigging/curve_skeleton_rigger.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

template <AutoRigger method>
AutoRig rigSurface(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  const std::optional<BareSurface> surface = withoutLooseVertices(mesh);
  if (!surface) return method(mesh, options, progress);
  AutoRig rig = method(surface->mesh, options, progress);
  if (rig.jointOf.empty()) return rig;
  std::vector<Index> jointOf(mesh.vertexCount(), kNoIndex);
  for (Index v = 0; v < rig.jointOf.size(); ++v) jointOf[surface->source[v]] = rig.jointOf[v];
  rig.jointOf = std::move(jointOf);
  return rig;
}

constexpr RiggerMethod kMethods[] = {
    {"sphere-mesh", "handles where the model is thick, any number of them",
     "Thiery, Guy, Boubekeur: Sphere-Meshes, 2013", &rigSurface<rigWithSphereMesh>, false},
    {"curve-skeleton", "joints along curves through the middle of limbs, any number of them",
     "Au, Tai, Chu, Cohen-Or, Lee: Skeleton Extraction by Mesh Contraction, 2008", &rigSurface<rigWithCurveSkeleton>,
     false},
    {"template", "a named skeleton fitted into the model, as networks read its shape", "", &rigSurface<rigWithTemplate>,
     true},
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
