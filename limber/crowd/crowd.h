// Many bodies of differing builds in one document, each with its own clip, time offset and position.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/actions/motion/clip_edits.h"
#include "limber/actions/motion/retarget_asset.h"
#include "limber/core/progress.h"
#include "limber/crowd/body_build.h"

namespace limber {

struct CrowdOptions {
  Index bodies = 100;             // at least 1
  Index builds = 8;               // differing ones; at least one of each character, at most one for each body
  Index offsets = 8;              // moments of its cycle at which a body may begin, evenly over it; at least 1
  double variety = 1;             // 0: as the characters are, to 1: as adults differ (randomBuild)
  std::uint64_t seed = 1;         // of builds, clips, offsets, positions
  double framesPerSecond = 30;    // of the keys, above 0
  std::optional<double> spacing;  // metres from body to body; none: 1.25 times the widest of them
  double heading = 0;             // degrees by which a body may face aside of the others, to either side
  RetargetAssetOptions retarget;  // `frameRate`, `matches` and `turn` are set here
  ClipEdits edits;                // loops and travel; rate and tolerance are the crowd's own
};

struct CrowdBody {
  Index build = 0, clip = 0;
  double offset = 0;             // seconds of its clip at which it begins
  Vec3 position = Vec3::Zero();  // of its build's origin, metres
  double heading = 0;            // degrees about +Y
};

struct Crowd {
  Asset asset;
  std::vector<CrowdBody> bodies;   // each a node "body_1", ... with the above as extras ("limber_crowd")
  std::vector<Asset> builds;       // that bodies have, without clips
  std::vector<std::string> clips;  // that bodies have, by their names
  double seconds = 0;              // of the one animation, "crowd"
};

// The crowd. A body's clip begins at its offset and is repeated until the longest of all has gone round once; in the
// last frame before it is repeated it goes over to its first frame, so clips should be loops (ClipEdits::loop), and
// those that travel start anew from their position.
//
// Bodies are in rows on the ground, y = 0: the first frame of each clip has the body's middle over its position there,
// and its lowest point in rest pose is at the ground's height, wherever characters and motions have their origins.
//
// Each character, build and clip comes once before one of them comes twice, in orders by chance. Where there are fewer
// bodies than characters or clips, some have none: warnings "characters-left-out" and "clips-left-out".
//
// What the file holds: geometry and inverse binds once a build, and of these what differs alone (indices, texture
// coordinates, weights and pictures are one for all builds of a character); nodes, a skin and channels for each body;
// keys once a build and clip, over as many frames as the animation and one cycle have, of which every offset shows a
// window, and samplers once a build, clip and offset. The first n bodies have the builds, clips and offsets that they
// have in a larger crowd.
//
// Cost: builds times motions retargetings, on all threads; then linear in bodies times joints. Throws as retargetOnto
// does, with the character's name, kBadArgument for options out of their ranges, kUnsupported for a skeleton alone,
// kLimit where bodies times nodes are more than 10 million.
Crowd makeCrowd(std::span<const Asset> characters, std::span<const Motion> motions, const CrowdOptions& options,
                Progress& progress);

}  // namespace limber
