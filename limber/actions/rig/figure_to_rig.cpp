#include "limber/actions/rig/figure_to_rig.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "limber/actions/rig/figure_geometry.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/geometry/mesh/components.h"

namespace limber {

namespace {

// Loose vertices are no pieces.
Index countSolid(const TriMesh& mesh, const std::vector<Index>& pieceOf, Index pieces) {
  std::vector<bool> isSolid(pieces, false);
  for (const Triangle& t : mesh.triangles) isSolid[pieceOf[t[0]]] = true;
  return static_cast<Index>(std::count(isSolid.begin(), isSolid.end(), true));
}

}  // namespace

FigureToRig readFigureToRig(Asset& asset, const AutoRigOptions& options, AutoRigReport& report, Progress& progress) {
  report.skinning = options.skinning;
  report.maxInfluences = options.weights.maxInfluences;
  progress.stage("read geometry");
  joinBindPoses(asset);
  if (options.existingRig == ExistingRig::kReplace && hasRig(asset)) {
    const RemovedRig removed = takeRigOut(asset);
    report.removedJoints = removed.joints;
    report.removedClips = removed.clips;
  }
  FigureToRig result{Character(asset), {}, {}};
  const Geometry& geometry = result.geometry();

  progress.stage("weld");
  result.figure = figureOf(geometry, geometry.triangles);
  const PreparedMesh& prepared = result.figure.prepared;
  Index pieces = 0;
  result.pieceOf = vertexComponents(prepared.mesh, &pieces);
  report.sourceVertices = static_cast<Index>(geometry.positions.size());
  report.weldedVertices = prepared.mesh.vertexCount();
  report.triangles = prepared.mesh.triangleCount();
  report.pieces = countSolid(prepared.mesh, result.pieceOf, pieces);
  report.warnings.append(prepared.warnings);
  return result;
}

RiggerInput riggerInput(const Asset& asset, const FigureToRig& input, const RigOptions& options, bool looksForLimbs) {
  RiggerInput result{{}, {}, options};
  const Geometry& geometry = input.geometry();
  if (looksForLimbs) result.accessories = findAccessories(asset, geometry);
  if (!result.accessories.empty()) {
    result.bare = figureOf(geometry, bodyTriangles(geometry, result.accessories)).prepared;
    if (options.memory) {
      std::shared_ptr<RigMemory>& bare = options.memory->bare;
      if (!bare) bare = std::make_shared<RigMemory>();
      result.options.memory = bare;
    }
  }
  const WorkingFrame& frame = result.surfaceOf(input).frame;
  for (JointPin& pin : result.options.pins) pin.position = frame.toWorking(pin.position);
  return result;
}

void completeReport(const Asset& rigged, AutoRigReport& report, Progress& progress) {
  progress.finish();
  const Warnings ofStages = std::exchange(report.warnings, rigged.warnings);
  report.warnings.append(ofStages);
  report.stages = progress.stages();
}

}  // namespace limber
