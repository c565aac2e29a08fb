// What every method of making skin weights is. One table lists them by name.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// How the pieces of a model that are not joined to others are bound.
enum class PieceMode {
  kAuto,   // pieces that are hard parts follow one joint each, others bend
  kRigid,  // every piece follows one joint
  kSoft,   // every piece may bend
};

struct NamedPieceMode {
  std::string_view name;     // "auto"
  std::string_view summary;  // one line for --help
  PieceMode mode;
};
std::span<const NamedPieceMode> pieceModes();
// Throws Error kBadArgument that lists the names there are.
PieceMode findPieceMode(std::string_view name);

struct WeightOptions {
  Index maxInfluences = 4;  // 1 to 8, kept per vertex
  PieceMode pieces = PieceMode::kAuto;
  // #V: the joint whose region each vertex is of, where the rigger knows (AutoRig); empty: the nearest bone in sight.
  // Bone heat alone uses it.
  std::vector<Index> jointOf = {};
};

struct WeightResult {
  SkinWeights weights;         // for #V vertices of the mesh; every vertex has at least one influence
  std::vector<Index> bridged;  // ascending: vertices that no bone reaches, which took the weights of what is nearest
  Warnings warnings;
};

// bones  from bonesOf(); in the space of the mesh
using WeightFunction = WeightResult (*)(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                        Progress& progress);

struct WeightMethod {
  std::string_view name;     // "bone-heat"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  WeightFunction compute;
};

std::span<const WeightMethod> weightMethods();
// Throws Error kBadArgument that lists the names there are.
const WeightMethod& findWeightMethod(std::string_view name);

}  // namespace limber
