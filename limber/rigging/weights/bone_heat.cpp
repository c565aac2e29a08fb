#include "limber/rigging/weights/bone_heat.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "limber/core/known_error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/components.h"
#include "limber/rigging/weights/heat_solver.h"
#include "limber/rigging/weights/influence_table.h"
#include "limber/rigging/weights/jointed_pieces.h"
#include "limber/rigging/weights/piece_rules.h"
#include "limber/rigging/weights/weight_steps.h"

namespace limber {

namespace {

constexpr std::size_t kRange = 1024;  // vertices of one parallel piece of work
// Weights fade out between these two, so that no vertex follows a joint by next to nothing.
constexpr double kFadeFrom = 0.05, kFadeTo = 0.025;

bool anySource(const HeatSources& sources) {
  return !sources.joints.empty();
}

// The factored heat equation, and where heat enters it. Refers to the mesh and its pieces.
struct HeatProblem {
  std::unique_ptr<HeatSolver> solver;
  HeatSources sources;
  bool sawBone = true;
};

HeatProblem setUp(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones,
                  const std::vector<Index>& piece, std::span<const Index> jointOf) {
  HeatProblem problem;
  const auto makeLaplacian = [&] { return robustLaplacian(mesh, piece); };
  parallelInvoke([&] { problem.solver = std::make_unique<HeatSolver>(makeLaplacian, heat.directBelow); },
                 [&] {
                   const Bvh bvh(mesh);
                   problem.sources = findHeatSources(mesh, bones, &bvh, heat.sources, jointOf);
                 });
  if (!anySource(problem.sources)) {
    problem.sawBone = false;
    problem.sources = findHeatSources(mesh, bones, nullptr, heat.sources);
  }
  return problem;
}

double faded(double weight) {
  if (weight >= kFadeFrom) return weight;
  if (weight <= kFadeTo) return 0;
  return kFadeFrom * (weight - kFadeTo) / (kFadeFrom - kFadeTo);
}

SkinWeights finish(const InfluenceTable& table) {
  SkinWeights result;
  result.slots = table.slots();
  result.joints.assign(table.vertexCount() * table.slots(), 0);
  result.weights.assign(table.vertexCount() * table.slots(), 0.0f);
  parallelFor(table.vertexCount(), kRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto joints = table.jointsOf(v);
      const auto weights = table.weightsOf(v);
      std::array<double, kMaxSlots> kept = {};
      double sum = 0;
      for (Index k = 0; k < table.slots(); ++k) sum += kept[k] = faded(weights[k]);
      if (!(sum > 0)) sum = kept[0] = 1;  // many joints, all faint: the strongest holds it
      for (Index k = 0; k < table.slots() && kept[k] > 0; ++k) {
        result.joints[v * table.slots() + k] = joints[k];
        result.weights[v * table.slots() + k] = static_cast<float>(kept[k] / sum);
      }
    }
  });
  return result;
}

}  // namespace

WeightResult boneHeatWeights(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                             Progress& progress) {
  checkWeightArguments(mesh, bones, options);
  WeightResult result;

  progress.step("surface and bones in sight");
  Index pieceCount = 0;
  const std::vector<Index> piece = vertexComponents(mesh, &pieceCount);
  if (std::optional<WeightResult> parts = jointedPieceWeights(mesh, piece, pieceCount, bones, options, progress)) {
    return std::move(*parts);
  }
  HeatProblem problem = setUp({}, mesh, bones, piece, options.jointOf);
  if (!problem.sawBone) {
    result.warnings.add("no-bone-in-sight", "no bone is in sight of any vertex, so each vertex took the nearest bone");
  }

  progress.step("factorise");
  problem.solver->factorize(problem.sources);

  progress.step("solve");
  InfluenceTable table = problem.solver->strongest(options.maxInfluences);
  problem.solver.reset();

  progress.step("bridge pieces");
  std::optional<PieceRules> rules;
  if (mayBeOfParts(pieceCount, bones, options.pieces)) {
    rules.emplace(mesh, bones, piece, pieceCount, problem.sources.pull);
    rules->classify(finish(table));
    rules->dropHardlySeen(table);
  }
  result.bridged = bridgeBare(mesh, table);
  result.weights = finish(table);
  if (options.pieces == PieceMode::kRigid) {
    bindWholePieces(mesh, result);
  } else if (rules) {
    rules->bindRigid(result.weights, result.warnings);
  }
  return result;
}

Eigen::MatrixXd fullBoneHeat(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones) {
  checkWeightArguments(mesh, bones, {});
  const std::vector<Index> piece = vertexComponents(mesh);
  HeatProblem problem = setUp(heat, mesh, bones, piece, {});
  problem.solver->factorize(problem.sources);
  Index jointCount = 0;
  for (const Bone& bone : bones) jointCount = std::max(jointCount, bone.joint + 1);
  return problem.solver->all(jointCount);
}

}  // namespace limber
