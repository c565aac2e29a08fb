// limber rig --from-animation: the bones of a mesh that moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "limber/core/types.h"

namespace limber::cli {

struct AnimationRigArguments {
  std::vector<std::string> frames;  // one file with an animation, a folder of OBJ files, or OBJ files
  std::string clip;
  std::optional<double> fps;
  std::optional<Index> bones;
};

// Adds --from-animation, --clip, --bones and --fps; returns the first.
CLI::Option* addAnimationRigOptions(CLI::App& command, AnimationRigArguments& arguments);

struct AnimationRigOutput {
  std::string output, report;
  Index maxInfluences = 4;
  bool strict = false;
  std::string target;  // a name of engineTargets()
};

// Reads, rigs, writes and prints the account.
void runAnimationRig(const AnimationRigArguments& arguments, const AnimationRigOutput& output, const Common& common);

}  // namespace limber::cli
