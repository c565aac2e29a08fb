// How high people's feet go near the ground: as the source's. Joint angles on legs of other proportions bring a foot
// down at another moment, or not wholly; a foot that is drawn to the ground only once it stands would snap there.
#pragma once

#include <span>

namespace limber {

// A point of a foot: how high it is over where it is when standing, in hip heights of its own skeleton.
struct SolePoint {
  double source = 0, target = 0;
};

// 0 far from the ground, 1 on it, by the source's heights; without a kink.
double nearGround(std::span<const SolePoint> points);
// How far the foot has to rise for the points that are near the ground to be as high as the source's: hip heights.
double riseNearGround(std::span<const SolePoint> points);
// How high a planted point is held over the ground. What trembles or is planted a little too high stands on it; feet
// that come up while they count as planted are lifted.
double heldHeight(double sourceHeight);

}  // namespace limber
