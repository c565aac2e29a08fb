#include "limber/transfer/rig_transfer.h"

#include <algorithm>
#include <limits>

#include "limber/anatomy/anatomy.h"

#include "limber/surface/piece_links.h"
#include "limber/surface/surface_edges.h"
#include "limber/transfer/facing_surface.h"
#include "limber/transfer/joint_follow.h"
#include "limber/transfer/weight_projection.h"

namespace limber {

namespace {

double extentAlong(const TriMesh& mesh, const Vec3& axis) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) {
      low = std::min(low, axis.dot(mesh.position(v)));
      high = std::max(high, axis.dot(mesh.position(v)));
    }
  }
  return high - low;
}

}  // namespace

RigTransfer transferRig(const RiggedBody& source, std::span<const JointLandmark> landmarks, const TriMesh& target,
                        const RigTransferOptions& options, Progress& progress) {
  RigTransfer result;
  progress.step("align limbs");
  const std::vector<Affine> globals = restGlobals(source.skeleton);
  const LimbAlignment alignment = alignLimbs(source.skeleton, globals, landmarks);
  result.source = facingOutwards(source.mesh);
  TriMesh aligned = result.source;
  aligned.positions = alignedSurface(source.mesh.positions, source.weights, alignment);
  const TriMesh goal = facingOutwards(target);

  const std::vector<VertexPair> links = pieceLinks(source.mesh.positions, surfaceEdges(source.mesh).edges);
  result.registered = registerSurface(aligned, links, goal, options.registration, progress);

  progress.step("joints and weights");
  result.places = followSurface(source.skeleton, alignment.places, aligned, result.registered, source.weights);
  const Quat whole(alignment.whole.rotation());
  result.turns = turnsBetween(source.skeleton, globals, result.places, whole);
  for (std::size_t v = 0; v < result.registered.size(); ++v) {
    aligned.positions[v] = result.registered[v].cast<float>();
  }
  result.points = takenAfter(aligned, goal);
  result.weights = projectWeights(aligned, source.weights, result.points, options.maxInfluences);
  const Anatomy anatomy = readAnatomy(source.skeleton);
  result.gaps = measureGaps(goal, result.points, anatomy, result.weights,
                            extentAlong(goal, whole * anatomy.axes.up));
  return result;
}

}  // namespace limber
