#include "limber/samples/model_recipe.h"

namespace limber {

SymmetricMesh buildCharacter(const ModelRecipe& character) {
  Sculpture shape = character.shape;
  shape.prepare();
  HalfMesh half = polygonize(shape, character.cube);
  remesh(half, shape, character.edge, character.details);
  for (const ModelRecipe::Paint& layer : character.paints) paint(half, shape, layer.region, layer.material);
  return mirrorHalf(half, shape);
}

}  // namespace limber
