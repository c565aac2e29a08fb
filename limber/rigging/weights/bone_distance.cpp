#include "limber/rigging/weights/bone_distance.h"

#include <algorithm>
#include <map>

#include "limber/core/parallel.h"
#include "limber/rigging/weights/weight_steps.h"

namespace limber {

namespace {

constexpr double kOuter = 2;               // inner radii
constexpr double kMinRadius = 0.005;       // longest sides: of bones that lie on the surface
constexpr std::size_t kVertexRange = 256;  // vertices of one parallel piece of work

// By vertex: the bone nearest to it.
std::vector<std::size_t> nearestBones(const TriMesh& mesh, std::span<const Bone> bones) {
  std::vector<std::size_t> nearest(mesh.vertexCount(), 0);
  parallelFor(nearest.size(), kVertexRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 position = mesh.position(static_cast<Index>(v));
      double least = distanceToBone(bones[0], position);
      for (std::size_t b = 1; b < bones.size(); ++b) {
        const double distance = distanceToBone(bones[b], position);
        if (distance > least || (distance == least && bones[b].joint >= bones[nearest[v]].joint)) continue;
        least = distance;
        nearest[v] = b;
      }
    }
  });
  return nearest;
}

// By bone; a bone to which nothing is nearest has the least.
std::vector<double> innerRadii(const TriMesh& mesh, std::span<const Bone> bones,
                               const std::vector<std::size_t>& nearest) {
  std::vector<std::vector<double>> distances(bones.size());
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    distances[nearest[v]].push_back(distanceToBone(bones[nearest[v]], mesh.position(v)));
  }
  std::vector<double> radii;
  for (std::vector<double>& of : distances) {
    double median = 0;
    if (!of.empty()) {
      const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
      std::nth_element(of.begin(), middle, of.end());
      median = *middle;
    }
    radii.push_back(std::max(median, kMinRadius));
  }
  return radii;
}

}  // namespace

WeightResult nearestBoneWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                                Progress& progress) {
  checkWeightArguments(mesh, bones, options);
  progress.step("nearest bones");
  const std::vector<std::size_t> nearest = nearestBones(mesh, bones);
  WeightResult result;
  result.weights.slots = options.maxInfluences;
  result.weights.joints.resize(std::size_t{mesh.vertexCount()} * options.maxInfluences);
  result.weights.weights.resize(result.weights.joints.size());
  for (Index v = 0; v < mesh.vertexCount(); ++v) bindTo(bones[nearest[v]].joint, v, result.weights);
  if (options.pieces == PieceMode::kRigid) bindWholePieces(mesh, result);
  return result;
}

WeightResult envelopeWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                             Progress& progress) {
  checkWeightArguments(mesh, bones, options);
  progress.step("envelopes");
  const std::vector<std::size_t> nearest = nearestBones(mesh, bones);
  const std::vector<double> inner = innerRadii(mesh, bones, nearest);
  InfluenceTable table(mesh.vertexCount(), options.maxInfluences);
  parallelFor(mesh.vertexCount(), kVertexRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::map<Index, double> weightByJoint;  // by joint: of its bones the one that holds most
      for (std::size_t b = 0; b < bones.size(); ++b) {
        const double distance = distanceToBone(bones[b], mesh.position(static_cast<Index>(v)));
        const double left = std::clamp((kOuter * inner[b] - distance) / ((kOuter - 1) * inner[b]), 0.0, 1.0);
        double& most = weightByJoint[bones[b].joint];
        most = std::max(most, left * left);
      }
      for (const auto& [joint, weight] : weightByJoint) table.offer(v, joint, static_cast<float>(weight));
    }
  });
  WeightResult result;
  std::size_t outside = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (table.weightsOf(v)[0] > 0) continue;
    table.offer(v, bones[nearest[v]].joint, 1);
    ++outside;
  }
  if (outside > 0) {
    result.warnings.add("outside-envelopes", "vertices outside all envelopes follow their nearest bones", {}, outside);
  }
  result.weights = normalizedWeights(table);
  if (options.pieces == PieceMode::kRigid) bindWholePieces(mesh, result);
  return result;
}

WeightResult bridgedWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                            InfluenceTable& table, Progress& progress) {
  progress.step("bridge pieces");
  WeightResult result;
  result.bridged = bridgeBare(mesh, table);
  result.weights = normalizedWeights(table);
  Index bare = 0;
  while (bare < mesh.vertexCount() && result.weights.weightsOf(bare)[0] > 0) ++bare;
  if (bare < mesh.vertexCount()) {
    result = nearestBoneWeights(mesh, bones, options, progress);
    result.warnings.add("no-bone-in-sight", "no bone reaches the model, so each vertex took the nearest bone");
  } else if (options.pieces == PieceMode::kRigid) {
    bindWholePieces(mesh, result);
  }
  return result;
}

}  // namespace limber
