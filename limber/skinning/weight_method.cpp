#include "limber/skinning/weight_method.h"

#include <string>

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
  std::string known;
  for (const WeightMethod& method : kMethods) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + std::string(method.name);
  }
  throw Error(ErrorCode::kBadArgument, "no skinning method is called '" + std::string(name) + "'", {},
              "there are: " + known);
}

}  // namespace limber
