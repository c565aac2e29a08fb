#include "limber/rigging/transfer/rig_transfer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "limber/character/anatomy/anatomy.h"

#include "limber/geometry/surface/piece_links.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/transfer/facing_surface.h"
#include "limber/rigging/transfer/joint_follow.h"
#include "limber/rigging/transfer/limb_girth.h"
#include "limber/rigging/transfer/weight_projection.h"
#include "limber/rigging/transfer/whole_alignment.h"

namespace limber {

namespace {

struct AlignedBody {
  LimbAlignment alignment;
  TriMesh surface;
};

// Part of the longest side. Bodies that stand alike lie this near to each other when one is moved as a whole; others
// may be nearer so by chance. Over `tune`, pairs that a whole move lays nearer than limbs do lie up to 0.044 apart
// where it is right, and from 0.049 on where it mostly is wrong (surfacesApart tells up to 0.1).
constexpr double kStandAlike = 0.045;

// By its limbs; or as a whole where it then lies nearer to the target and both stand alike, so that the limbs of a
// target that was read wrong do not matter.
AlignedBody alignBody(const RiggedBody& source, const TriMesh& surface, std::span<const Affine> globals,
                      std::span<const JointLandmark> landmarks, const TriMesh& target, const Vec3& up) {
  std::vector<LimbAlignment> candidates = {alignLimbs(source.skeleton, globals, landmarks)};
  const Quat turn(candidates[0].whole.rotation());
  for (const Quat& whole : {turn, Quat::Identity()}) {
    candidates.push_back(alignWhole(globals, wholeSimilarity(surface, target, whole, whole * up)));
  }
  TriMesh aligned = surface;
  std::size_t best = 0;
  double least = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    aligned.positions = alignedSurface(source.mesh.positions, source.weights, candidates[i]);
    const double apart = surfacesApart(aligned, target);
    if (i > 0 && !(apart < std::min(least, kStandAlike))) continue;
    least = apart;
    best = i;
  }
  if (best == 0) fitGirths(source.skeleton, globals, landmarks, surface, source.weights, target, candidates[0]);
  aligned.positions = alignedSurface(source.mesh.positions, source.weights, candidates[best]);
  return {std::move(candidates[best]), std::move(aligned)};
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
  result.positions = followSurface(source.skeleton, alignment.positions, aligned, result.registered, source.weights);
  const Quat whole(alignment.whole.rotation());
  result.turns = turnsBetween(source.skeleton, globals, result.positions, whole);
  for (std::size_t v = 0; v < result.registered.size(); ++v) {
    aligned.positions[v] = result.registered[v].cast<float>();
  }
  result.points = takenAfter(aligned, goal);
  result.weights = projectWeights(aligned, source.weights, result.points, options.maxInfluences);
  result.gaps = measureGaps(goal, result.points, anatomy, result.weights, extentAlong(goal, whole * anatomy.axes.up));
  return result;
}

}  // namespace limber
