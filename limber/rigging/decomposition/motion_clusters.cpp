#include "limber/rigging/decomposition/motion_clusters.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "limber/core/parallel.h"
#include "limber/rigging/decomposition/motion_fit.h"

namespace limber {

namespace {

constexpr int kRoundsASplit = 4;       // of assigning and fitting; more change little (Le, Deng 2014 take as many)
constexpr double kFitsAlready = 1e-6;  // of the diagonal: a root mean square that is single precision's rounding
constexpr std::size_t kBlocksAssigned = 16;

// The motions in single precision, as assigning reads them.
std::vector<std::array<float, 12>> packed(const BoneMotions& motions) {
  std::vector<std::array<float, 12>> result(motions.motions.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t k = 0; k < 12; ++k) {
      result[i][k] = static_cast<float>(motions.motions[i](static_cast<int>(k / 4), static_cast<int>(k % 4)));
    }
  }
  return result;
}

using LaneValues = std::array<float, VertexSequence::kLanes>;

// Squared distances, summed over the frames, of eight points to where a motion takes them.
LaneValues distancesTo(const VertexSequence& sequence, Index block, const std::array<LaneValues, 3>& rest,
                       const std::array<float, 12>* motion) {
  LaneValues sums = {};
  for (Index f = 0; f < sequence.frameCount(); ++f) {
    const float* moved = sequence.frameOf(block, f);
    for (std::size_t r = 0; r < 3; ++r) {
      const float* m = motion[f].data() + 4 * r;
      for (std::size_t l = 0; l < VertexSequence::kLanes; ++l) {
        const float d =
            m[0] * rest[0][l] + m[1] * rest[1][l] + m[2] * rest[2][l] + m[3] - moved[r * VertexSequence::kLanes + l];
        sums[l] += d * d;
      }
    }
  }
  return sums;
}

void assign(const VertexSequence& sequence, MotionClusters& clusters) {
  const std::vector<std::array<float, 12>> motions = packed(clusters.motions);
  const Index count = clusters.motions.boneCount();
  parallelFor(sequence.blockCount(), kBlocksAssigned, [&](std::size_t begin, std::size_t end) {
    for (auto block = static_cast<Index>(begin); block < end; ++block) {
      const Index first = block * VertexSequence::kLanes, points = sequence.pointsIn(block);
      std::array<LaneValues, 3> rest = {};
      for (Index l = 0; l < points; ++l) {
        for (Index i = 0; i < 3; ++i) rest[i][l] = sequence.rest[first + l][i];
      }
      LaneValues best;
      best.fill(std::numeric_limits<float>::infinity());
      for (Index c = 0; c < count; ++c) {
        const LaneValues distances =
            distancesTo(sequence, block, rest, &motions[std::size_t{c} * sequence.frameCount()]);
        for (Index l = 0; l < points; ++l) {
          if (!(distances[l] < best[l])) continue;
          best[l] = distances[l];
          clusters.clusterOf[first + l] = c;
          clusters.errors[first + l] = distances[l];
        }
      }
    }
  });
}

SkinWeights hardWeights(const std::vector<Index>& clusterOf) {
  SkinWeights weights;
  weights.slots = 1;
  weights.joints = clusterOf;
  weights.weights.assign(clusterOf.size(), 1.0f);
  return weights;
}

// Clusters without a point are taken out.
void dropEmpty(MotionClusters& clusters) {
  std::vector<bool> isUsed(clusters.motions.boneCount(), false);
  for (const Index c : clusters.clusterOf) isUsed[c] = true;
  const std::vector<Index> renumbered = compactBones(clusters.motions, isUsed);
  for (Index& c : clusters.clusterOf) c = renumbered[c];
}

struct ClusterError {
  Index cluster = 0, points = 0, worst = 0;
  double sum = 0, largest = -1;
};

std::vector<ClusterError> errorsOf(const MotionClusters& clusters) {
  std::vector<ClusterError> errors(clusters.motions.boneCount());
  for (Index v = 0; v < clusters.clusterOf.size(); ++v) {
    ClusterError& error = errors[clusters.clusterOf[v]];
    error.cluster = clusters.clusterOf[v];
    ++error.points;
    error.sum += clusters.errors[v];
    if (clusters.errors[v] <= error.largest) continue;
    error.largest = clusters.errors[v];
    error.worst = v;
  }
  return errors;
}

// Seeds new motions where clusters fit worst; false where all fit.
bool split(const VertexSequence& sequence, Index count, MotionClusters& clusters) {
  std::vector<ClusterError> errors = errorsOf(clusters);
  std::stable_sort(errors.begin(), errors.end(),
                   [](const ClusterError& a, const ClusterError& b) { return a.sum > b.sum; });
  double mean = 0;
  for (const ClusterError& error : errors) mean += error.sum / static_cast<double>(errors.size());
  const Index before = clusters.motions.boneCount();
  for (const ClusterError& error : errors) {
    const double fits = kFitsAlready * kFitsAlready * error.points * sequence.frameCount();
    if (clusters.motions.boneCount() >= count || error.sum < mean || error.sum <= fits || error.points < 2) break;
    const auto ofCluster = [&](Index v) { return clusters.clusterOf[v] == error.cluster; };
    appendMotionOf(sequence, nearestPoints(sequence, error.worst, seedPoints(error.points), ofCluster),
                   clusters.motions);
  }
  return clusters.motions.boneCount() > before;
}

}  // namespace

std::vector<Index> nearestPoints(const VertexSequence& sequence, Index seed, std::size_t count,
                                 const std::function<bool(Index)>& isAllowed) {
  struct Near {
    float distance;
    Index point;
    bool operator<(const Near& other) const {
      return distance != other.distance ? distance < other.distance : point < other.point;
    }
  };
  std::vector<Near> nearest;  // a heap, the farthest first
  for (Index v = 0; v < sequence.pointCount(); ++v) {
    if (v != seed && !isAllowed(v)) continue;
    const Near near{v == seed ? -1 : (sequence.rest[v] - sequence.rest[seed]).squaredNorm(), v};
    if (nearest.size() == count) {
      if (!(near < nearest.front())) continue;
      std::pop_heap(nearest.begin(), nearest.end());
      nearest.pop_back();
    }
    nearest.push_back(near);
    std::push_heap(nearest.begin(), nearest.end());
  }
  std::sort_heap(nearest.begin(), nearest.end());
  std::vector<Index> points;
  points.reserve(nearest.size());
  for (const Near& near : nearest) points.push_back(near.point);
  return points;
}

MotionClusters motionClusters(const VertexSequence& sequence, Index count, Progress& progress) {
  MotionClusters clusters;
  clusters.clusterOf.assign(sequence.pointCount(), 0);
  clusters.errors.assign(sequence.pointCount(), 0);
  clusters.motions.frameCount = sequence.frameCount();
  std::vector<Index> all(sequence.pointCount());
  std::iota(all.begin(), all.end(), Index{0});
  appendMotionOf(sequence, all, clusters.motions);
  assign(sequence, clusters);
  // A seed may lose all of its points; after as many rounds as there are clusters to find it is enough.
  for (Index round = 0; round < count && clusters.motions.boneCount() < count; ++round) {
    progress.update(static_cast<double>(clusters.motions.boneCount()) / count);
    if (!split(sequence, count, clusters)) break;
    for (int i = 0; i < kRoundsASplit; ++i) {
      assign(sequence, clusters);
      dropEmpty(clusters);
      fitMotions(sequence, hardWeights(clusters.clusterOf), clusters.motions);
    }
    assign(sequence, clusters);
    dropEmpty(clusters);
  }
  return clusters;
}

}  // namespace limber
