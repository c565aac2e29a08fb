// Which keys of a densely sampled track suffice.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// The frames to keep, ascending, the first and the last among them: what is interpolated between the values there is
// nowhere farther than `tolerance` from the value of any frame. Greedy: each key is followed by the farthest frame
// found by doubling and halving that a line reaches; the fewest keys where shorter lines are never worse.
//
// times   #F seconds, strictly increasing, at least one
// values  #F; rotations of unit length, neighbours on one side (their dot product at least 0); tolerance in radians
// Cost: O(F log F) interpolations where lines are short.
std::vector<Index> chooseKeys(std::span<const double> times, std::span<const Quat> values, double tolerance);
std::vector<Index> chooseKeys(std::span<const double> times, std::span<const Vec3> values, double tolerance);

// The values for these keys that bring what is between them nearest to all frames, by least squares (one step from the
// frames' own values; the matrix has three diagonals); the first and the last keep theirs, and so does a key between
// which and its neighbours no frame is. Cost: O(F).
std::vector<Quat> fitKeys(std::span<const double> times, std::span<const Quat> values, std::span<const Index> kept);
std::vector<Vec3> fitKeys(std::span<const double> times, std::span<const Vec3> values, std::span<const Index> kept);

}  // namespace limber
