// What moves over time, as keys between which readers go straight.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// Keys of three curves at the same times: seconds, and values as FBX has them.
struct FbxKeys {
  std::vector<double> times;
  std::vector<Vec3> values;
  bool isStepped = false;  // values hold until the next key
};

inline constexpr double kFbxAngleTolerance = 0.005;  // degrees
inline constexpr double kFbxTolerance = 1e-4;        // of what a curve spans

// The keys of a track, and between them, by halves down to a 256th, what is needed for a straight line to stay within
// kFbxTolerance of what the track says (cubic tracks alone need it).
FbxKeys fbxKeys(const Track<Vec3f>& track);

// The same as Euler angles in degrees, which do not jump from key to key and stay within kFbxAngleTolerance of the
// rotation that the track says; no angle changes by more than 90 degrees between two keys, but at steps. `turn` is
// applied from the left.
FbxKeys fbxKeys(const Track<Eigen::Quaternionf>& track, const Quat& turn);

}  // namespace limber
