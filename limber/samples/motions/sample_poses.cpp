#include "limber/samples/motions/sample_poses.h"

#include <array>

#include "limber/core/text/names.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/pose_recipes.h"

namespace limber {

namespace {

template <Stance (*stance)()>
Pose figurePose(const Skeleton& figure) {
  return poseOf(figure, stance());
}

template <Stance (*stance)()>
constexpr SamplePose ofPerson(std::string_view name, std::string_view summary) {
  return {name, summary, &figureSkeleton, &figurePose<stance>};
}

template <Pose (*pose)(const Skeleton&)>
constexpr SamplePose ofAnimal(std::string_view name, std::string_view summary) {
  return {name, summary, &quadrupedSkeleton, pose};
}

constexpr std::array<SamplePose, 18> kSamplePoses = {{
    ofPerson<&standStance>("stand", "a person who stands, arms hanging"),
    ofPerson<&walkStance>("walk", "a step, as the heel touches the ground"),
    ofPerson<&runStance>("run", "a person who runs, pushing off"),
    ofPerson<&jumpStance>("jump", "a person in the air"),
    ofPerson<&sitStance>("sit", "on a seat as high as the knees"),
    ofPerson<&crouchStance>("crouch", "a person who crouches"),
    ofPerson<&kneelStance>("kneel", "a person on one knee"),
    ofPerson<&bowStance>("bow", "a person who bows"),
    ofPerson<&reachStance>("reach", "for something high up, on tiptoe"),
    ofPerson<&pointStance>("point", "a person who points ahead"),
    ofPerson<&waveStance>("wave", "a person who waves a hand"),
    ofPerson<&cheerStance>("cheer", "a person with both hands up"),
    ofAnimal<&quadrupedStand>("animal-stand", "an animal that stands on four legs"),
    ofAnimal<&quadrupedWalk>("animal-walk", "an animal in the middle of a step"),
    ofAnimal<&quadrupedSit>("animal-sit", "an animal that sits on its haunches"),
    ofAnimal<&quadrupedLie>("animal-lie", "an animal that lies on its belly"),
    ofAnimal<&quadrupedStretch>("animal-stretch", "chest low, rump up: it stretches or wants to play"),
    ofAnimal<&quadrupedHowl>("animal-howl", "an animal that sits and howls"),
}};

}  // namespace

std::span<const SamplePose> samplePoses() {
  return kSamplePoses;
}

PortablePose makeSamplePose(std::string_view name) {
  const SamplePose& recipe = findByName(kSamplePoses, "sample pose", name);
  PortablePose pose{std::string(recipe.name), recipe.skeleton(), {}};
  pose.pose = recipe.pose(pose.skeleton);
  return pose;
}

}  // namespace limber
