// Poses as keys of a clip: set, moved, taken out, and what lies between them.
#pragma once

#include "limber/skeleton/clip.h"

namespace limber {

// Keys closer together than this many seconds are one.
inline constexpr double kKeySnap = 5e-4;

// When the clip has keys, over all its tracks: ascending, each once.
std::vector<double> keyTimes(const Clip& clip);

// How the clip's first track runs between its keys; linear for a clip without tracks.
Interpolation interpolationOf(const Clip& clip);

// The functions below give every track that they change and that is cubic the tangents of a Catmull-Rom spline, at rest
// in its first and last key. The clip has passed checkClip for `skeleton`, and passes it afterwards. Seconds are finite
// and not negative, else Error kBadArgument; the same where there is no key to move or to take out.

// All of `pose` at that moment, in place of a key that is there. A joint that stands as in rest pose and has no track
// gets none, but for the turns of roots, so that the key is there; one that gets its first track rests at the keys that
// the clip has already.
void setKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds);

// Likewise in a clip that has keys for every frame, such as a recorded motion: what `pose` changes at that moment goes
// into the keys up to `span` seconds before and after it, too, ever less the further away they are (smoothstep), so that
// nothing jumps. Cost: setKey for each of these keys. Throws Error kBadArgument where the span is negative or no number.
void blendKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds, double span);

// Takes the place of a key that is at `to` already.
void moveKey(Clip& clip, double from, double to);
void deleteKey(Clip& clip, double seconds);

void setInterpolation(Clip& clip, Interpolation interpolation);

}  // namespace limber
