#include "limber/evaluate/skin/skinned_model.h"

#include <algorithm>
#include <utility>

#include "limber/geometry/mesh/prepare.h"

namespace limber {

SkinnedModel readSkinnedModel(const Character& character) {
  if (!character.hasRig()) {
    throw Error(ErrorCode::kUnsupported, "has no skin weights to compare", character.document().name,
                "rig it first: limber rig");
  }
  const Character whole = character.inOneBindPose();
  const Geometry& surface = whole.shapedSurface();
  return {{surface.positions, surface.triangles}, whole.binding().skeleton, whole.weights(), storedVertices(surface)};
}

SkinnedModel weldedModel(const SkinnedModel& model) {
  PreparedMesh prepared = prepareMesh(model.mesh.positions, model.mesh.triangles, model.stored);
  SkinnedModel welded;
  welded.skeleton = model.skeleton;
  welded.mesh = std::move(prepared.mesh);
  const Index count = welded.mesh.vertexCount(), slots = model.weights.slots;
  welded.weights = {slots, std::vector<Index>(std::size_t{count} * slots),
                    std::vector<float>(std::size_t{count} * slots)};
  for (std::size_t v = prepared.weldedVertex.size(); v-- > 0;) {
    const Index to = prepared.weldedVertex[v];
    welded.mesh.positions[to] = model.mesh.positions[v];
    const auto joints = model.weights.jointsOf(static_cast<Index>(v));
    const auto weights = model.weights.weightsOf(static_cast<Index>(v));
    std::copy(joints.begin(), joints.end(), &welded.weights.joints[std::size_t{to} * slots]);
    std::copy(weights.begin(), weights.end(), &welded.weights.weights[std::size_t{to} * slots]);
  }
  normalizeWeights(welded.weights);
  return welded;
}

double longestSide(const TriMesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) box.add(mesh.position(v));
  }
  return box.empty() ? 0 : box.longestSide();
}

}  // namespace limber
