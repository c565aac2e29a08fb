// The parts of a model as its file has it.
#pragma once

#include <optional>
#include <string_view>

#include "limber/actions/parts/shape_parts.h"
#include "limber/actions/parts/weight_parts.h"
#include "limber/character/character.h"

namespace limber {

enum class PartMethod {
  kAuto,     // by weights where the model has a rig, else by shape
  kWeights,  // partsByWeights
  kShape,    // partsByShape
};

struct PartOptions {
  PartMethod method = PartMethod::kAuto;
  PartDetail detail = PartDetail::kLimbs;  // by weights; a skeleton that shows one limb alone goes by joints
  std::optional<Index> count;              // by shape, 1 to kMostShapeParts
};

// "auto", "weights", "shape"; "limbs", "joints". Throw Error kBadArgument that lists them.
PartMethod parsePartMethod(std::string_view name);
PartDetail parsePartDetail(std::string_view name);

// A part for each triangle of the character's surface. Vertices at one position count as one; triangles with two corners
// at one position go with a triangle beside them. Throws Error kBadArgument where parts by weights are asked of a model
// without a rig, and what the methods throw. Cost: theirs and O(#F).
SurfaceParts modelParts(const Character& character, const PartOptions& options, Progress& progress);

// The same by weights, for a surface and a rig that no file has yet. `weights` has #S rows over the skeleton's joints.
SurfaceParts riggedParts(const Geometry& geometry, const Skeleton& skeleton, const SkinWeights& weights,
                         PartDetail detail);

}  // namespace limber
