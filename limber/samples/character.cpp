#include "limber/samples/character.h"

namespace limber {

SymmetricMesh buildCharacter(const Character& character) {
  Sculpture shape = character.shape;
  shape.prepare();
  HalfMesh half = polygonize(shape, character.cube);
  remesh(half, shape, character.edge, character.details);
  for (const Character::Paint& layer : character.paints) paint(half, shape, layer.region, layer.material);
  return mirrorHalf(half, shape);
}

}  // namespace limber
