// Triangles and materials to a glTF document in memory.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "limber/core/transform.h"
#include "limber/document/asset.h"
#include "limber/samples/model_recipe.h"

namespace limber {

class ModelBuilder {
 public:
  explicit ModelBuilder(std::string_view name);

  // Each returns the index of what it added.
  Index addMaterial(const SampleMaterial& material);
  // One primitive for each material, with the vertices that it uses; `materials` maps the numbers in mesh.materials.
  Index addMesh(std::string_view name, const SymmetricMesh& mesh, std::span<const Index> materials);
  Index addNode(std::string_view name, std::optional<Index> mesh, const Transform& placed = {},
                std::optional<Index> parent = {});

  Asset take();

 private:
  Asset asset_;
};

// The character as a document of one mesh.
Asset modelOf(const ModelRecipe& character);

}  // namespace limber
