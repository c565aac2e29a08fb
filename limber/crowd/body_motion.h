// A build of a crowd with its clips, as nodes and keys of a document of its own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

struct BodyBuild;
struct CrowdOptions;
struct Motion;
class SkeletonMatches;

struct BodyClip {
  Clip clip;                  // over the build's skeleton
  Index cycle = 0;            // frames until it is repeated
  Vec3 start = Vec3::Zero();  // the point of the ground below the middle of the body as it begins, metres
};

struct BodyMotion {
  Index character = 0;     // by its number
  Asset still;             // the build without clips
  Asset moving;            // with an animation for each clip, once lengthened
  AssetSkeleton skeleton;  // of `moving`
  double width = 0;        // at rest, metres
  std::vector<BodyClip> clips;
};

// Of one build: retargets all motions. Throws as retargetOnto does, with the character's name.
BodyMotion moveBuild(const Asset& character, const BodyBuild& build, std::span<const Motion> motions,
                     const CrowdOptions& options, SkeletonMatches& matches);

// Writes the clips into `moving`, repeated to `frames` and one cycle more: a key at each frame of tracks that change,
// one key of constant tracks.
void lengthenClips(BodyMotion& body, Index frames, double framesPerSecond);

}  // namespace limber
