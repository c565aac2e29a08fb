// What every automatic rigger is: a mesh goes in, a skeleton comes out. One table lists them by name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/progress.h"
#include "limber/mesh/tri_mesh.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

struct RigOptions {
  std::optional<Index> handles;  // joints wanted, 1 to #V; none: the best suggested count
};

// A count of handles worth choosing.
struct HandleSuggestion {
  Index handles = 0;
  double score = 0;  // 0 to 1, how clearly the error jumps there; suggestions come best first
};

struct AutoRig {
  Skeleton skeleton;  // in the space of the mesh
  std::vector<HandleSuggestion> suggestions;
  Warnings warnings;
};

using AutoRigger = AutoRig (*)(const TriMesh& mesh, const RigOptions& options, Progress& progress);

struct RiggerMethod {
  std::string_view name;     // "sphere-mesh"
  std::string_view summary;  // one line for --help
  std::string_view paper;
  AutoRigger rig;
};

std::span<const RiggerMethod> riggerMethods();
// Throws Error kBadArgument that lists the names there are.
const RiggerMethod& findRigger(std::string_view name);

}  // namespace limber
