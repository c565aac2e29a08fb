#include "limber/rigging/decomposition/skin_decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/rigging/decomposition/bone_weights.h"
#include "limber/rigging/decomposition/motion_clusters.h"
#include "limber/rigging/decomposition/motion_fit.h"

namespace limber {

namespace {

constexpr double kMinFraction = 1;   // sum of squared weights: a bone with less than one point of its own is reseeded
constexpr int kLastIterations = 5;   // in which no bone is reseeded, so that all settle
constexpr double kConverged = 1e-4;  // relative fall of the error below which nothing more is to be had
constexpr double kWorthMore = 0.9;   // of the error with half as many bones: more bones are not worth it

// A sequence about the origin with a box of unit diagonal at rest, every frame about its own middle; and the inverse.
class Centred {
 public:
  explicit Centred(VertexSequence& sequence) {
    Box box;
    for (const Vec3f& p : sequence.rest) box.add(p.cast<double>());
    diagonal_ = box.diagonal();
    if (!(diagonal_ > 0) || !std::isfinite(diagonal_)) {
      throw Error(ErrorCode::kBadData, "the mesh at rest has no size", {}, "all of its vertices are at one place");
    }
    middle_ = box.center();
    for (Vec3f& p : sequence.rest) p = ((p.cast<double>() - middle_) / diagonal_).cast<float>();
    middles_.assign(sequence.frameCount(), Vec3::Zero());
    parallelFor(sequence.frameCount(), 1, [&](std::size_t begin, std::size_t end) {
      for (auto f = static_cast<Index>(begin); f < end; ++f) centre(sequence, f);
    });
    for (const Vec3& middle : middles_) {
      if (!middle.allFinite()) {
        throw Error(ErrorCode::kBadData,
                    "a vertex moves to a place that is not finite, or farther than can be computed");
      }
    }
  }

  void restore(BoneMotions& motions) const {
    for (Index b = 0; b < motions.boneCount(); ++b) {
      for (Index f = 0; f < motions.frameCount; ++f) {
        RigidMotion& motion = motions.of(b)[f];
        motion.col(3) = diagonal_ * motion.col(3) + middles_[f] - motion.leftCols<3>() * middle_;
      }
    }
  }

 private:
  // The middle is not finite where a position, or its square in diagonals, is not.
  void centre(VertexSequence& sequence, Index f) {
    Vec3 middle = Vec3::Zero();
    for (Index v = 0; v < sequence.pointCount(); ++v) middle += sequence.at(v, f).cast<double>();
    middle /= sequence.pointCount();
    middles_[f] = middle;
    for (Index v = 0; v < sequence.pointCount(); ++v) {
      const Vec3f position = ((sequence.at(v, f).cast<double>() - middle) / diagonal_).cast<float>();
      if (!std::isfinite(position.squaredNorm())) middles_[f].fill(std::numeric_limits<double>::quiet_NaN());
      sequence.set(v, f, position);
    }
  }

  double diagonal_ = 0;
  Vec3 middle_ = Vec3::Zero();
  std::vector<Vec3> middles_;  // #frames
};

std::vector<double> jointWeightsOf(const SkinWeights& weights, Index bones) {
  std::vector<double> fractions(bones, 0);
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    fractions[weights.joints[i]] += double{weights.weights[i]} * weights.weights[i];
  }
  return fractions;
}

double rootMeanSquare(const VertexSequence& sequence, const std::vector<double>& errors) {
  double sum = 0;
  for (const double error : errors) sum += error;
  return std::sqrt(sum / sequence.pointCount() / sequence.frameCount());
}

// Bones with next to no weight take the motion of the neighbourhood that fits worst.
bool reseed(const VertexSequence& sequence, FittedWeights& fitted, BoneMotions& motions) {
  const std::vector<double> fractions = jointWeightsOf(fitted.weights, motions.boneCount());
  std::vector<bool> isTaken(sequence.pointCount(), false);
  const std::size_t seedCount = seedPoints(sequence.pointCount() / motions.boneCount());
  bool any = false;
  for (Index b = 0; b < motions.boneCount(); ++b) {
    if (fractions[b] >= kMinFraction) continue;
    Index worst = kNoIndex;
    for (Index v = 0; v < sequence.pointCount(); ++v) {
      if (!isTaken[v] && (worst == kNoIndex || fitted.errors[v] > fitted.errors[worst])) worst = v;
    }
    if (worst == kNoIndex) break;
    const std::vector<Index> seeds = nearestPoints(sequence, worst, seedCount, [&](Index v) { return !isTaken[v]; });
    for (const Index v : seeds) isTaken[v] = true;
    BoneMotions seeded{motions.frameCount, {}};
    appendMotionOf(sequence, seeds, seeded);
    std::copy(seeded.motions.begin(), seeded.motions.end(), motions.of(b));
    any = true;
  }
  return any;
}

void dropUnused(Decomposition& result) {
  std::vector<bool> isUsed;
  for (const double fraction : jointWeightsOf(result.weights, result.motions.boneCount()))
    isUsed.push_back(fraction > 0);
  const std::vector<Index> renumbered = compactBones(result.motions, isUsed);
  for (std::size_t i = 0; i < result.weights.joints.size(); ++i) {
    Index& joint = result.weights.joints[i];
    joint = result.weights.weights[i] > 0 ? renumbered[joint] : 0;
  }
}

// With at most so many bones; the sequence is centred. The best of all iterations: one that reseeds bones may come out
// worse than those before.
Decomposition decomposeWith(const VertexSequence& sequence, Index bones, const DecompositionOptions& options,
                            Progress& progress) {
  BoneMotions motions = motionClusters(sequence, bones, progress).motions;
  FittedWeights fitted = fitWeights(sequence, motions, options.maxInfluences, {});
  double error = rootMeanSquare(sequence, fitted.errors);
  Decomposition best{motions, fitted.weights, error};
  for (int i = 0; i < options.iterations; ++i) {
    progress.update(static_cast<double>(i) / options.iterations);
    const bool isNew = i + kLastIterations < options.iterations && reseed(sequence, fitted, motions);
    if (!isNew) fitMotions(sequence, fitted.weights, motions);
    fitted = fitWeights(sequence, motions, options.maxInfluences, isNew ? SkinWeights() : fitted.weights);
    const double before = error;
    error = rootMeanSquare(sequence, fitted.errors);
    if (error < best.error) best = {motions, fitted.weights, error};
    if (!isNew && before - error <= kConverged * before) break;
  }
  dropUnused(best);
  return best;
}

// Tries 1, 2, 4, ... bones while the error falls, whether or not all of them are put to use, then those between.
Decomposition decomposeWithin(const VertexSequence& sequence, const DecompositionOptions& options, Progress& progress) {
  Index low = 1;
  Decomposition best = decomposeWith(sequence, 1, options, progress);
  while (best.error > options.tolerance && low < kMaxBones) {
    Decomposition more = decomposeWith(sequence, 2 * low, options, progress);
    const bool isWorth = more.error <= kWorthMore * best.error;
    if (!isWorth) return best;
    if (more.error <= options.tolerance) {
      best = std::move(more);
      break;
    }
    low *= 2;
    best = std::move(more);
  }
  Index high = best.motions.boneCount();
  while (best.error <= options.tolerance && high > low + 1) {
    const Index middle = low + (high - low) / 2;
    Decomposition fewer = decomposeWith(sequence, middle, options, progress);
    if (fewer.error <= options.tolerance) {
      best = std::move(fewer);
      high = std::min(middle, best.motions.boneCount());
    } else {
      low = middle;
    }
  }
  return best;
}

void checkOptions(const DecompositionOptions& options) {
  if (options.bones && (*options.bones < 1 || *options.bones > kMaxBones)) {
    throw Error(ErrorCode::kBadArgument, fmt::format("a mesh can be given 1 to {} bones", kMaxBones), {},
                fmt::format("choose `bones` 1 to {}", kMaxBones));
  }
  if (options.maxInfluences < 1 || options.maxInfluences > kMaxInfluences) {
    throw Error(ErrorCode::kBadArgument, fmt::format("a vertex can keep 1 to {} influences", kMaxInfluences), {},
                fmt::format("choose `max-influences` 1 to {}", kMaxInfluences));
  }
  if (options.iterations < 1) throw Error(ErrorCode::kBadArgument, "a decomposition takes an iteration at least");
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
    throw Error(ErrorCode::kBadArgument, "the tolerance is not 0 or more");
  }
}

}  // namespace

Decomposition decomposeSkin(VertexSequence sequence, const DecompositionOptions& options, Progress& progress) {
  if (sequence.pointCount() == 0 || sequence.frameCount() == 0) {
    throw Error(ErrorCode::kBadArgument, "a decomposition takes a point and a frame at least");
  }
  checkOptions(options);
  const Centred centred(sequence);
  Decomposition result = options.bones ? decomposeWith(sequence, *options.bones, options, progress)
                                       : decomposeWithin(sequence, options, progress);
  centred.restore(result.motions);
  return result;
}

}  // namespace limber
