// A correction on top of a clip: sparse keys of single joints, as offsets from what the clip says. The clip below can
// be another one, and the correction stays.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/clip/clip.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

// In the joint's own frame as the clip below has it: translation + offset, rotation * offset. Scales are left alone.
struct LayerKey {
  double seconds = 0;
  double span = 0;  // seconds over which the offset comes before the key and goes after it
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
};

struct LayerTrack {
  Index joint = 0;
  std::vector<LayerKey> keys;  // at least one, in time
};

// Between two keys whose spans meet, the offset goes smoothly (3u^2 - 2u^3) from one to the other; a key that is
// further from its neighbour, and the first and the last, fade in and out over their spans.
struct ClipLayer {
  std::vector<LayerTrack> tracks;  // one for each corrected joint, by joint

  bool empty() const { return tracks.empty(); }
};

// The clip with the layer: tracks of corrected joints get keys wherever the offset changes (at the clip's own keys,
// at the layer's, and at least kLayerRate a second), all others are the clip's, bit for bit. Both are of `skeleton`.
inline constexpr double kLayerRate = 30;
Clip applyLayer(const Clip& clip, const ClipLayer& layer, const Skeleton& skeleton);

// The pose becomes the one that is shown at that time: a key for each joint whose pose differs from `shown`. Where none
// differs, each joint of the layer gets a key that keeps it there. `base` and `shown` are the clip's pose then, without
// and with the layer. Throws Error kBadArgument where the poses differ in size, or seconds or span are negative or not
// a number.
void setKey(ClipLayer& layer, const Pose& base, const Pose& shown, const Pose& pose, double seconds, double span);

// As those of keyframes.h.
std::vector<double> keyTimes(const ClipLayer& layer);
std::vector<JointKeyTimes> keyTimesOfJoints(const ClipLayer& layer);
void retimeKeys(ClipLayer& layer, std::span<const JointKey> keys, const KeyRetiming& retiming);
void deleteKeys(ClipLayer& layer, std::span<const JointKey> keys);

}  // namespace limber
