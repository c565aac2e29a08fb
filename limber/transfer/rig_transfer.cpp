#include "limber/transfer/rig_transfer.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "limber/anatomy/anatomy.h"

#include "limber/surface/piece_links.h"
#include "limber/surface/surface_edges.h"
#include "limber/transfer/facing_surface.h"
#include "limber/transfer/joint_follow.h"
#include "limber/transfer/weight_projection.h"
#include "limber/transfer/whole_alignment.h"

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

struct AlignedBody {
  LimbAlignment alignment;
  TriMesh surface;
};

// What lies nearer by less than this part says little: surfaces that do not match each other are near by chance.
constexpr double kClearlyNearer = 0.8;

// By its limbs, or as a whole where it then lies clearly nearer to the target: bodies that stand alike do, and the
// limbs of a target that was read wrong do not matter to them.
AlignedBody alignBody(const RiggedBody& source, const TriMesh& surface, std::span<const Affine> globals,
                      std::span<const JointLandmark> landmarks, const TriMesh& target, const Vec3& up) {
  std::vector<LimbAlignment> candidates = {alignLimbs(source.skeleton, globals, landmarks)};
  const Quat turn(candidates[0].whole.rotation());
  for (const Quat& whole : {turn, Quat::Identity()}) {
    candidates.push_back(alignWhole(globals, wholeSimilarity(surface, target, whole, whole * up)));
  }
  std::optional<AlignedBody> best;
  double least = 0;
  for (LimbAlignment& candidate : candidates) {
    TriMesh aligned = surface;
    aligned.positions = alignedSurface(source.mesh.positions, source.weights, candidate);
    const double apart = surfacesApart(aligned, target);
    if (best && !(apart < least)) continue;
    least = best ? apart : kClearlyNearer * apart;
    best = {std::move(candidate), std::move(aligned)};
  }
  return std::move(*best);
}

}  // namespace

RigTransfer transferRig(const RiggedBody& source, std::span<const JointLandmark> landmarks, const TriMesh& target,
                        const RigTransferOptions& options, Progress& progress) {
  RigTransfer result;
  progress.step("align limbs");
  const std::vector<Affine> globals = restGlobals(source.skeleton);
  const Anatomy anatomy = readAnatomy(source.skeleton);
  result.source = facingOutwards(source.mesh);
  const TriMesh goal = facingOutwards(target);
  auto [alignment, aligned] = alignBody(source, result.source, globals, landmarks, goal, anatomy.axes.up);

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
  result.gaps = measureGaps(goal, result.points, anatomy, result.weights, extentAlong(goal, whole * anatomy.axes.up));
  return result;
}

}  // namespace limber
