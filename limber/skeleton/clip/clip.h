// Motion: values over time for some of a skeleton's joints.
#pragma once

#include <string>
#include <vector>

#include "limber/skeleton/pose.h"

namespace limber {

// glTF's three. Linear rotations turn at constant speed along the shortest path (slerp). Cubic: Hermite splines, three
// values for each key: in-tangent, value, out-tangent, tangents per second.
enum class Interpolation { kStep, kLinear, kCubic };

// times   #K seconds, strictly increasing, at least one key; before the first and after the last the value stays
// values  #K (kCubic: 3 * #K); a rotation's values are unit quaternions (kCubic: the tangents are any)
template <typename Value>
struct Track {
  Index joint = 0;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times;
  std::vector<Value> values;
};

// Values are local to the joint's parent and replace those of the rest pose. Joints without a track stay as they are.
struct Clip {
  std::string name;
  std::vector<Track<Vec3f>> translations;
  std::vector<Track<Eigen::Quaternionf>> rotations;
  std::vector<Track<Vec3f>> scales;

  double duration() const;  // seconds, the last key's time; 0 without keys
};

// Throws Error kBadData naming the track: joint not in the skeleton or with two tracks of one kind, no key, counts that
// do not match, times not increasing, values not finite, rotations not of unit length (within 1e-3).
void checkClip(const Clip& clip, const Skeleton& skeleton);

// One track's value at a time. The track has passed checkClip.
Vec3 sampleTrack(const Track<Vec3f>& track, double seconds);
Quat sampleTrack(const Track<Eigen::Quaternionf>& track, double seconds);

// Writes what the clip says at `seconds` into `pose`; joints and parts without a track are left alone. The clip has
// passed checkClip for the skeleton of that pose. Cost: a binary search for each track.
void sampleClip(const Clip& clip, double seconds, Pose& pose);

}  // namespace limber
