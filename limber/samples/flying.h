// The winged creature as somebody else would deliver it: with a rig of its own, and flying.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Bound as wingedCharacter() stands; one clip, "fly", of one beat of the wings, its last frame posed as the first.
Asset makeFlying();

}  // namespace limber
