#include "limber/skinning/bone_heat.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "limber/core/known_error.h"
#include "limber/core/parallel.h"
#include "limber/mesh/components.h"
#include "limber/skinning/heat_solver.h"
#include "limber/skinning/influence_table.h"
#include "limber/skinning/jointed_pieces.h"
#include "limber/skinning/piece_rules.h"

namespace limber {

namespace {

constexpr Index kMostInfluences = 8;
constexpr std::size_t kRange = 1024;  // vertices of one parallel piece of work

void checkArguments(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options) {
  if (bones.empty()) throw Error(ErrorCode::kBadArgument, "there is no bone to take weights from");
  if (mesh.triangles.empty()) {
    throw KnownError(ErrorKind::kNoSurface, {ErrorCode::kBadArgument, "the mesh has no triangle"});
  }
  if (options.maxInfluences < 1 || options.maxInfluences > kMostInfluences) {
    throw Error(ErrorCode::kBadArgument, "a vertex can keep 1 to 8 influences", {}, "choose --max-influences 1 to 8");
  }
}

// Handles are spheres; they move what is round them, whatever it is a part of.
bool allSegments(std::span<const Bone> bones) {
  return std::all_of(bones.begin(), bones.end(), [](const Bone& bone) { return bone.radius == 0; });
}

bool anySource(const HeatSources& sources) {
  return !sources.joints.empty();
}

// The factored heat equation, and where heat enters it.
struct HeatProblem {
  std::unique_ptr<HeatSolver> solver;
  HeatSources sources;
  bool sawBone = true;
};

HeatProblem setUp(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones,
                  const std::vector<Index>& piece) {
  HeatProblem problem;
  parallelInvoke([&] { problem.solver = std::make_unique<HeatSolver>(robustLaplacian(mesh, piece)); },
                 [&] {
                   const Bvh bvh(mesh);
                   problem.sources = findHeatSources(mesh, bones, &bvh, heat.sources);
                 });
  if (!anySource(problem.sources)) {
    problem.sawBone = false;
    problem.sources = findHeatSources(mesh, bones, nullptr, heat.sources);
  }
  return problem;
}

// The strongest influences of every vertex; rows of vertices that no heat reaches are empty.
InfluenceTable solveStrongest(const HeatSolver& solver, Index vertexCount, Index slots) {
  InfluenceTable byPlace(vertexCount, slots);
  solver.solve([&](std::span<const Index> joints, const double* weights) {
    for (std::size_t row = 0; row < vertexCount; ++row) {
      for (std::size_t k = 0; k < joints.size(); ++k) {
        byPlace.offer(row, joints[k], static_cast<float>(weights[row * HeatSolver::kBlock + k]));
      }
    }
  });
  InfluenceTable result(vertexCount, slots);
  parallelFor(vertexCount, kRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Index row = solver.place(static_cast<Index>(v));
      for (Index k = 0; k < slots; ++k) result.offer(v, byPlace.jointsOf(row)[k], byPlace.weightsOf(row)[k]);
    }
  });
  return result;
}

// Joints of the three corners with their weights interpolated.
void interpolate(const InfluenceTable& table, const Triangle& triangle, const Vec3& barycentric, std::size_t row,
                 InfluenceTable& result) {
  struct Influence {
    Index joint;
    double weight;
  };
  std::array<Influence, 3 * kMostInfluences> all;
  std::size_t count = 0;
  for (int corner = 0; corner < 3; ++corner) {
    for (Index k = 0; k < table.slots(); ++k) {
      const double weight = barycentric[corner] * table.weightsOf(triangle[corner])[k];
      if (!(weight > 0)) continue;
      const Index joint = table.jointsOf(triangle[corner])[k];
      const auto same =
          std::find_if(all.begin(), all.begin() + count, [&](const Influence& i) { return i.joint == joint; });
      if (same != all.begin() + count) {
        same->weight += weight;
      } else {
        all[count++] = {joint, weight};
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) result.offer(row, all[i].joint, static_cast<float>(all[i].weight));
}

// Gives rows without weights those of the nearest surface that has some. Returns these rows.
std::vector<Index> bridge(const TriMesh& mesh, InfluenceTable& table) {
  std::vector<Index> bare;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (!(table.weightsOf(v)[0] > 0)) bare.push_back(v);
  }
  if (bare.empty()) return bare;
  std::vector<Index> clothed;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (std::all_of(triangle.begin(), triangle.end(), [&](Index v) { return table.weightsOf(v)[0] > 0; })) {
      clothed.push_back(t);
    }
  }
  const Bvh bvh(mesh, clothed);
  const InfluenceTable source = table;
  parallelFor(bare.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePoint nearest = bvh.nearestPoint(mesh.position(bare[i]));
      interpolate(source, mesh.triangles[nearest.triangle], nearest.weights, bare[i], table);
    }
  });
  return bare;
}

double faded(double weight, const BoneHeatOptions& heat) {
  if (weight >= heat.fadeFrom) return weight;
  if (weight <= heat.fadeTo) return 0;
  return heat.fadeFrom * (weight - heat.fadeTo) / (heat.fadeFrom - heat.fadeTo);
}

SkinWeights finish(const InfluenceTable& table, const BoneHeatOptions& heat) {
  SkinWeights result;
  result.slots = table.slots();
  result.joints.assign(table.vertexCount() * table.slots(), 0);
  result.weights.assign(table.vertexCount() * table.slots(), 0.0f);
  parallelFor(table.vertexCount(), kRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto joints = table.jointsOf(v);
      const auto weights = table.weightsOf(v);
      std::array<double, kMostInfluences> kept = {};
      double sum = 0;
      for (Index k = 0; k < table.slots(); ++k) sum += kept[k] = faded(weights[k], heat);
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
  return boneHeatWeightsWith(BoneHeatOptions{}, mesh, bones, options, progress);
}

WeightResult boneHeatWeightsWith(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones,
                                 const WeightOptions& options, Progress& progress) {
  checkArguments(mesh, bones, options);
  WeightResult result;

  progress.step("surface and bones in sight");
  Index pieceCount = 0;
  const std::vector<Index> piece = vertexComponents(mesh, &pieceCount);
  const bool mayBeOfParts = options.pieces != PieceMode::kSoft && pieceCount > 1 && allSegments(bones);
  if (mayBeOfParts) {
    if (const std::optional<PieceBinding> parts = jointsOfPieces(mesh, piece, pieceCount, bones, progress)) {
      result.weights.slots = options.maxInfluences;
      result.weights.joints.resize(piece.size() * options.maxInfluences);
      result.weights.weights.resize(result.weights.joints.size());
      bindPieces(*parts, piece, result.weights, result.warnings);
      return result;
    }
  }
  HeatProblem problem = setUp(heat, mesh, bones, piece);
  if (!problem.sawBone) {
    result.warnings.add("no-bone-in-sight", "no bone is in sight of any vertex, so each vertex took the nearest bone");
  }

  progress.step("factorise");
  problem.solver->factorize(problem.sources);

  progress.step("solve");
  InfluenceTable table = solveStrongest(*problem.solver, mesh.vertexCount(), options.maxInfluences);
  problem.solver.reset();

  progress.step("bridge pieces");
  std::optional<PieceRules> rules;
  if (mayBeOfParts || options.pieces == PieceMode::kRigid) {
    rules.emplace(mesh, bones, piece, pieceCount, problem.sources.pull);
    rules->classify(finish(table, heat));
    rules->dropHardlySeen(table);
  }
  result.bridged = bridge(mesh, table);
  result.weights = finish(table, heat);
  if (rules) rules->bindRigid(options.pieces, result.weights, result.warnings);
  return result;
}

Eigen::MatrixXd fullBoneHeat(const BoneHeatOptions& heat, const TriMesh& mesh, std::span<const Bone> bones) {
  checkArguments(mesh, bones, {});
  HeatProblem problem = setUp(heat, mesh, bones, vertexComponents(mesh));
  problem.solver->factorize(problem.sources);
  Index jointCount = 0;
  for (const Bone& bone : bones) jointCount = std::max(jointCount, bone.joint + 1);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(mesh.vertexCount(), jointCount);
  problem.solver->solve([&](std::span<const Index> joints, const double* weights) {
    for (Index v = 0; v < mesh.vertexCount(); ++v) {
      const std::size_t row = problem.solver->place(v);
      for (std::size_t k = 0; k < joints.size(); ++k) result(v, joints[k]) = weights[row * HeatSolver::kBlock + k];
    }
  });
  return result;
}

}  // namespace limber
