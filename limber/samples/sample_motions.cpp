#include "limber/samples/sample_motions.h"

#include <array>
#include <cmath>
#include <string>

#include "limber/core/names.h"
#include "limber/samples/motion_recipes.h"

namespace limber {

namespace {

template <Stance (*at)(double seconds)>
Pose figureAt(const Skeleton& figure, double seconds) {
  return poseOf(figure, at(seconds));
}

constexpr std::array<SampleMotion, 3> kMotions = {{
    {"walk", "a person who walks", 1.1, &figureSkeleton, &figureAt<walkAt>},
    {"jumping-jack", "a person who does jumping jacks", 1.2, &figureSkeleton, &figureAt<jumpingJackAt>},
    {"quadruped-walk", "an animal of --template quadruped that walks", 0.9, &quadrupedSkeleton, &quadrupedWalkAt},
}};

constexpr double kRate = 60;  // frames a second
constexpr int kRepetitions = 3;

bool isEnd(const Joint& joint) {
  return joint.name.ends_with("_end");
}

}  // namespace

std::span<const SampleMotion> sampleMotions() {
  return kMotions;
}

Motion makeSampleMotion(std::string_view name) {
  const SampleMotion& recipe = findByName(kMotions, "sample", name);
  Motion motion;
  motion.name = recipe.name;
  motion.framesPerSecond = kRate;
  motion.skeleton = recipe.skeleton();
  Clip& clip = motion.clips.emplace_back();
  clip.name = recipe.name;
  clip.translations.push_back({});  // of the hips, the first joint
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    if (!isEnd(motion.skeleton.joints[j])) clip.rotations.emplace_back().joint = j;
  }
  const int frames = static_cast<int>(std::lround(recipe.seconds * kRate)) * kRepetitions;
  for (int f = 0; f <= frames; ++f) {
    const double seconds = f / kRate;
    const Pose pose = recipe.at(motion.skeleton, seconds);
    clip.translations[0].times.push_back(static_cast<float>(seconds));
    clip.translations[0].values.push_back(pose.locals[0].translation.cast<float>());
    for (auto& track : clip.rotations) {
      track.times.push_back(static_cast<float>(seconds));
      track.values.push_back(pose.locals[track.joint].rotation.normalized().cast<float>());
    }
  }
  return motion;
}

}  // namespace limber
