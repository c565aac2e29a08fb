// Poses as keys of a clip: set, moved, taken out, and what lies between them.
#pragma once

#include <optional>
#include <span>

#include "limber/skeleton/clip/clip.h"

namespace limber {

// Keys closer together than this many seconds are one.
inline constexpr double kKeySnap = 5e-4;

// Ascending, those that are one only once.
std::vector<double> eachOnce(std::vector<double> times);

// When the clip has keys, over all its tracks: ascending, each once.
std::vector<double> keyTimes(const Clip& clip);

// How the clip's first track runs between its keys; linear for a clip without tracks.
Interpolation interpolationOf(const Clip& clip);

// The functions below give every track that they change and that is cubic the tangents of a Catmull-Rom spline, at rest
// in its first and last key; a key whose tangents are others, set by hand or by a file, keeps them. The clip has passed
// checkClip for `skeleton`, and passes it afterwards. Seconds are finite
// and not negative, else Error kBadArgument.

// All of `pose` at that time, replacing a key that is there. A joint in its rest pose without a track gets none, except
// for the rotations of roots, so that the key exists; one that gets its first track is in rest pose at the keys that
// the clip has already.
void setKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds);

// The same for one joint alone.
void setJointKey(Clip& clip, const Skeleton& skeleton, Index joint, const Transform& local, double seconds);

// The clip of linear keys that setKey makes of these poses one by one, but in linear time: at `seconds` (#poses), which
// rise. Neighbouring rotations lie on one side of the sphere.
Clip clipOfKeys(const Skeleton& skeleton, std::span<const Pose> poses, std::span<const double> seconds);

void setInterpolation(Clip& clip, Interpolation interpolation);

// How a cubic track runs through a key: as the spline through its neighbours, level, or otherwise.
enum class KeyTangents { kAuto, kFlat, kFree };

// A key of one joint: of its translation, rotation and scale alike, as far as it has them at that moment.
struct JointKey {
  Index joint = 0;
  double seconds = 0;
};

struct JointKeyTimes {
  Index joint = 0;
  std::vector<double> seconds;  // ascending, each once
};

// What a joint's cubic tracks change by in a second at a key, as they leave it. A track that is not there changes
// nothing.
struct KeySlope {
  KeyTangents tangents = KeyTangents::kAuto;
  Vec3 translation = Vec3::Zero();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();  // x, y, z, w of the joint's local rotation
};
// Nothing where no cubic track of the joint has a key there.
std::optional<KeySlope> slopeAt(const Clip& clip, const JointKey& key);
// From then on the key's tangents are those, in and out alike; with kAuto and kFlat the slopes are what these say.
// `rotation` is that of the key, of either sign. Throws Error kBadArgument where slopeAt gives nothing.
void setSlope(Clip& clip, const JointKey& key, const KeySlope& slope, const Quat& rotation);

// Of the joints that have tracks, by joint.
std::vector<JointKeyTimes> keyTimesOfJoints(const Clip& clip);

// To pivot + scale * (seconds - pivot) + shift.
struct KeyRetiming {
  double shift = 0;   // seconds
  double scale = 1;   // above 0
  double pivot = 0;   // seconds
  bool copy = false;  // the keys stay where they were, too

  double at(double seconds) const { return pivot + scale * (seconds - pivot) + shift; }
};

// Keys that arrive replace those that are there. Both throw Error kBadArgument, and change nothing, where one of `keys`
// is not there; retimeKeys also where the scale is not above 0 or a key would come before 0.
void retimeKeys(Clip& clip, std::span<const JointKey> keys, const KeyRetiming& retiming);
void deleteKeys(Clip& clip, std::span<const JointKey> keys);

// What these checks are made of, for other things that have keys.
bool isChosen(std::span<const JointKey> keys, Index joint, double seconds);
void requireKeys(const std::vector<JointKeyTimes>& there, std::span<const JointKey> keys);
void checkRetiming(std::span<const JointKey> keys, const KeyRetiming& retiming);

}  // namespace limber
