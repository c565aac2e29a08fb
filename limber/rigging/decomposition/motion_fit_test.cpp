#include "limber/rigging/decomposition/motion_fit.h"

#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "limber/core/parallel.h"
#include "limber/rigging/decomposition/testing/moving_meshes.h"

namespace limber {
namespace {

using testing::bentTube;
using testing::KnownMotion;

// Horn's closed form (1987): the rotation is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix.
RigidMotion hornsMotion(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / static_cast<double>(from.size());
    b += to[i] / static_cast<double>(from.size());
  }
  Mat3 s = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) s += (from[i] - a) * (to[i] - b).transpose();
  Mat4 n;
  n << s.trace(), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),                   //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),  //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),  //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
  const Vec4 q = Eigen::SelfAdjointEigenSolver<Mat4>(n).eigenvectors().col(3);
  RigidMotion result;
  result.leftCols<3>() = Quat(q[0], q[1], q[2], q[3]).toRotationMatrix();
  result.col(3) = b - result.leftCols<3>() * a;
  return result;
}

TEST(MotionFit, OfOneBoneIsHornsClosedForm) {
  Random random(4);
  VertexSequence sequence(11, 6);
  for (Index v = 0; v < 11; ++v) {
    for (int i = 0; i < 3; ++i) sequence.rest[v][i] = static_cast<float>(random.uniform(-1, 1));
    for (Index f = 0; f < 6; ++f) {
      Vec3f moved;
      for (int i = 0; i < 3; ++i) moved[i] = static_cast<float>(random.uniform(-1, 1));
      sequence.set(v, f, moved + 5.0f * sequence.rest[v]);
    }
  }
  BoneMotions motions{6, {}};
  std::vector<Index> all(11);
  std::iota(all.begin(), all.end(), Index{0});
  appendMotionOf(sequence, all, motions);
  for (Index f = 0; f < 6; ++f) {
    std::vector<Vec3> from, to;
    for (Index v = 0; v < 11; ++v) {
      from.push_back(sequence.rest[v].cast<double>());
      to.push_back(sequence.at(v, f).cast<double>());
    }
    EXPECT_LT((motions.of(0)[f] - hornsMotion(from, to)).norm(), 1e-5) << f;
  }
}

double errorOf(const VertexSequence& sequence, const SkinWeights& weights, const BoneMotions& motions) {
  double sum = 0;
  for (Index v = 0; v < sequence.pointCount(); ++v) {
    for (Index f = 0; f < sequence.frameCount(); ++f) {
      Vec3 moved = Vec3::Zero();
      for (Index i = 0; i < weights.slots; ++i) {
        moved += weights.weightsOf(v)[i] *
                 (motions.of(weights.jointsOf(v)[i])[f] * sequence.rest[v].cast<double>().homogeneous());
      }
      sum += (moved - sequence.at(v, f).cast<double>()).squaredNorm();
    }
  }
  return sum;
}

SkinWeights slotsOf(const KnownMotion& known) {
  SkinWeights weights;
  weights.slots = 2;
  for (const std::vector<double>& w : known.weights) {
    weights.joints.insert(weights.joints.end(), {0, 1});
    for (const double x : w) weights.weights.push_back(static_cast<float>(x));
  }
  return weights;
}

TEST(MotionFit, NeverGetsWorseAndComesToTheTruth) {
  const KnownMotion known = bentTube(12);
  const VertexSequence sequence = known.sequence();
  const SkinWeights weights = slotsOf(known);
  BoneMotions motions{12, std::vector<RigidMotion>(24, RigidMotion::Identity())};
  double error = errorOf(sequence, weights, motions);
  for (int round = 0; round < 60; ++round) {
    fitMotions(sequence, weights, motions);
    const double next = errorOf(sequence, weights, motions);
    EXPECT_LE(next, error * (1 + 1e-9) + 1e-9) << round;
    error = next;
  }
  for (std::size_t i = 0; i < motions.motions.size(); ++i) {
    EXPECT_LT((motions.motions[i] - known.motions.motions[i]).norm(), 1e-3) << i;
  }
}

TEST(MotionFit, ABoneWithoutPointsAndPointsOnALineStayPut) {
  VertexSequence sequence(3, 1);
  for (Index v = 0; v < 3; ++v) {
    sequence.rest[v] = Vec3f(static_cast<float>(v), 0, 0);
    sequence.set(v, 0, Vec3f(static_cast<float>(v), 1, 0));
  }
  SkinWeights weights{1, {0, 0, 0}, {1, 1, 1}};
  const RigidMotion unused = RigidMotion::Constant(7);
  BoneMotions motions{1, {RigidMotion::Identity(), unused}};
  fitMotions(sequence, weights, motions);
  EXPECT_EQ(motions.of(1)[0], unused);
  RigidMotion expected = RigidMotion::Identity();
  expected(1, 3) = 1;
  EXPECT_LT((motions.of(0)[0] - expected).norm(), 1e-6);
}

TEST(MotionFit, DoesNotDependOnThreads) {
  const KnownMotion known = bentTube(9);
  const SkinWeights weights = slotsOf(known);
  std::vector<BoneMotions> results;
  for (const int threads : {1, 3}) {
    setThreadCount(threads);
    BoneMotions motions{9, std::vector<RigidMotion>(18, RigidMotion::Identity())};
    for (int i = 0; i < 3; ++i) fitMotions(known.sequence(), weights, motions);
    results.push_back(motions);
  }
  setThreadCount(0);
  for (std::size_t i = 0; i < results[0].motions.size(); ++i) {
    EXPECT_EQ(results[0].motions[i], results[1].motions[i]);
  }
}

}  // namespace
}  // namespace limber
