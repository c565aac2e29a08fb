// A user's request for rigging, by the names common to the program, Python and WebAssembly. Which options go together,
// their defaults and their ranges are defined here alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/actions/rig/auto_rig.h"

namespace limber {

struct ChosenTemplate {
  std::string name;                       // auto, or a name of bodyKinds()
  std::optional<Skeleton> skeleton = {};  // a user's own; the name is then what it is called
};

struct RigRequest {
  std::optional<std::string> rigger;  // none: template where one is named, else the one of AutoRigOptions
  std::string skinning = AutoRigOptions().skinning;
  std::optional<ChosenTemplate> chosenTemplate;
  std::optional<Index> handles;                         // 1 or more
  Index maxInfluences = WeightOptions().maxInfluences;  // 1 to 8
  std::string pieces = "auto";                          // a name of pieceModes()
  std::string existingRig = "refuse";                   // refuse, replace, keep-skeleton
  std::optional<std::string> up, front;                 // +x, -x, x, ...; none: found
  std::vector<JointPin> pins;                           // in world space, metres
  bool upright = false, chains = false;
  std::optional<std::filesystem::path> reading;  // a file of networks that read shapes; none: those of limber
  std::string target = "gltf";  // a name of engineTargets(): what the caller makes of the rigged model (toTarget)
};

// From the options of the package for npm: an object with any of handles, maxInfluences, rigger, template, skinning,
// pieces, existingRig, up, front, pins ({"leftHand": [x, y, z]}), upright, chains and target. Throws Error
// kBadArgument, which names the option as optionsOf() does, for a value of the wrong kind, and another key as it is.
RigRequest rigRequestFromJson(std::string_view json);

// Throws Error kBadArgument for what is out of range, does not go together or is called by no name that there is. Where
// one option is to blame its name is where(), between backticks (spellOptions). A rigger and a method of skinning may
// be a program of the user's: autoRig() looks for their names. Networks are read once all else is valid; throws as
// readShapeWeights does.
AutoRigOptions optionsOf(const RigRequest& request);

// The model that was rigged, as the request's target expects it. What it cannot give goes to the report's warnings.
void finishRig(Asset& asset, const RigRequest& request, AutoRigReport& report);

// With a template of the user's instead of the request's: read() returns it, once all else is valid.
AutoRigOptions optionsWithOwnTemplate(RigRequest request, std::string_view name, const std::function<Skeleton()>& read);
// With a template by name, or by its file (readTemplateFile), which is what a name with a dot is.
AutoRigOptions optionsWithTemplate(RigRequest request, const std::string& nameOrFile);

}  // namespace limber
