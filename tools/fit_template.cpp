// Fits the proportions of people (limber/rigging/templates/humanoid_landmarks.h) to characters whose joints have names:
//   limber_fit_template FILE...
// Coordinate descent on the mean distance of named joints, in percent of the height. Files of one maker often have the
// same skeleton, so each maker (a name's part before the first '_') is also left out once: the error of the others' fit
// on its files is the error to expect of models never seen. Prints both, and the values to put into the header.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/parallel.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/evaluate/skin/skinned_model.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/measured_model.h"
#include "limber/rigging/roles/body_kinds.h"
#include "limber/rigging/roles/placed_joints.h"
#include "limber/rigging/templates/humanoid_landmarks.h"
#include "limber/rigging/templates/joints_between.h"

using namespace limber;

namespace {

constexpr int kRounds = 3;
constexpr double kMinGain = 1e-4;  // percent
constexpr double kMaxError = 15;   // percent that one joint counts at most: a limb not found is not the proportions'

struct Parameter {
  const char* name;
  double HumanoidProportions::*value;
  double step;
};
constexpr std::array<Parameter, 11> kParameters = {{
    {"hipAboveParting", &HumanoidProportions::hipAboveParting, 0.2},
    {"hipsBelow", &HumanoidProportions::hipsBelow, 0.01},
    {"neckAboveShoulders", &HumanoidProportions::neckAboveShoulders, 0.01},
    {"headAboveNeck", &HumanoidProportions::headAboveNeck, 0.01},
    {"ankle", &HumanoidProportions::ankle, 0.01},
    {"ankleShare", &HumanoidProportions::ankleFraction, 0.02},
    {"knee", &HumanoidProportions::knee, 0.02},
    {"elbow", &HumanoidProportions::elbow, 0.02},
    {"kneeForward", &HumanoidProportions::kneeForward, 0.1},
    {"chestBack", &HumanoidProportions::chestBack, 0.1},
    {"upperChest", &HumanoidProportions::upperChest, 0.03},
}};

struct FittedCharacter {
  std::string maker;
  std::shared_ptr<const MeasuredModel> measured;
  TemplateSkeleton skeleton;
  std::vector<Vec3> positions;                // as read, before the shape of limbs refines them; body space
  std::vector<std::pair<Index, Vec3>> truth;  // joint of the template, position in body space
};

FittedCharacter readCharacter(const std::filesystem::path& file) {
  Asset asset = readAsset(file);
  const Skeleton skeleton = readSkinnedModel(asset).skeleton;
  removeRig(asset);
  const Geometry geometry = collectGeometry(asset);
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  FittedCharacter character;
  const std::string stem = file.stem().string();
  character.maker = stem.substr(0, stem.find('_'));
  character.measured = measureModel(prepared.mesh, {});
  RoleReading reading = character.measured->reading;
  if (reading.frame().symmetric()) reading.makeSymmetric();
  RoledSkeleton made = skeletonOfKind(findBodyKind("humanoid"), reading);
  character.positions = placedJoints(made, reading, TemplatePins(made.skeleton.joints.size()));
  character.skeleton = std::move(made.skeleton);
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (const HumanoidJoint& named : humanoidJoints(skeleton)) {
    const std::optional<Index> joint = character.skeleton.find(named.bone);
    if (!joint || named.bone == "upperChest" || named.bone.find("Shoulder") != std::string_view::npos) continue;
    const Vec3 position = prepared.frame.toWorking(globals[named.joint].translation());
    character.truth.emplace_back(*joint, reading.frame().toBody(position));
  }
  return character;
}

double errorOf(const FittedCharacter& character, const HumanoidProportions& proportions) {
  const MeasuredModel& measured = *character.measured;
  std::vector<Vec3> positions = character.positions;
  refineHumanoid(character.skeleton, measured.body, measured.frame(), TemplatePins(positions.size()), positions,
                 proportions);
  placeBetween(character.skeleton, positions);
  double sum = 0;
  for (const auto& [joint, position] : character.truth)
    sum += std::min(kMaxError, 100 * (positions[joint] - position).norm());
  return sum / static_cast<double>(std::max<std::size_t>(1, character.truth.size()));
}

double meanError(const std::vector<const FittedCharacter*>& characters, const HumanoidProportions& proportions) {
  std::vector<double> errors(characters.size());
  parallelFor(characters.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) errors[c] = errorOf(*characters[c], proportions);
  });
  double sum = 0;
  for (const double error : errors) sum += error / static_cast<double>(errors.size());
  return sum;
}

HumanoidProportions fitted(const std::vector<const FittedCharacter*>& characters) {
  HumanoidProportions best;
  double least = meanError(characters, best);
  for (int round = 0; round < kRounds; ++round) {
    for (const Parameter& parameter : kParameters) {
      for (const double sign : {1.0, -1.0}) {
        HumanoidProportions other = best;
        other.*parameter.value += sign * parameter.step / (1 << round);
        const double error = meanError(characters, other);
        if (error > least - kMinGain) continue;
        least = error;
        best = other;
        break;
      }
    }
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<FittedCharacter> characters;
  std::set<std::string> makers;
  std::vector<const FittedCharacter*> all;
  try {
    for (int i = 1; i < argc; ++i) characters.push_back(readCharacter(argv[i]));
  } catch (const Error& error) {
    fmt::print(stderr, "limber_fit_template: {}\n", error.what());
    return 1;
  }
  if (characters.empty()) {
    fmt::print(stderr, "usage: limber_fit_template FILE...\n");
    return 1;
  }
  for (const FittedCharacter& character : characters) {
    makers.insert(character.maker);
    all.push_back(&character);
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const HumanoidProportions best = fitted(all);
  fmt::print("named joints of {} files, % of height: {:.3f} as it is, {:.3f} fitted\n", all.size(), meanError(all, {}),
             meanError(all, best));
  for (const Parameter& parameter : kParameters) {
    fmt::print("  {:<20}{:.4f} -> {:.4f}\n", parameter.name, HumanoidProportions().*parameter.value,
               best.*parameter.value);
  }
  double heldOutError = 0;
  for (const std::string& maker : makers) {
    std::vector<const FittedCharacter*> others, own;
    for (const FittedCharacter* character : all) (character->maker == maker ? own : others).push_back(character);
    if (others.empty()) continue;
    const double error = meanError(own, fitted(others));
    fmt::print("  without {:<12}{:.3f} as it is, {:.3f} by the others' fit ({} files)\n", maker, meanError(own, {}),
               error, own.size());
    heldOutError += error * static_cast<double>(own.size()) / static_cast<double>(all.size());
  }
  fmt::print("left out by maker: {:.3f}\n", heldOutError);
}
