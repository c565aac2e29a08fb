#include "limber/samples/samples.h"

#include <array>
#include <string>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/names.h"
#include "limber/samples/character.h"
#include "limber/samples/model_builder.h"
#include "limber/samples/robot.h"

namespace limber {

namespace {

template <Character (*recipe)()>
Asset makeCharacter() {
  const Character character = recipe();
  ModelBuilder builder(character.name);
  std::vector<Index> materials;
  for (const SampleMaterial& material : character.materials) materials.push_back(builder.addMaterial(material));
  const Index mesh = builder.addMesh(character.name, buildCharacter(character), materials);
  builder.addNode(character.name, mesh);
  return builder.take();
}

constexpr std::array<SampleModel, 5> kSamples = {{
    {"stool", "a four-legged stool: no character, but it can walk", &makeCharacter<stoolCharacter>},
    {"biped", "a person in A-pose", &makeCharacter<bipedCharacter>},
    {"quadruped", "a young fox with a bushy tail", &makeCharacter<quadrupedCharacter>},
    {"winged", "a small dragon with spread wings", &makeCharacter<wingedCharacter>},
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
