#include "limber/samples/sample_motions.h"

#include <array>
#include <cmath>
#include <string>

#include "limber/core/names.h"
#include "limber/samples/motion_recipes.h"

namespace limber {

namespace {

constexpr std::array<SampleMotion, 2> kMotions = {{
    {"walk", "a person who walks", 1.1, &walkAt},
    {"jumping-jack", "a person who does jumping jacks", 1.2, &jumpingJackAt},
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
  motion.skeleton = figureSkeleton();
  Clip& clip = motion.clips.emplace_back();
  clip.name = recipe.name;
  clip.translations.push_back({});  // of the hips, the first joint
  for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
    if (!isEnd(motion.skeleton.joints[j])) clip.rotations.emplace_back().joint = j;
  }
  const int frames = static_cast<int>(std::lround(recipe.seconds * kRate)) * kRepetitions;
  for (int f = 0; f <= frames; ++f) {
    const double seconds = f / kRate;
    const Pose pose = poseOf(motion.skeleton, recipe.at(seconds));
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
