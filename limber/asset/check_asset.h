// The parts of checkAsset.
#pragma once

#include "limber/asset/asset.h"

namespace limber {

// Every buffer view, every accessor, and the accessors that meshes and skins use: types, counts, values.
void checkData(const Asset& asset);

}  // namespace limber
