#include "limber/evaluate/skin/weight_metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/deform/linear_blend.h"
#include "limber/evaluate/pairing.h"
#include "limber/evaluate/skin/random_pose.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

namespace {

constexpr Index kSlots = 4;
constexpr float kInfluence = 1.0f / 256;
constexpr int kPoses = 20;
constexpr std::uint64_t kPoseSeed = 1;
constexpr double kMaxTurn = 30 * kDegree;

float weightOf(const SkinWeights& weights, Index vertex, Index joint) {
  float sum = 0;
  for (Index slot = 0; slot < weights.slots; ++slot) {
    if (weights.jointsOf(vertex)[slot] == joint) sum += weights.weightsOf(vertex)[slot];
  }
  return sum;
}

bool isUnweighted(const SkinWeights& weights, Index vertex) {
  const auto of = weights.weightsOf(vertex);
  return std::none_of(of.begin(), of.end(), [](float w) { return w > 0; });
}

// The two skins over the same vertices and joints: the paired vertices of the truth, the truth's joints first and
// behind them those of the result that have no counterpart.
struct PairedSkins {
  std::vector<Vec3f> positions;
  SkinWeights result, truth;
};

void appendVertex(const SkinWeights& from, Index vertex, SkinWeights& to) {
  to.slots = kSlots;
  to.joints.insert(to.joints.end(), from.jointsOf(vertex).begin(), from.jointsOf(vertex).end());
  to.weights.insert(to.weights.end(), from.weightsOf(vertex).begin(), from.weightsOf(vertex).end());
}

SkinWeights withTruthJoints(SkinWeights weights, const Skeleton& result, const Skeleton& truth, Index& unpaired) {
  const std::vector<Index> partner = pairJoints(result, truth);
  std::vector<bool> counted(result.jointCount(), false);
  for (std::size_t i = 0; i < weights.joints.size(); ++i) {
    const Index joint = weights.joints[i];
    if (weights.weights[i] > 0 && partner[joint] == kNoIndex && !counted[joint]) {
      counted[joint] = true;
      ++unpaired;
    }
    weights.joints[i] = partner[joint] != kNoIndex ? partner[joint] : truth.jointCount() + joint;
  }
  return weights;
}

PairedSkins pairSkins(const SkinnedModel& result, const SkinnedModel& truth, WeightComparison& report) {
  const SkinWeights truthWeights = strongestFour(truth.weights);
  const SkinWeights resultWeights =
      withTruthJoints(strongestFour(result.weights), result.skeleton, truth.skeleton, report.unpairedJoints);
  const VertexPairs pairs = pairVertices(truth.mesh, result.mesh);
  report.orderKept = pairs.orderKept;
  PairedSkins skins;
  for (Index v = 0; v < truth.mesh.vertexCount(); ++v) {
    if (pairs.partner[v] == kNoIndex) {
      ++report.unpairedVertices;
      continue;
    }
    skins.positions.push_back(truth.mesh.positions[v]);
    appendVertex(truthWeights, v, skins.truth);
    appendVertex(resultWeights, pairs.partner[v], skins.result);
  }
  report.vertices = static_cast<Index>(skins.positions.size());
  if (report.vertices == 0) {
    throw Error(ErrorCode::kBadData, "no vertex of the result lies on one of the truth", {},
                "compare files of the same model");
  }
  return skins;
}

void measureInfluences(const PairedSkins& skins, WeightComparison& report) {
  std::size_t inResult = 0, inTruth = 0, inBoth = 0;
  double sum = 0;
  for (Index v = 0; v < report.vertices; ++v) {
    sum += weightDifference(skins.result, v, skins.truth, v);
    report.unweighted += isUnweighted(skins.result, v);
    report.truthUnweighted += isUnweighted(skins.truth, v);
    for (Index slot = 0; slot < kSlots; ++slot) {
      inTruth += skins.truth.weightsOf(v)[slot] > kInfluence;
      if (!(skins.result.weightsOf(v)[slot] > kInfluence)) continue;
      ++inResult;
      inBoth += weightOf(skins.truth, v, skins.result.jointsOf(v)[slot]) > kInfluence;
    }
  }
  report.l1 = sum / report.vertices;
  if (inResult > 0) report.precision = static_cast<double>(inBoth) / static_cast<double>(inResult);
  if (inTruth > 0) report.recall = static_cast<double>(inBoth) / static_cast<double>(inTruth);
}

// Between the ranks, as common tools do: rank 0.95 (n - 1). Reorders `values`.
double percentile95(std::vector<double>& values) {
  const double rank = 0.95 * static_cast<double>(values.size() - 1);
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), low, values.end());
  if (low + 1 == values.end()) return *low;
  const double high = *std::min_element(low + 1, values.end());
  return *low + (rank - std::floor(rank)) * (high - *low);
}

// Deforms by linear blend. Joints that the skeleton does not have leave what they hold where it is.
std::vector<Vec3f> deformed(const PairedSkins& skins, const SkinWeights& weights, std::span<const Affine> transforms) {
  std::vector<float> scratch(linearBlendScratch(skins.positions.size(), static_cast<Index>(transforms.size())));
  std::vector<Vec3f> positions(skins.positions.size());
  linearBlend({skins.positions, {}, weights, transforms, {}}, {positions, {}}, scratch);
  return positions;
}

void measureDeformation(const PairedSkins& skins, const Skeleton& skeleton, Index resultJoints,
                        WeightComparison& report) {
  Box box;
  for (const Vec3f& position : skins.positions) box.add(position.cast<double>());
  const double percent = box.diagonal() > 0 ? 100 / box.diagonal() : 0;
  SplitMix random(kPoseSeed);
  for (int pose = 0; pose < kPoses; ++pose) {
    std::vector<Affine> transforms = skinTransforms(skeleton, randomPose(skeleton, kMaxTurn, random));
    transforms.resize(transforms.size() + resultJoints, Affine::Identity());
    const std::vector<Vec3f> a = deformed(skins, skins.result, transforms);
    const std::vector<Vec3f> b = deformed(skins, skins.truth, transforms);
    std::vector<double> distances(a.size());
    for (std::size_t v = 0; v < a.size(); ++v) distances[v] = percent * (a[v] - b[v]).cast<double>().norm();
    report.deformMean += std::accumulate(distances.begin(), distances.end(), 0.0) / report.vertices / kPoses;
    report.deformP95 += percentile95(distances) / kPoses;
  }
}

// The welded vertex has the weights of the first vertex at its position.
void measureSmoothness(const SkinnedModel& truth, const PairedSkins& skins, WeightComparison& report) {
  if (report.unpairedVertices > 0) return;  // vertices of the skins are then not those of the triangles
  const PreparedMesh welded = prepareMesh(truth.mesh.positions, truth.mesh.triangles, truth.stored);
  std::vector<Index> sourceVertex(welded.mesh.vertexCount(), kNoIndex);
  for (Index v = truth.mesh.vertexCount(); v-- > 0;) sourceVertex[welded.weldedVertex[v]] = v;
  const std::vector<VertexPair> edges = surfaceEdges(welded.mesh).edges;
  for (const auto& [a, b] : edges) {
    report.smoothness += weightDifference(skins.result, sourceVertex[a], skins.result, sourceVertex[b]);
    report.truthSmoothness += weightDifference(skins.truth, sourceVertex[a], skins.truth, sourceVertex[b]);
  }
  report.smoothness /= static_cast<double>(edges.size());
  report.truthSmoothness /= static_cast<double>(edges.size());
}

}  // namespace

std::vector<bool> weightedJoints(const SkinWeights& weights, Index jointCount) {
  std::vector<bool> hasWeight(jointCount, false);
  for (std::size_t i = 0; i < weights.joints.size(); ++i) {
    if (weights.weights[i] > 0) hasWeight[weights.joints[i]] = true;
  }
  return hasWeight;
}

Index countWeightedJoints(const SkinWeights& weights, Index jointCount) {
  const std::vector<bool> hasWeight = weightedJoints(weights, jointCount);
  return static_cast<Index>(std::count(hasWeight.begin(), hasWeight.end(), true));
}

double weightDifference(const SkinWeights& a, Index va, const SkinWeights& b, Index vb) {
  double sum = 0;
  for (Index slot = 0; slot < a.slots; ++slot) {
    const float weight = a.weightsOf(va)[slot];
    if (weight > 0) sum += std::abs(weight - weightOf(b, vb, a.jointsOf(va)[slot]));
  }
  for (Index slot = 0; slot < b.slots; ++slot) {
    const float weight = b.weightsOf(vb)[slot];
    if (weight > 0 && weightOf(a, va, b.jointsOf(vb)[slot]) == 0) sum += weight;
  }
  return sum;
}

SkinWeights strongestFour(const SkinWeights& weights) {
  SkinWeights result;
  result.slots = kSlots;
  result.joints.assign(std::size_t{weights.vertexCount()} * kSlots, 0);
  result.weights.assign(std::size_t{weights.vertexCount()} * kSlots, 0.0f);
  std::vector<std::pair<float, Index>> sorted;
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    sorted.clear();
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const float weight = weights.weightsOf(v)[slot];
      if (weight > 0 && std::isfinite(weight)) sorted.emplace_back(weight, weights.jointsOf(v)[slot]);
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    if (sorted.size() > kSlots) sorted.resize(kSlots);
    double sum = 0;
    for (const auto& influence : sorted) sum += influence.first;
    for (std::size_t slot = 0; slot < sorted.size(); ++slot) {
      result.joints[std::size_t{v} * kSlots + slot] = sorted[slot].second;
      result.weights[std::size_t{v} * kSlots + slot] = static_cast<float>(sorted[slot].first / sum);
    }
  }
  return result;
}

WeightComparison compareWeights(const SkinnedModel& result, const SkinnedModel& truth) {
  WeightComparison report;
  report.joints = truth.skeleton.jointCount();
  report.usedJoints = countWeightedJoints(truth.weights, report.joints);
  const PairedSkins skins = pairSkins(result, truth, report);
  measureInfluences(skins, report);
  measureDeformation(skins, truth.skeleton, result.skeleton.jointCount(), report);
  measureSmoothness(truth, skins, report);
  return report;
}

WeightComparison compareWeights(const Character& result, const Character& truth) {
  return compareWeights(readSkinnedModel(result), readSkinnedModel(truth));
}

}  // namespace limber
