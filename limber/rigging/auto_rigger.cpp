#include "limber/rigging/auto_rigger.h"

#include "limber/core/names.h"
#include "limber/rigging/curve_skeleton_rigger.h"
#include "limber/rigging/prop_rigger.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/rigging/template_rigger.h"

namespace limber {

namespace {

constexpr RiggerMethod kMethods[] = {
    {"sphere-mesh", "handles where the model is thick, any number of them",
     "Thiery, Guy, Boubekeur: Sphere-Meshes, 2013", &rigWithSphereMesh, false},
    {"curve-skeleton", "joints along curves through the middle of limbs, any number of them",
     "Au, Tai, Chu, Cohen-Or, Lee: Skeleton Extraction by Mesh Contraction, 2008", &rigWithCurveSkeleton, false},
    {"template", "a named skeleton fitted into the model", "after Baran, Popović: Pinocchio, 2007", &rigWithTemplate,
     true},
    {kPropRigger, "one joint for all of it: a thing that does not bend", "", &rigAsProp, false},
};

}  // namespace

std::span<const RiggerMethod> riggerMethods() {
  return kMethods;
}

const RiggerMethod& findRigger(std::string_view name) {
  return findByName(kMethods, "rigger", name);
}

}  // namespace limber
