// Which axis of a BVH points up: in its rest pose, and in its frames, which may differ.
#pragma once

#include <array>
#include <span>
#include <string>

#include "limber/document/bvh/bvh_ends.h"
#include "limber/document/up_axis.h"
#include "limber/skeleton/motion.h"

namespace limber {

// Heads lie above feet along that axis in the rest pose, clearly, and on the other side of the joint that carries both:
// in a rest pose that has all bones along one axis they do not.
bool restsAlong(UpAxis up, std::span<const BvhJoint> joints, const BvhEnds& ends);

// Heads lie above feet along Z, by the joints' names.
bool isUprightAlongZ(std::span<const BvhJoint> joints);

// Heads lie before the feet (+Z) more than above them in the rest pose, and upright along neither axis, as those of
// beasts do: that they do in frames, too, says nothing of what is up.
bool headsLieAhead(std::span<const BvhJoint> joints, const BvhEnds& ends);

// Along which axes heads lie from feet, to within 45 degrees or so, over the frames of a motion.
class HeadDirections {
 public:
  // Of a frame, from the feet to the head.
  void add(const Vec3& upwards);
  // Of the frames, in [0, 1]; 0 without any.
  double fractionAlong(UpAxis axis) const;
  // The head is below the feet in all frames, or nearly.
  bool isUpsideDown(UpAxis up) const;

 private:
  std::size_t frames_ = 0;
  std::array<std::size_t, 4> along_ = {};  // frames, by UpAxis
};

// How a body is in a motion's frames, in the file's own axes.
struct FramePostures {
  std::size_t frames = 0;  // that were looked at
  HeadDirections heads;
  Vec3 upwards = Vec3::Zero();          // mean of the unit vectors from feet to head
  double size = 0;                      // greatest distance from feet to head
  Vec3 lowest = Vec3::Zero();           // along each axis, of all joints and frames
  Vec3 lowestDeviation = Vec3::Zero();  // standard deviation of the frames' lowest
};
// At most some two thousand frames, evenly spread. Nothing (no frames) without clip or ends.
FramePostures framePostures(const Motion& motion, const BvhEnds& ends);

// Which of Y and Z is up in the frames. `expected` unless heads lie above feet along the other axis by more than along
// that, as in the reader of .npz, in most frames; and then by where the body touches the ground: who walks on it keeps
// the lowest point at one height and moves across it, while who lies, crawls or swims moves along the other axis.
// Where neither is the case the expected axis stays, and the frames are ambiguous unless some of them stand along it.
struct FramesUp {
  UpAxis axis = UpAxis::kY;
  bool ambiguous = false;
};
FramesUp upOfFrames(const FramePostures& postures, UpAxis expected);

// What the warnings "upside-down" and "converted-axes" say of a file that was read with that axis up.
std::string upsideDownMessage(UpAxis up);
std::string convertedAxesMessage(UpAxis up);

}  // namespace limber
