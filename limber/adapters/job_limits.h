// Limits of a job in a file of the user's: an adapter, a plan of a study.
#pragma once

#include "limber/document/gltf/json_access.h"
#include "limber/jobs/job.h"

namespace limber {

// {"seconds": 120, "memory_mb": 2048}; what is missing there stays as it is in `limits`, and all where there is no such
// object. Throws Error kBadData that names the wrong entry.
void readJobLimits(const JsonView& object, JobLimits& limits);

}  // namespace limber
