// How often a rig by template is of the right kind and near the artist's, and how far its confidence can be believed.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/evaluate/rig/rig_table.h"

namespace limber {

// A file of a collection with what is known of it.
struct LabelledFile {
  std::string path;   // seen from the list's folder
  std::string kind;   // "chibi", "quadruped", "fish", ...
  std::string split;  // "tune", "check", ...
};

// From tab separated text whose first line names its columns; those called path, kind and split count. Throws Error
// kBadData without them.
std::vector<LabelledFile> parseLabelledFiles(std::string_view text);

// The templates that suit a kind of body; none: handles do. People of every build are
// humanoid, whoever walks on four legs is a quadruped, low ones may be crawlers.
std::span<const std::string_view> templatesFor(std::string_view kind);

struct TemplateTrial {
  LabelledFile file;
  RigTableRow row;
};

// From what a joint of a rig that is right may be off in the mean (J2J without fingers), percent of the longest side.
inline constexpr double kRigIsOff = 8;

// Of each split: how often the kind is told right (Wilson's 95 % interval), what is called sure, what is sure and
// wrong, and how near the rigs come; the reliability of the confidence; and which kind was taken for which template.
std::vector<Table> templateTables(std::span<const TemplateTrial> trials);
// A line for each trial.
Table eachTemplateTrial(std::span<const TemplateTrial> trials);

// A file rigged by one of several riggers.
struct RiggerTrial {
  std::string rigger;
  std::string group;  // its split or folder
  RigTableRow row;
  double inside = 0;  // fraction of the joints (insideFraction)
};

// Means of each group and rigger, side by side in the order in which they come: joints that there are for the artist's,
// the distances and the pairing of joints without fingers, those inside, and seconds. Over the files (by their paths)
// that all the riggers have rigged, so that lines of a group compare.
Table riggerTable(std::span<const RiggerTrial> trials);

}  // namespace limber
