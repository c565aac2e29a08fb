// What autoRig did, as JSON: one form for the command line, the studio and WebAssembly (docs/report.md).
#pragma once

#include "limber/pipeline/auto_rig.h"

namespace limber {

// Keys in the order of docs/report.md, in snake_case. Text out of the file stands in it as it is: dumpReport writes it.
Json toJson(const AutoRigReport& report);

}  // namespace limber
