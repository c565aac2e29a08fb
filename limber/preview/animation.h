// A clip in pictures.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "limber/core/progress.h"
#include "limber/preview/render.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// `count` moments from the clip's start to its end, evenly: both ends for a sheet; for a loop without the end.
std::vector<double> clipMoments(double duration, int count, bool withEnd);

// One picture for each moment, all in one frame that holds the whole movement. Gets the first scene's warnings. The
// scene is made twice for each moment, so that one alone is in memory.
std::vector<Image> renderClip(const SceneMaker& scenes, const Clip& clip, std::span<const double> seconds,
                              PreviewOptions options, Progress& progress, Warnings& warnings);

// So many pictures from all around, the first as the options have it, all in one frame; the last is followed by the
// first.
std::vector<Image> renderTurn(const Scene& scene, PreviewOptions options, int count, Progress& progress);

}  // namespace limber
