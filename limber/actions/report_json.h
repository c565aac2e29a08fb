// What autoRig and rigFromAnimation did and checkRigging found, as JSON: one form for the command line, the studio and WebAssembly
// (docs/report.md).
#pragma once

#include "limber/actions/rig/auto_rig.h"

namespace limber {

struct AnimationRigReport;
struct RigCheckReport;

// Keys in the order of docs/report.md, in snake_case. Text from the file is kept as it is: dumpReport escapes it.
Json toJson(const AutoRigReport& report);
Json toJson(const AnimationRigReport& report);
Json toJson(const RigCheckReport& report);
// [{"name", "seconds", "steps": the same, where there are any}]
Json stagesJson(const std::vector<StageTime>& stages);

}  // namespace limber
