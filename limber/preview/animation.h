// A clip in pictures.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "limber/preview/render.h"
#include "limber/skeleton/clip.h"

namespace limber {

class Asset;

// The clip of that name; the first where none is named, and where the document has none an empty one (the rest pose).
// Over the animatedSkeleton of the asset. Throws Error kBadArgument that lists the names.
Clip findClip(const Asset& asset, std::string_view name);

// `count` moments from the clip's start to its end, evenly: both ends for a sheet; for a loop without the end.
std::vector<double> clipMoments(const Clip& clip, int count, bool withEnd);

// One picture for each moment, all in one frame that holds the whole movement. Gets the first scene's warnings.
std::vector<Image> renderClip(const Asset& asset, const Clip& clip, std::span<const double> seconds,
                              PreviewOptions options, Warnings& warnings);

}  // namespace limber
