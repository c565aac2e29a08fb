// Feet planted over a whole motion by least squares, part by part: of the method "spacetime" and of mixed motions.
#pragma once

#include <functional>
#include <vector>

#include "limber/motion/retarget/moved_legs.h"

namespace limber {

namespace planting {
// By the judge on half of the shared motions. Seconds; 0.03 to 0.15; in which changes come and go: of the pelvis and of
// legs' bones, of feet's twists.
inline constexpr double kChangeSeconds = 0.06, kTwistSeconds = 0.05;
// Weight of a planted foot's squared rotation from frame to frame, radians; 1e6 to 1e10, far above that of jerk.
inline constexpr double kTwistHold = 1e8;
inline constexpr double kStretched = 0.995;  // leg lengths; 0.98 to kMaxStretch; a leg's reach: straight knees tremble
}  // namespace planting

struct FootPlanting {
  std::size_t begin = 0, end = 0;  // frames; no others change
  double frameSeconds = 0;
  double changeSeconds = planting::kChangeSeconds;
  MotionEnds ends = {};    // of these frames
  std::vector<bool> cuts;  // of these frames
  // The target's globals in a frame that has no changes yet, valid until the next call.
  std::function<const BodyFrame&(std::size_t frame)> frameAt;
  // What has to hold for a leg's foot. `now`: the frame without changes.
  std::function<FootFrame(std::size_t frame, std::size_t leg, const BodyFrame& now)> askedOf;
  // Makes the changes of a frame: those that `moved` and `layout` have at `index`.
  std::function<void(MovedLegs& moved, const ChangeLayout& layout, const Changes& changes, std::size_t index,
                     std::size_t frame)>
      change;
};

// Each part is seen with half a second of the next. `legs` of no frames. Linear in the frames, about 20 us for each.
void plantFeet(const MovedLegs& legs, const FootPlanting& planting);

}  // namespace limber
