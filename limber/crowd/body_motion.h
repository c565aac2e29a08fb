// A build of a crowd with its clips, as nodes and keys of a document of its own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/asset/asset.h"
#include "limber/skeleton/clip.h"

namespace limber {

struct BodyBuild;
struct CrowdOptions;
struct Motion;
class SkeletonMatches;

struct BodyMotion {
  Asset still;                // the build without clips
  Asset moving;               // with an animation for each clip, once lengthened
  std::vector<Clip> clips;    // over its skeleton
  std::vector<Index> cycles;  // #clips, frames until a clip is repeated
};

// Of one build: retargets all motions. Throws as retargetOnto does, with the character's name.
BodyMotion moveBuild(const Asset& character, const BodyBuild& build, std::span<const Motion> motions,
                     const CrowdOptions& options, SkeletonMatches& matches);

// Writes the clips into `moving`, repeated to `frames` and one cycle more: a key at each frame of what moves, one of
// what stands.
void lengthenClips(BodyMotion& body, Index frames, double framesPerSecond);

}  // namespace limber
