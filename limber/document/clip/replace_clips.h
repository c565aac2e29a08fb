// Other clips for a model, with what else moves in them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/document/clip/trim_animation.h"
#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// Takes all movement of the skeleton's joints out, with the bytes that nothing else uses, and adds these clips
// (addClips), whose names it returns. Weights of blend shapes, and other nodes' movements, stay: in the clip of the
// same name where there is one, else as they are. `cut` is the span that the clips were cut to, if they were: what
// stays in them is cut likewise (trimAnimation). Errors of addClips.
std::vector<std::string> replaceClips(Asset& asset, const AssetSkeleton& skeleton, std::span<const Clip> clips,
                                      const std::optional<TimeSpan>& cut = std::nullopt);

}  // namespace limber
