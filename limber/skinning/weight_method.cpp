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
