// The weights of blend shapes over time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "limber/document/asset.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// One track for each of the `count` blend shapes of the mesh that a node shows, in seconds: what the animation `clip`
// of the document does to them, else one key at 0 of how the node (or its mesh) has them. Cubic tracks have three
// values a key, as Track says. Of several channels for the node the last one that is whole counts.
std::vector<Track<float>> shapeTracks(const Asset& asset, Index node, std::size_t count, std::optional<Index> clip);

// How many numbers those tracks take from the animation's keys, found without reading them; 0 where it has no channel
// for the node.
std::uint64_t shapeTrackSize(const Asset& asset, Index node, std::size_t count, Index clip);

}  // namespace limber
