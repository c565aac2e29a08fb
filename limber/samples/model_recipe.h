// Models as recipes: a sculpture, where it is fine, and what is painted on it.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "limber/samples/half_mesh.h"

namespace limber {

struct SampleMaterial {
  std::string_view name;
  std::array<int, 3> srgb = {200, 200, 200};
  double roughness = 0.7, metallic = 0;
};

struct ModelRecipe {
  struct Paint {
    Solid region;
    int material = 0;  // index into materials; what nothing is painted on has material 0
  };
  std::string_view name;
  Sculpture shape;
  double cube = 0.010;  // metres, of the grid that finds the surface: at most half of the thinnest part
  double edge = 0.015;  // metres, the length of edges where nothing asks for finer ones
  std::vector<DetailRegion> details;
  std::vector<Paint> paints;  // later ones lie over earlier ones
  std::vector<SampleMaterial> materials;
};

// Metres, feet on y = 0, facing +Z.
ModelRecipe bipedCharacter();
ModelRecipe quadrupedCharacter();
ModelRecipe wingedCharacter();
ModelRecipe theropodCharacter();
ModelRecipe stoolCharacter();
ModelRecipe footstoolCharacter();

SymmetricMesh buildCharacter(const ModelRecipe& character);

}  // namespace limber
