// The parts of checkAsset.
#pragma once

#include "limber/document/asset.h"

namespace limber {

inline constexpr double kMinSquaredRotation = 1e-12;  // of a node: a shorter quaternion is no rotation

// Every buffer view, every accessor, and the accessors that meshes and skins use: types, counts, values.
void checkData(const Asset& asset);

}  // namespace limber
