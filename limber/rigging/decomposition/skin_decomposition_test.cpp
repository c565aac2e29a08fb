#include "limber/rigging/decomposition/skin_decomposition.h"

#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/rigging/decomposition/bone_skeleton.h"
#include "limber/rigging/decomposition/bone_weights.h"
#include "limber/rigging/decomposition/motion_clusters.h"
#include "limber/rigging/decomposition/testing/moving_meshes.h"

namespace limber {
namespace {

using testing::bentTube;
using testing::hingedBoxes;
using testing::KnownMotion;
using testing::scatteredPieces;

Decomposition decompose(const KnownMotion& known, std::optional<Index> bones, double tolerance = 0.002) {
  DecompositionOptions options;
  options.bones = bones;
  options.tolerance = tolerance;
  Progress progress;
  return decomposeSkin(known.sequence(), options, progress);
}

// The result's error by its own definition, in the units of the mesh.
double measuredError(const KnownMotion& known, const Decomposition& result) {
  const VertexSequence sequence = known.sequence();
  double sum = 0;
  for (Index v = 0; v < sequence.pointCount(); ++v) {
    for (Index f = 0; f < sequence.frameCount(); ++f) {
      Vec3 moved = Vec3::Zero();
      for (Index i = 0; i < result.weights.slots; ++i) {
        moved += result.weights.weightsOf(v)[i] *
                 (result.motions.of(result.weights.jointsOf(v)[i])[f] * known.rest[v].cast<double>().homogeneous());
      }
      sum += (moved - sequence.at(v, f).cast<double>()).squaredNorm();
    }
  }
  return std::sqrt(sum / sequence.pointCount() / sequence.frameCount());
}

double diagonalOf(const KnownMotion& known) {
  Box box;
  for (const Vec3f& p : known.rest) box.add(p.cast<double>());
  return box.diagonal();
}

double weightOf(const Decomposition& result, Index v, Index bone) {
  double sum = 0;
  for (Index i = 0; i < result.weights.slots; ++i) {
    if (result.weights.jointsOf(v)[i] == bone) sum += result.weights.weightsOf(v)[i];
  }
  return sum;
}

ErrorCode codeOf(VertexSequence sequence, const DecompositionOptions& options) {
  Progress progress;
  try {
    decomposeSkin(std::move(sequence), options, progress);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kFile;
}

void expectSound(const Decomposition& result) {
  for (Index v = 0; v < result.weights.vertexCount(); ++v) {
    double sum = 0;
    float last = 1;
    for (Index i = 0; i < result.weights.slots; ++i) {
      const float w = result.weights.weightsOf(v)[i];
      EXPECT_GE(w, 0);
      EXPECT_LE(w, last);
      EXPECT_LT(result.weights.jointsOf(v)[i], result.motions.boneCount());
      last = w;
      sum += w;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
  for (const RigidMotion& motion : result.motions.motions) {
    const Mat3 turn = motion.leftCols<3>();
    EXPECT_LT((turn * turn.transpose() - Mat3::Identity()).norm(), 1e-9);
    EXPECT_GT(turn.determinant(), 0);
  }
}

TEST(SkinDecomposition, FindsTheBonesOfHingedBoxes) {
  const KnownMotion known = hingedBoxes();
  const Decomposition result = decompose(known, 3);
  expectSound(result);
  ASSERT_EQ(result.motions.boneCount(), 3u);
  EXPECT_LT(result.error, 1e-5);
  std::set<Index> used;
  for (Index box = 0; box < 3; ++box) {
    const Index bone = result.weights.jointsOf(27 * box)[0];
    used.insert(bone);
    for (Index v = 27 * box; v < 27 * box + 27; ++v) {
      EXPECT_EQ(result.weights.jointsOf(v)[0], bone) << v;
      EXPECT_NEAR(result.weights.weightsOf(v)[0], 1, 1e-3) << v;
    }
    for (Index f = 0; f < 30; ++f) {
      EXPECT_LT((result.motions.of(bone)[f] - known.motions.of(box)[f]).norm(), 1e-4) << f;
    }
  }
  EXPECT_EQ(used.size(), 3u);
}

TEST(SkinDecomposition, FindsTheJointsOfHingedBoxes) {
  const KnownMotion known = hingedBoxes();
  const Decomposition result = decompose(known, 3);
  const BoneSkeleton bones = skeletonOfBones(known.rest, result);
  ASSERT_EQ(bones.skeleton.jointCount(), 3u);
  checkSkeleton(bones.skeleton);
  // The middle box is nearest to the middle: the root, with both others hinged to it.
  EXPECT_EQ(bones.boneOf[0], result.weights.jointsOf(27)[0]);
  std::vector<double> along;
  for (Index j = 1; j < 3; ++j) {
    EXPECT_EQ(bones.skeleton.joints[j].parent, std::optional<Index>(0));
    const Vec3 position = restGlobals(bones.skeleton)[j].translation();
    const Vec3& joint = bones.boneOf[j] == result.weights.jointsOf(0)[0] ? known.joints[0] : known.joints[1];
    EXPECT_LT((position - joint).norm(), 0.005) << position.transpose();
  }
}

TEST(SkinDecomposition, FindsTheSmoothWeightsOfABentTube) {
  const KnownMotion known = bentTube();
  const Decomposition result = decompose(known, 2);
  expectSound(result);
  ASSERT_EQ(result.motions.boneCount(), 2u);
  EXPECT_LT(result.error, 2e-4);
  EXPECT_NEAR(result.error, measuredError(known, result) / diagonalOf(known), 1e-5);
  const Index first = result.weights.jointsOf(0)[0];
  for (Index v = 0; v < known.rest.size(); ++v) {
    double w = 0;
    for (Index i = 0; i < result.weights.slots; ++i) {
      if (result.weights.jointsOf(v)[i] == first) w += result.weights.weightsOf(v)[i];
    }
    EXPECT_NEAR(w, known.weights[v][0], 0.05) << v;
  }
}

TEST(SkinDecomposition, TakesAsFewBonesAsItNeeds) {
  EXPECT_EQ(decompose(hingedBoxes(), std::nullopt).motions.boneCount(), 3u);
  const Decomposition tube = decompose(bentTube(), std::nullopt);
  EXPECT_EQ(tube.motions.boneCount(), 2u);
  EXPECT_LE(tube.error, 0.002);
}

TEST(SkinDecomposition, MoreBonesThanMoveAreNotMade) {
  const Decomposition result = decompose(hingedBoxes(), 12);
  expectSound(result);
  EXPECT_EQ(result.motions.boneCount(), 3u);
}

TEST(SkinDecomposition, InfluencesAreAtMostAsAskedFor) {
  KnownMotion known = bentTube();
  DecompositionOptions options;
  options.bones = 4;
  options.maxInfluences = 1;
  Progress progress;
  const Decomposition result = decomposeSkin(known.sequence(), options, progress);
  EXPECT_EQ(result.weights.slots, 1u);
  expectSound(result);
}

TEST(SkinDecomposition, UnitsAndPlaceDoNotMatter) {
  const KnownMotion known = bentTube();
  KnownMotion moved = known;
  const Vec3 offset(1000, -500, 300);
  for (Vec3f& p : moved.rest) p = 100.0f * p + offset.cast<float>();
  for (RigidMotion& motion : moved.motions.motions) {
    motion.col(3) = 100 * motion.col(3) - motion.leftCols<3>() * offset;
  }
  const Decomposition here = decompose(known, 2), there = decompose(moved, 2);
  EXPECT_LT(there.error, 3e-4);
  ASSERT_EQ(here.motions.boneCount(), 2u);
  ASSERT_EQ(there.motions.boneCount(), 2u);
  for (Index v = 0; v < known.rest.size(); ++v) {
    for (Index b = 0; b < 2; ++b) EXPECT_NEAR(weightOf(here, v, b), weightOf(there, v, b), 0.01) << v;
  }
  for (Index b = 0; b < 2; ++b) {
    for (Index f = 0; f < known.motions.frameCount; ++f) {
      RigidMotion expected = here.motions.of(b)[f];
      EXPECT_LT((expected - there.motions.of(b)[f]).leftCols<3>().norm(), 0.01);
      expected.col(3) *= 100;
      for (const Index v : {0u, 125u, 251u}) {
        const Vec3 position = 100 * known.rest[v].cast<double>();
        const Vec3 image = there.motions.of(b)[f] * Vec3(position + offset).homogeneous();
        const Vec3 apart = expected * position.homogeneous() - image;
        EXPECT_LT(apart.norm(), 0.002 * 100 * diagonalOf(known)) << b << " " << f;
      }
    }
  }
}

TEST(SkinDecomposition, DoesNotDependOnThreads) {
  std::vector<Decomposition> results;
  for (const int threads : {1, 2, 5}) {
    setThreadCount(threads);
    results.push_back(decompose(bentTube(), 5));
  }
  setThreadCount(0);
  for (const Decomposition& result : results) {
    EXPECT_EQ(result.weights.joints, results[0].weights.joints);
    EXPECT_EQ(result.weights.weights, results[0].weights.weights);
    EXPECT_EQ(result.error, results[0].error);
  }
}

TEST(SkinDecomposition, DegenerateSequencesComeOutSound) {
  Progress progress;
  VertexSequence line(5, 2);
  for (Index v = 0; v < 5; ++v) {
    line.rest[v] = Vec3f(static_cast<float>(v), 0, 0);
    for (Index f = 0; f < 2; ++f) line.set(v, f, Vec3f(0, static_cast<float>(v * f), 0));
  }
  DecompositionOptions options;
  options.bones = 4;
  expectSound(decomposeSkin(line, options, progress));
  VertexSequence pair(2, 1);
  pair.rest[1] = pair.rest[0] + Vec3f(1, 0, 0);
  expectSound(decomposeSkin(pair, options, progress));
}

TEST(SkinDecomposition, RefusesWhatHasNoSizeOrIsNotFinite) {
  Progress progress;
  EXPECT_THROW(decomposeSkin(VertexSequence(0, 3), {}, progress), Error);
  EXPECT_THROW(decomposeSkin(VertexSequence(3, 0), {}, progress), Error);
  EXPECT_THROW(decomposeSkin(VertexSequence(3, 2), {}, progress), Error);  // all at the origin
  VertexSequence broken = bentTube(3).sequence();
  broken.set(4, 1, Vec3f(std::numeric_limits<float>::quiet_NaN(), 0, 0));
  EXPECT_THROW(decomposeSkin(broken, {}, progress), Error);
}

TEST(SkinDecomposition, RefusesFramesTooFarForTheRestPose) {
  VertexSequence sequence(3, 2);
  for (Index v = 0; v < 3; ++v) {
    sequence.rest[v] = Vec3f(1e-20f * static_cast<float>(v), 0, 0);
    for (Index f = 0; f < 2; ++f) sequence.set(v, f, Vec3f(1e20f * static_cast<float>(v), 0, static_cast<float>(f)));
  }
  EXPECT_EQ(codeOf(sequence, {}), ErrorCode::kBadData);
}

TEST(SkinDecomposition, RefusesOptionsOutOfRange) {
  const VertexSequence sequence = bentTube(3).sequence();
  const auto refuses = [&](auto change) {
    DecompositionOptions options;
    change(options);
    EXPECT_EQ(codeOf(sequence, options), ErrorCode::kBadArgument);
  };
  refuses([](DecompositionOptions& options) { options.maxInfluences = 0; });
  refuses([](DecompositionOptions& options) { options.maxInfluences = kMaxInfluences + 1; });
  refuses([](DecompositionOptions& options) { options.bones = 0; });
  refuses([](DecompositionOptions& options) { options.bones = kMaxBones + 1; });
  refuses([](DecompositionOptions& options) { options.iterations = 0; });
  refuses([](DecompositionOptions& options) { options.tolerance = -1; });
  refuses([](DecompositionOptions& options) { options.tolerance = std::numeric_limits<double>::quiet_NaN(); });
}

TEST(SkinDecomposition, FindsBonesForManyPieces) {
  for (const Index pieces : {5u, 9u, 14u, 23u}) {
    const Decomposition result = decompose(scatteredPieces(pieces), std::nullopt);
    expectSound(result);
    EXPECT_LE(result.error, 0.002) << pieces;
  }
}

// Reseeding may end worse than it began.
TEST(SkinDecomposition, IsNotWorseThanTheClustersItBeginsWith) {
  for (const Index pieces : {6u, 9u, 14u, 23u}) {
    KnownMotion known = scatteredPieces(pieces);
    const auto scale = static_cast<float>(1 / diagonalOf(known));
    for (Vec3f& p : known.rest) p *= scale;
    for (RigidMotion& motion : known.motions.motions) motion.col(3) *= scale;
    const VertexSequence sequence = known.sequence();
    for (const Index bones : {2u, 3u, 5u, 8u, 12u}) {
      Progress progress;
      const MotionClusters clusters = motionClusters(sequence, bones, progress);
      double squares = 0;
      for (const double error : fitWeights(sequence, clusters.motions, 4, {}).errors) squares += error;
      const Decomposition result = decompose(known, bones);
      EXPECT_NEAR(result.error, measuredError(known, result), 1e-5);
      EXPECT_LE(result.error, 1.001 * std::sqrt(squares / sequence.pointCount() / sequence.frameCount()) + 1e-6)
          << bones << " of " << pieces;
    }
  }
}

TEST(SkinDecomposition, CanBeCancelled) {
  int updates = 0;
  Progress counting([&](std::string_view, double) { ++updates; });
  DecompositionOptions options;
  options.bones = 3;
  decomposeSkin(bentTube().sequence(), options, counting);
  ASSERT_GT(updates, 3);
  for (const int last : {0, 1, updates / 2, updates - 1}) {
    int reported = 0;
    Progress progress;
    Progress cancelling([&](std::string_view, double) {
      if (++reported == last) cancelling.cancel();
    });
    Progress& heard = last == 0 ? progress : cancelling;
    if (last == 0) progress.cancel();
    try {
      decomposeSkin(bentTube().sequence(), options, heard);
      ADD_FAILURE() << "not cancelled at " << last;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kCancelled);
    }
    EXPECT_EQ(reported, last);
  }
}

TEST(BoneWeights, TakeMoreInfluencesThanThereAreBones) {
  const VertexSequence sequence = bentTube(4).sequence();
  BoneMotions one{4, std::vector<RigidMotion>(4, RigidMotion::Identity())};
  SkinWeights before;
  before.slots = 4;
  before.joints.assign(4 * std::size_t{sequence.pointCount()}, 0);
  before.weights.assign(4 * std::size_t{sequence.pointCount()}, 0.0f);
  for (Index v = 0; v < sequence.pointCount(); ++v) before.weights[4 * v + v % 4] = 1;
  const FittedWeights fitted = fitWeights(sequence, one, 4, before);
  for (Index v = 0; v < sequence.pointCount(); ++v) {
    EXPECT_EQ(fitted.weights.jointsOf(v)[0], 0u);
    EXPECT_EQ(fitted.weights.weightsOf(v)[0], 1.0f);
  }
  EXPECT_THROW(fitWeights(sequence, one, kMaxInfluences + 1, {}), Error);
  EXPECT_THROW(fitWeights(sequence, one, 0, {}), Error);
}

TEST(BoneMotions, CompactedKeepTheirOrder) {
  BoneMotions motions{2, {}};
  for (int i = 0; i < 10; ++i) motions.motions.push_back(RigidMotion::Constant(i));
  const std::vector<Index> renumbered = compactBones(motions, {false, true, false, true, true});
  EXPECT_EQ(renumbered, (std::vector<Index>{kNoIndex, 0, kNoIndex, 1, 2}));
  ASSERT_EQ(motions.boneCount(), 3u);
  for (Index b = 0; b < 3; ++b) {
    for (Index f = 0; f < 2; ++f) {
      EXPECT_EQ(motions.of(b)[f](0, 0), std::vector<double>({2, 3, 6, 7, 8, 9})[2 * b + f]);
    }
  }
}

TEST(VertexSequence, RefusesMoreThanItHolds) {
  EXPECT_NO_THROW(VertexSequence::checkSize(3, VertexSequence::kMaxFrames));
  EXPECT_THROW(VertexSequence::checkSize(3, 6.7e8), Error);
  EXPECT_THROW(VertexSequence::checkSize(1, std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(VertexSequence::checkSize(1, std::numeric_limits<double>::quiet_NaN()), Error);
  EXPECT_NO_THROW(VertexSequence::checkSize(1993, 1e6));
  EXPECT_THROW(VertexSequence::checkSize(1993, 1e6 + 1), Error) << "2000 are stored";
  EXPECT_THROW(VertexSequence::forFrames(1, (1 << 20) + 1), Error);
  EXPECT_EQ(VertexSequence::forFrames(9, 3).blockCount(), 2u);
}

TEST(MotionClusters, OfBoxesAreTheBoxes) {
  const KnownMotion known = hingedBoxes();
  Progress progress;
  const MotionClusters clusters = motionClusters(known.sequence(), 3, progress);
  ASSERT_EQ(clusters.motions.boneCount(), 3u);
  for (Index v = 0; v < known.rest.size(); ++v) EXPECT_EQ(clusters.clusterOf[v], clusters.clusterOf[v / 27 * 27]);
}

TEST(BoneSkeleton, TheClipMovesPointsAsTheBonesDo) {
  const KnownMotion known = hingedBoxes(8);
  const Decomposition result = decompose(known, 3);
  const BoneSkeleton bones = skeletonOfBones(known.rest, result);
  const Clip clip = clipOfBones(bones, result.motions, {"swing", 2, 5, 10});
  checkClip(clip, bones.skeleton);
  EXPECT_NEAR(clip.duration(), 0.4, 1e-6);
  for (Index f = 0; f < 5; ++f) {
    Pose pose = restPose(bones.skeleton);
    sampleClip(clip, f / 10.0, pose);
    const std::vector<Affine> moved = skinTransforms(bones.skeleton, pose);
    for (Index v = 0; v < known.rest.size(); ++v) {
      const Vec3 position = moved[bones.weights.jointsOf(v)[0]] * known.rest[v].cast<double>();
      EXPECT_LT((position - known.sequence().at(v, f + 2).cast<double>()).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace limber
