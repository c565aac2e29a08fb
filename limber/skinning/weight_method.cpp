#include "limber/skinning/weight_method.h"

#include <string>

#include "limber/core/names.h"
#include "limber/skinning/bone_heat.h"

namespace limber {

namespace {

constexpr WeightMethod kMethods[] = {
    {"bone-heat", "heat that flows from each bone over the surface",
     "Baran, Popović: Automatic Rigging and Animation of 3D Characters, 2007", &boneHeatWeights},
};

}  // namespace

std::span<const WeightMethod> weightMethods() {
  return kMethods;
}

const WeightMethod& findWeightMethod(std::string_view name) {
  return findByName(kMethods, "skinning method", name);
}

}  // namespace limber
