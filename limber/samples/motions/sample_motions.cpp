#include "limber/samples/motions/sample_motions.h"

#include <cmath>
#include <string>
#include <vector>

#include "limber/core/text/names.h"
#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"

namespace limber {

namespace {

template <const BipedGait& gait>
Pose gaitPose(const Skeleton& figure, double seconds) {
  return poseOf(figure, gaitAt(gait, seconds));
}

template <const KeyedMotion& motion>
Pose keyedPose(const Skeleton& figure, double seconds) {
  return poseOf(figure, keyedStance(motion.keys(), motion.period, seconds));
}

template <const QuadrupedGait& gait>
Pose quadrupedPose(const Skeleton& quadruped, double seconds) {
  return quadrupedGaitAt(gait, quadruped, seconds);
}

template <const BipedGait& gait>
SampleMotion onTwoLegs(std::string_view name, std::string_view summary) {
  const double wholeTurn = gait.turn == 0 ? 1 : 2 * kPi / gait.turn;  // strides until it faces the same direction again
  return {name, summary, wholeTurn * gait.seconds, &figureSkeleton, &gaitPose<gait>};
}

template <const KeyedMotion& motion>
SampleMotion keyed(std::string_view name, std::string_view summary) {
  return {name, summary, motion.period, &figureSkeleton, &keyedPose<motion>};
}

template <const QuadrupedGait& gait>
SampleMotion onFourLegs(std::string_view name, std::string_view summary) {
  return {name, summary, gait.seconds, &quadrupedSkeleton, &quadrupedPose<gait>};
}

const std::vector<SampleMotion>& allMotions() {
  static const std::vector<SampleMotion> motions = {
      onTwoLegs<kWalkGait>("walk", "a person who walks"),
      onTwoLegs<kRunGait>("run", "a person who runs"),
      onTwoLegs<kSneakGait>("sneak", "a person who sneaks, low and slow"),
      keyed<kJump>("jump", "a person who jumps up"),
      keyed<kIdle>("idle", "a person who stands, breathes and looks round"),
      keyed<kWave>("wave", "a person who waves a hand"),
      keyed<kSitDown>("sit-down", "a person who sits down and gets up again"),
      onTwoLegs<kTurnGait>("turn", "a person who turns round on the spot"),
      keyed<kJumpingJack>("jumping-jack", "a person who does jumping jacks"),
      onFourLegs<kQuadrupedWalk>("quadruped-walk", "an animal that walks on four legs"),
      onFourLegs<kTrot>("trot", "an animal that trots"),
      onFourLegs<kGallop>("gallop", "an animal that gallops"),
      {"insect-walk", "an insect that walks on six legs", kScuttlePeriod, &insectSkeleton, &scuttleAt},
      {"spider-walk", "a spider that walks on eight legs", kScuttlePeriod, &spiderSkeleton, &scuttleAt},
      {"swim", "a fish that swims", kSwimPeriod, &fishSkeleton, &swimAt},
      {"slither", "a snake that slithers", kSlitherPeriod, &serpentSkeleton, &slitherAt},
      {"flap", "a bird that beats its wings", kFlapPeriod, &birdSkeleton, &flapAt},
  };
  return motions;
}

constexpr double kRate = 60;  // frames a second
constexpr int kRepetitions = 3;

bool isEnd(const Joint& joint) {
  return joint.name.ends_with("_end");
}

}  // namespace

std::span<const SampleMotion> sampleMotions() {
  return allMotions();
}

Motion makeSampleMotion(std::string_view name) {
  const SampleMotion& recipe = findByName(allMotions(), "sample", name);
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
