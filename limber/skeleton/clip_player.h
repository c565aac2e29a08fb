// A clip packed for playing: straight to the joints' global matrices, in single precision.
#pragma once

#include <memory>
#include <span>

#include "limber/skeleton/clip.h"

namespace limber {

// What sampleClip and globalTransforms do together, for frame after frame, to within 5e-5 of their result (rotations
// between keys more than a twentieth of a radian apart are cut into shorter turns). About 10 ns for each joint between
// keys; four joints, of which one meets a key, take about a microsecond more. Times in any order are right. Not for
// several threads at once.
class ClipPlayer {
 public:
  // Parts without a track are those of the rest pose. Throws as checkClip does.
  ClipPlayer(const Clip& clip, const Skeleton& skeleton);
  ~ClipPlayer();
  ClipPlayer(ClipPlayer&&) noexcept;
  ClipPlayer& operator=(ClipPlayer&&) noexcept;

  // #J matrices from joint space to the skeleton's. Allocates nothing. Throws Error kBadArgument for another size.
  void sample(double seconds, std::span<Eigen::Matrix4f> globals);

 private:
  struct Packed;
  std::unique_ptr<Packed> packed_;
};

}  // namespace limber
