// The weights of blend shapes over time.
#pragma once

#include <optional>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/skeleton/clip.h"

namespace limber {

// One track for each of the `count` blend shapes of the mesh that a node shows, in seconds: what the animation `clip`
// of the document does to them, else one key at 0 of how the node (or its mesh) has them. Cubic tracks have three
// values a key, as Track says.
std::vector<Track<float>> shapeTracks(const Asset& asset, Index node, std::size_t count, std::optional<Index> clip);

}  // namespace limber
