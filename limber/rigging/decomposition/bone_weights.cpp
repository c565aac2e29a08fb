#include "limber/rigging/decomposition/bone_weights.h"

#include <algorithm>
#include <array>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/rigging/decomposition/convex_weights.h"

namespace limber {

namespace {

constexpr std::size_t kBlocksFitted = 8;
constexpr Index kLanes = VertexSequence::kLanes;
constexpr float kMinWeight = 1e-4f;  // lighter influences are rounding of the frames

// Sums over the frames of M_a' * M_b for all pairs of bones: what a product of two motions of one point is made of.
class MotionProducts {
 public:
  explicit MotionProducts(const BoneMotions& motions)
      : bones_(motions.boneCount()), products_(std::size_t{bones_} * bones_) {
    parallelFor(bones_, 1, [&](std::size_t begin, std::size_t end) {
      for (auto a = static_cast<Index>(begin); a < end; ++a) {
        for (Index b = a; b < bones_; ++b) {
          Mat4 sum = Mat4::Zero();
          for (Index f = 0; f < motions.frameCount; ++f) sum += motions.of(a)[f].transpose() * motions.of(b)[f];
          products_[std::size_t{a} * bones_ + b] = sum;
        }
      }
    });
  }

  // Of where the bones take the point p = (x, y, z, 1).
  double of(Index a, Index b, const Vec4& p) const {
    return p.dot(products_[std::size_t{std::min(a, b)} * bones_ + std::max(a, b)] * p);
  }

 private:
  Index bones_;
  std::vector<Mat4> products_;
};

// Where the eight points of a block are, as doubles, and what the bones' motions make of them.
class BlockSums {
 public:
  BlockSums(Index frames, Index bones) : moved_(std::size_t{frames} * VertexSequence::kFrameSize), sums_(bones) {}

  void read(const VertexSequence& sequence, const BoneMotions& motions, Index block) {
    const float* stored = sequence.frameOf(block, 0);
    for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = stored[i];
    squares_.fill(0);
    for (std::size_t i = 0; i < moved_.size(); ++i) squares_[i % kLanes] += moved_[i] * moved_[i];
    for (Index b = 0; b < motions.boneCount(); ++b) {
      for (int c = 0; c < 4; ++c) sums_[b][c] = column(motions.of(b), motions.frameCount, c);
    }
  }

  // Sums over the frames: of the point's square, and of its product with where a bone takes p.
  double square(Index lane) const { return squares_[lane]; }
  double product(Index bone, Index lane, const Vec4& p) const {
    const Columns& columns = sums_[bone];
    return columns[0][lane] * p[0] + columns[1][lane] * p[1] + columns[2][lane] * p[2] + columns[3][lane];
  }

 private:
  using Lanes = std::array<double, kLanes>;
  using Columns = std::array<Lanes, 4>;

  Lanes column(const RigidMotion* motion, Index frames, int c) const {
    Lanes sums = {};
    const double* moved = moved_.data();
    for (Index f = 0; f < frames; ++f, moved += VertexSequence::kFrameSize) {
      const double x = motion[f](0, c), y = motion[f](1, c), z = motion[f](2, c);
      for (std::size_t l = 0; l < kLanes; ++l) {
        sums[l] += x * moved[l] + y * moved[kLanes + l] + z * moved[2 * kLanes + l];
      }
    }
    return sums;
  }

  std::vector<double> moved_;
  Lanes squares_ = {};
  std::vector<Columns> sums_;
};

// The bones that a point is weighed against.
struct Candidates {
  std::array<Index, kMaxCandidates> bones = {};
  Index count = 0;

  bool has(Index bone) const { return std::find(bones.begin(), bones.begin() + count, bone) != bones.begin() + count; }
};

class WeightFit {
 public:
  WeightFit(const VertexSequence& sequence, const BoneMotions& motions, Index maxInfluences, const SkinWeights& before)
      : sequence_(sequence), motions_(motions), before_(before), maxInfluences_(maxInfluences), products_(motions) {
    const std::size_t points = sequence.pointCount();
    result_.weights.slots = maxInfluences;
    result_.weights.joints.assign(points * maxInfluences, 0);
    result_.weights.weights.assign(points * maxInfluences, 0.0f);
    result_.errors.assign(points, 0);
  }

  FittedWeights run() {
    parallelFor(sequence_.blockCount(), kBlocksFitted, [&](std::size_t begin, std::size_t end) {
      BlockSums sums(motions_.frameCount, motions_.boneCount());
      std::vector<std::pair<double, Index>> alone(motions_.boneCount());
      for (auto block = static_cast<Index>(begin); block < end; ++block) {
        sums.read(sequence_, motions_, block);
        for (Index lane = 0; lane < sequence_.pointsIn(block); ++lane) fit(sums, block, lane, alone);
      }
    });
    return std::move(result_);
  }

 private:
  void fit(const BlockSums& sums, Index block, Index lane, std::vector<std::pair<double, Index>>& alone) {
    const Index v = block * kLanes + lane;
    const Vec4 p = sequence_.rest[v].cast<double>().homogeneous();
    for (Index b = 0; b < motions_.boneCount(); ++b) {
      alone[b] = {products_.of(b, b, p) - 2 * sums.product(b, lane, p), b};
    }
    const Candidates candidates = candidatesOf(v, alone);
    WeightProblem problem;
    problem.gram.resize(candidates.count, candidates.count);
    problem.linear.resize(candidates.count);
    for (Index i = 0; i < candidates.count; ++i) {
      problem.linear[i] = sums.product(candidates.bones[i], lane, p);
      for (Index j = 0; j <= i; ++j) {
        problem.gram(i, j) = problem.gram(j, i) = products_.of(candidates.bones[i], candidates.bones[j], p);
      }
    }
    const WeightProblem::Vector weights = sparseConvexWeights(problem, maxInfluences_, startOf(v, candidates));
    result_.errors[v] = std::max(0.0, problem.value(weights) + sums.square(lane));
    store(v, candidates, weights);
  }

  Candidates candidatesOf(Index v, std::vector<std::pair<double, Index>>& alone) const {
    Candidates candidates;
    if (before_.slots > 0) {
      for (Index i = 0; i < before_.slots; ++i) {
        if (before_.weightsOf(v)[i] > 0) candidates.bones[candidates.count++] = before_.jointsOf(v)[i];
      }
    }
    const std::size_t tried = std::min<std::size_t>(alone.size(), kMaxCandidates);
    std::partial_sort(alone.begin(), alone.begin() + static_cast<std::ptrdiff_t>(tried), alone.end());
    for (std::size_t i = 0; i < tried && candidates.count < kMaxCandidates; ++i) {
      if (!candidates.has(alone[i].second)) candidates.bones[candidates.count++] = alone[i].second;
    }
    return candidates;
  }

  // The weights before: the bones that had one are the first candidates, in their order.
  WeightProblem::Vector startOf(Index v, const Candidates& candidates) const {
    WeightProblem::Vector start = WeightProblem::Vector::Zero(candidates.count);
    Index at = 0;
    for (Index i = 0; i < before_.slots; ++i) {
      if (before_.weightsOf(v)[i] > 0) start[at++] = before_.weightsOf(v)[i];
    }
    return start;
  }

  // Strongest first.
  void store(Index v, const Candidates& candidates, const WeightProblem::Vector& weights) {
    std::array<std::pair<float, Index>, kMaxCandidates> used;
    std::size_t count = 0;
    float sum = 0;
    for (Index i = 0; i < candidates.count; ++i) {
      const auto weight = static_cast<float>(weights[i]);
      if (weight < kMinWeight) continue;
      used[count++] = {-weight, candidates.bones[i]};
      sum += weight;
    }
    std::sort(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(count));
    const std::size_t at = std::size_t{v} * maxInfluences_;
    for (std::size_t i = 0; i < count; ++i) {
      result_.weights.joints[at + i] = used[i].second;
      result_.weights.weights[at + i] = -used[i].first / sum;
    }
  }

  const VertexSequence& sequence_;
  const BoneMotions& motions_;
  const SkinWeights& before_;
  Index maxInfluences_;
  MotionProducts products_;
  FittedWeights result_;
};

}  // namespace

FittedWeights fitWeights(const VertexSequence& sequence, const BoneMotions& motions, Index maxInfluences,
                         const SkinWeights& before) {
  if (maxInfluences < 1 || maxInfluences > kMaxInfluences || before.slots > kMaxInfluences) {
    throw Error(ErrorCode::kBadArgument, "points can follow 1 to 8 bones");
  }
  return WeightFit(sequence, motions, maxInfluences, before).run();
}

}  // namespace limber
