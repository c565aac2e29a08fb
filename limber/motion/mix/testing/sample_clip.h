// The project's own motions as what is mixed: on their own skeleton, with known gaits
// (limber/samples/motions/gait.cpp).
#pragma once

#include "limber/motion/mix/mix_motion.h"
#include "limber/samples/motions/sample_motions.h"

namespace limber::testing {

inline ClipWithContacts sampleClip(std::string_view name) {
  return {makeSampleMotion(name).clips.front(), {}};
}

inline Skeleton sampleSkeleton() {
  return makeSampleMotion("walk").skeleton;
}

// Of every joint, in each frame.
inline std::vector<std::vector<Vec3>> jointPaths(const Skeleton& skeleton, const Clip& clip, double rate = 60) {
  std::vector<std::vector<Vec3>> frames;
  for (const Pose& pose : sampleFrames(skeleton, clip, rate).poses) frames.push_back(posePositions(skeleton, pose));
  return frames;
}

inline Clip slowed(Clip clip, float factor) {
  const auto slow = [&](auto& tracks) {
    for (auto& track : tracks) {
      for (float& time : track.times) time *= factor;
    }
  };
  slow(clip.translations);
  slow(clip.rotations);
  return clip;
}

// Of a point that is still by its height and speed over a twentieth of a second, how fast it goes along the ground,
// metres a second on average: of the toes, without any of limber's detectors.
inline double toesSlide(const Skeleton& skeleton, const Clip& clip, double rate = 60) {
  const auto frames = jointPaths(skeleton, clip, rate);
  double pathLength = 0, seconds = 0;
  for (const char* name : {"leftToes", "rightToes"}) {
    const Index toes = skeleton.find(name).value();
    double lowest = frames[0][toes].y();
    for (const auto& frame : frames) lowest = std::min(lowest, frame[toes].y());
    for (std::size_t f = 3; f < frames.size(); ++f) {
      const Vec3 over = frames[f][toes] - frames[f - 3][toes];
      if (frames[f][toes].y() > lowest + 0.02 || over.norm() > 0.02) continue;
      const Vec3 step = frames[f][toes] - frames[f - 1][toes];
      pathLength += std::hypot(step.x(), step.z());
      seconds += 1 / rate;
    }
  }
  return seconds > 0 ? pathLength / seconds : 0;
}

// Root mean square third difference of all joints, metres a second cubed.
inline double jerkOf(const Skeleton& skeleton, const Clip& clip, double rate = 60) {
  const auto frames = jointPaths(skeleton, clip, rate);
  double sum = 0, count = 0;
  for (std::size_t f = 3; f < frames.size(); ++f) {
    for (std::size_t j = 0; j < frames[f].size(); ++j, ++count) {
      sum += (frames[f][j] - frames[f - 3][j] - 3 * (frames[f - 1][j] - frames[f - 2][j])).squaredNorm();
    }
  }
  return std::sqrt(sum / count) * rate * rate * rate;
}

}  // namespace limber::testing
