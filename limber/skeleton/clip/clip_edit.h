// Clips cut, sampled anew and made to loop. Clips that go in have passed checkClip for the skeleton.
#pragma once

#include "limber/skeleton/clip/clip.h"

namespace limber {

// The same movement with keys at 0, 1/rate, 2/rate, ... and at the clip's duration, linear between. A track of one
// key stays one. Throws Error kBadArgument, kLimit as frameCount does.
Clip resampleClip(const Clip& clip, double framesPerSecond);

// What lies between two moments (seconds, cut to the clip's own span), starting at 0. Keys inside stay as they are;
// where a cut falls between keys there is one with the value of that moment. Cubic tracks keep their curve; of cubic
// rotations only if the cuts are keys, else they become linear with 120 keys a second. Throws Error kBadArgument
// unless from < to and something of the clip lies between.
Clip trimClip(const Clip& clip, double from, double to);

// The same of one track, between any two times, 0 <= from < to: outside its keys it is constant.
Track<Vec3f> trimTrack(const Track<Vec3f>& track, double from, double to);
Track<Eigen::Quaternionf> trimTrack(const Track<Eigen::Quaternionf>& track, double from, double to);

// The whole movement turned about the origin: its roots, also those without a track. No turn changes nothing.
Clip turnClip(Clip clip, const Skeleton& skeleton, const Quat& turn);

// A pose between two: translations and scales linearly, rotations along the shortest path. weight 0 is a, 1 is b.
// Equal sizes.
Pose blendPoses(const Pose& a, const Pose& b, double weight);

// A stretch of a clip that can be repeated.
struct ClipLoop {
  double begin = 0, end = 0;  // seconds: the pose at `end` is nearly that at `begin`
  double error = 0;           // how far from it: root mean square of joint distances over the skeleton's size
};

struct LoopOptions {
  double framesPerSecond = 30;  // at which poses are compared; fewer where the clip has more than 1500 such frames
  double largestError = 0.03;   // of the skeleton's size
  Index body = 0;               // the joint whose travel does not count; joints above it do not count either
};

// The loop with the least error per second of its length, comparing joints relative to the body (its height counts, its
// position and heading do not) at this and the next frame, so that speeds match too; nullopt where none is good enough
// or nothing moves. Cost: O(frames^2 * joints).
std::optional<ClipLoop> findLoop(const Skeleton& skeleton, const Clip& clip, const LoopOptions& options = {});

}  // namespace limber
