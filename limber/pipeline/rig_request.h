// What a user asks of rigging, by the names that the program, Python and WebAssembly share. Which options go together,
// their defaults and their ranges are here alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/pipeline/auto_rig.h"

namespace limber {

struct RigRequest {
  std::optional<std::string> rigger;  // none: template where one is named, else the one of AutoRigOptions
  std::string skinning = AutoRigOptions().skinning;
  std::optional<std::string> templateName;              // auto, or a name of namedTemplates()
  std::optional<Skeleton> templateSkeleton;             // a user's own; templateName is then what it is called
  std::optional<Index> handles;                         // 1 or more
  Index maxInfluences = WeightOptions().maxInfluences;  // 1 to 8
  std::string pieces = "auto";                          // a name of pieceModes()
  std::string existingRig = "refuse";                   // refuse, replace, keep-skeleton
  std::string up, front;                                // +x, -x, x, ...; empty: found
  std::vector<JointPin> pins;                           // in world space, metres
  bool upright = false, chains = false;
};

// Names a template, or the file of one (readTemplateFile), which is what a name with a dot is. Throws as that does.
void chooseTemplate(RigRequest& request, const std::string& nameOrFile);

// From the options of the package for npm: an object with any of handles, maxInfluences, rigger, template, skinning,
// pieces, existingRig, up, front, pins ({"leftHand": [x, y, z]}), upright and chains. Throws Error kBadArgument, which
// names the key, for another key and for a value of the wrong kind.
RigRequest rigRequestFromJson(std::string_view json);

// Throws Error kBadArgument for what is out of range, does not go together or is called by no name that there is. Where
// one option is to blame its name is where(), between backticks (spellOptions). A rigger and a method of skinning may
// be a program of the user's: autoRig() looks for their names.
AutoRigOptions optionsOf(const RigRequest& request);

}  // namespace limber
