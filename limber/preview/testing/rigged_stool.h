// The sample stool with three handles.
#pragma once

#include "limber/actions/rig/auto_rig.h"
#include "limber/samples/samples.h"

namespace limber::testing {

inline Asset riggedStool() {
  Asset asset = makeSample("stool");
  AutoRigOptions options;
  options.rig.handles = 3;
  Progress progress;
  autoRig(asset, options, progress);
  return asset;
}

}  // namespace limber::testing
