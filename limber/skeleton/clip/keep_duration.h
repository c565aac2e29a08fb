// Clips that stand still for a time.
#pragma once

#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

// Where constant tracks were cut to one key so that nothing of a clip lasts until the last of these times (increasing,
// seconds), its first track gets keys at all of them: a still pose keeps its length and its frames. A clip without a
// track remains without one.
void keepDuration(Clip& clip, const std::vector<float>& times);

}  // namespace limber
