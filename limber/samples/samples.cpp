#include "limber/samples/samples.h"

#include <array>

#include "limber/core/error.h"
#include "limber/core/text/names.h"
#include "limber/samples/model_recipe.h"
#include "limber/samples/flying.h"
#include "limber/samples/model_builder.h"
#include "limber/samples/robot.h"

namespace limber {

namespace {

template <ModelRecipe (*recipe)()>
Asset makeCharacter() {
  return modelOf(recipe());
}

constexpr std::array<SampleModel, 8> kSamples = {{
    {"stool", "a four-legged stool: no character, but it can walk", &makeCharacter<stoolCharacter>},
    {"footstool", "a stool without rungs, whose legs are free", &makeCharacter<footstoolCharacter>},
    {"biped", "a person in A-pose", &makeCharacter<bipedCharacter>},
    {"quadruped", "a young fox with a bushy tail", &makeCharacter<quadrupedCharacter>},
    {"winged", "a small dragon with spread wings", &makeCharacter<wingedCharacter>},
    {"theropod", "a two-legged dinosaur with a heavy tail and small arms", &makeCharacter<theropodCharacter>},
    {"flying", "the small dragon with a rig of its own, flying", &makeFlying},
    {"robot", "a robot of many pieces on nodes of their own", &makeRobot},
}};

}  // namespace

std::span<const SampleModel> sampleModels() {
  return kSamples;
}

Asset makeSample(std::string_view name) {
  return findByName(kSamples, "sample", name).make();
}

}  // namespace limber
