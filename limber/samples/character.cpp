#include "limber/samples/character.h"

namespace limber {

SymmetricMesh buildCharacter(const Character& character) {
  HalfMesh half = polygonize(character.shape, character.cube);
  remesh(half, character.shape, character.edge, character.details);
  for (const Character::Paint& layer : character.paints) {
    paint(half, character.shape, layer.region, layer.material);
  }
  return mirrorHalf(half, character.shape);
}

}  // namespace limber
