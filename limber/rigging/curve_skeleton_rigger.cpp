#include "limber/rigging/curve_skeleton_rigger.h"

#include "limber/rigging/curve_skeleton/curve_skeleton.h"
#include "limber/rigging/sphere_mesh_rigger.h"

namespace limber {

AutoRig rigWithCurveSkeleton(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  checkHandles(mesh, options);
  const std::shared_ptr<RigMemory> memory = options.memory ? options.memory : std::make_shared<RigMemory>();
  if (!memory->curves || memory->curves->vertexCount() != mesh.vertexCount()) {
    progress.step("contract");
    memory->curves = std::make_shared<const CurveSkeleton>(CurveSkeleton::build(mesh, progress));
  }
  const CurveSkeleton& curves = *memory->curves;
  AutoRig rig;
  progress.step("handles");
  rig.suggestions = curves.curves().spheres.size() == 1
                        ? std::vector<HandleSuggestion>{{1, 1}}
                        : suggestHandles(curves.errors(suggestedFrom()), mesh.vertexCount());
  rig.skeleton = handleSkeleton(curves.level(options.handles.value_or(rig.suggestions.front().handles)));
  return rig;
}

}  // namespace limber
