// BVH motion files (Biovision hierarchy).
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "limber/core/file/file.h"
#include "limber/document/up_axis.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct BvhOptions {
  // A BVH does not say its unit: lengths are taken as metres unless told. Often it is the centimetre, and in the CMU
  // recordings 1 / 0.45 inch (0.056444 m).
  double metresPerUnit = 1;
  // Of the frames. None: Y or Z is inferred. Expected is Z where in the rest pose the joints named "head" lie above
  // those named "foot", "toe" or "ankle" along Z, and hardly along Y, else Y; the frames overrule that (upOfFrames).
  std::optional<UpAxis> up;
  // Of the rest pose. None: Y where the rest pose is clearly upright along Y; else that of the frames or, where they
  // are inferred to be Y, the expected one.
  std::optional<UpAxis> restUp = std::nullopt;
};

// A motion with one clip (none where the file has no frame), named after the file.
//
// Joints come in the file's order with its names; the end site of a joint "Hand" is a joint "Hand_end". The rest pose
// is that of the offsets, without rotations. Rotations are multiplied in the order of the channels, whatever it is
// (also fewer or more than three); a joint may have positions and scales too, in any order. A root's positions replace
// its offset. Those of other joints do, too, unless over the whole file they would clearly stay nearer to their offsets
// if they were added to them (programs differ; warning "relative-positions").
//
// Accepted: any blanks and line ends, decimal commas, several roots, rotations that are constant (one key). Warnings:
// "converted-axes", "maybe-z-up" and "maybe-y-up" (a body that lies all the time, or is upright along another axis),
// "upside-down" (the head is below the feet in all frames), "frame-count" (more or fewer frames than announced),
// "cut-frame" (the last row is incomplete and left out), "bad-numbers" (not finite, or too large: replaced by the
// previous frame), "frame-time" (not positive: 1/30 s), "no-motion", "duplicate-names", "decimal-commas",
// "trailing-text".
//
// Throws Error kBadData with file and line ("walk.bvh: line 187") for everything else, kLimit beyond 2^22 frames,
// kBadArgument for a unit that is not positive. Time is linear in the file; memory that of the result and one line.
Motion readBvh(const std::filesystem::path& path, const BvhOptions& options = {});
Motion readBvh(ByteSpan bytes, std::string_view name, const BvhOptions& options = {});

// Does it begin as a BVH does?
bool looksLikeBvh(ByteSpan bytes);

}  // namespace limber
