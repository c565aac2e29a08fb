#include "limber/session/drag/surface_parts.h"

#include "limber/actions/parts/model_parts.h"

namespace limber {

SurfaceParts surfaceParts(const SessionState& state) {
  const RiggedModel& rig = *state.rig;
  return riggedParts(rig.geometry(), rig.skeleton(), rig.weights, PartDetail::kLimbs);
}

}  // namespace limber
