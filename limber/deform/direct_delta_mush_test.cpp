// Direct delta mush against the paper's formulas in dense matrices, and what it is for: joints that bend softly.
#include "limber/deform/direct_delta_mush.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/deform/deform_kernels.h"
#include "limber/deform/testing/bent_tube.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {
namespace {

using testing::bentTube;
using testing::BoundMesh;

Quat bendBy(double angle) {
  return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
}

std::vector<Vec3f> directly(const BoundMesh& bound, const DirectDeltaMushOptions& options) {
  return bound.deformed(findDeformer("direct-delta-mush"),
                        directDeltaMushRows(bound.surface(), bound.jointCount(), options).get());
}

using Dense = Eigen::MatrixXd;

// (I + lambda L)^-p with L the normalised Laplacian, lambda as the reach asks for.
Dense denseSmoothing(const BoundMesh& bound, double reach, int times) {
  const TriMesh& mesh = bound.mesh;
  const Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  Dense full(laplacian.stiffness);
  full.triangularView<Eigen::StrictlyUpper>() = full.transpose();
  const Eigen::Index count = full.rows();
  double step = 0;
  Box box;
  for (Eigen::Index i = 0; i < count; ++i) {
    box.add(mesh.position(static_cast<Index>(i)));
    for (Eigen::Index k = 0; k < count; ++k) {
      const double length2 =
          (mesh.position(static_cast<Index>(i)) - mesh.position(static_cast<Index>(k))).squaredNorm();
      if (i != k) step += laplacian.mass[i] * -full(i, k) / full(i, i) * length2 / laplacian.mass.sum();
    }
  }
  const double steps = std::max(1.0, std::pow(reach * box.longestSide(), 2) / step);
  const Dense normalised = full.diagonal().cwiseInverse().asDiagonal() * full;
  const Dense once = (Dense::Identity(count, count) + steps / times * normalised).inverse();
  Dense result = Dense::Identity(count, count);
  for (int i = 0; i < times; ++i) result *= once;
  return result;
}

enum class RotationBy { kFit, kBlendedQuaternions };

Mat3 fittedRotation(const Mat3& moments) {
  const Eigen::JacobiSVD<Mat3> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 flip = Mat3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * flip * svd.matrixV().transpose();
}

// Equations 14 to 18: Omega = (1 - alpha) Psi + alpha w' [p; 1] [p; 1]^T, [Q q; p 1] = sum of M Omega, R = U V^T; or
// R of the quaternions' sum by Omega's last entries.
std::vector<Vec3> byThePaper(const BoundMesh& bound, const DirectDeltaMushOptions& options, RotationBy by) {
  const Eigen::Index count = bound.mesh.vertexCount();
  const Dense b = denseSmoothing(bound, options.rotationReach, options.smoothings);
  const Dense c = denseSmoothing(bound, options.translationReach, options.smoothings);
  Dense u(count, 4), w = Dense::Zero(count, bound.jointCount());
  for (Index v = 0; v < count; ++v) {
    u.row(v) = bound.mesh.position(v).homogeneous().transpose();
    for (Index s = 0; s < bound.weights.slots; ++s) {
      w(v, bound.weights.jointsOf(v)[s]) += bound.weights.weightsOf(v)[s];
    }
  }
  const Dense p = b * u, smoothWeights = c * w;
  std::vector<Vec3> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    Mat4 sum = Mat4::Zero();
    Vec4 turn = Vec4::Zero();
    for (Index j = 0; j < bound.jointCount(); ++j) {
      Mat4 psi = Mat4::Zero();
      for (Eigen::Index k = 0; k < count; ++k) psi += b(i, k) * w(k, j) * u.row(k).transpose() * u.row(k);
      const Mat4 omega = (1 - options.translationWeight) * psi +
                         options.translationWeight * smoothWeights(i, j) * p.row(i).transpose() * p.row(i);
      sum += bound.transforms[j].matrix() * omega;
      turn += omega(3, 3) * Quat(bound.transforms[j].linear()).coeffs();
    }
    const Vec3 q = sum.block<3, 1>(0, 3), position = p.row(i).head<3>().transpose();
    const Mat3 rotation = by == RotationBy::kFit ? fittedRotation(sum.topLeftCorner<3, 3>() - q * position.transpose())
                                                 : Quat(turn).normalized().toRotationMatrix();
    result.push_back(rotation * (u.row(i).head<3>().transpose() - position) + q);
  }
  return result;
}

double farthest(const std::vector<Vec3f>& actual, const std::vector<Vec3>& wanted) {
  double most = 0;
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    const double distance = (actual[v].cast<double>() - wanted[v]).norm();
    if (!(distance <= most)) most = distance;
  }
  return most;
}

TEST(DirectDeltaMush, IsThePapersFormula) {
  for (const double alpha : {0.0, 0.8}) {
    for (const int smoothings : {1, 2, 5}) {
      const BoundMesh bound = bentTube(10, 21, 0.2, bendBy(1.4));
      DirectDeltaMushOptions options;
      options.translationWeight = alpha;
      options.smoothings = smoothings;
      options.minWeight = 0;
      EXPECT_LT(farthest(directly(bound, options), byThePaper(bound, options, RotationBy::kBlendedQuaternions)), 1e-5)
          << alpha << " " << smoothings;
    }
  }
}

TEST(DirectDeltaMush, SmallWeightsThatAreLeftOutShowLittle) {
  const BoundMesh bound = bentTube(10, 21, 0.2, bendBy(1.4));
  DirectDeltaMushOptions options;
  options.minWeight = 1.0 / 256;
  EXPECT_LT(farthest(directly(bound, options), byThePaper(bound, {}, RotationBy::kBlendedQuaternions)), 3e-3);
}

// Bent and twisted, the tube being 1 long.
TEST(DirectDeltaMush, IsNearerToTheFullOneThanOtherDeformers) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
    const BoundMesh bound = bentTube(12, 41, 0, Quat(Eigen::AngleAxisd(1.2, axis.normalized())));
    const std::vector<Vec3> full = byThePaper(bound, {}, RotationBy::kFit);
    const double distance = farthest(directly(bound, {}), full);
    EXPECT_LT(distance, 0.015) << axis.transpose();
    EXPECT_GT(farthest(bound.deformed("linear-blend"), full), 2 * distance) << axis.transpose();
    EXPECT_GT(farthest(bound.deformed("dual-quaternion"), full), 2 * distance) << axis.transpose();
  }
}

struct RowPart {
  Index joint = 0;
  float weight = 0;
};

std::vector<RowPart> partsOf(const DirectDeltaMushRows& rows, std::size_t row) {
  std::vector<RowPart> parts;
  for (std::size_t e = 4 * std::size_t{rows.begin[row]}; e < 4 * std::size_t{rows.begin[row + 1]}; ++e) {
    const float weight = rows.moments[16 * (e / 4) + 12 + e % 4];
    if (weight != 0) parts.push_back({rows.joints[e], weight});
  }
  return parts;
}

TEST(DirectDeltaMush, KeepsTheStrongestJoints) {
  const BoundMesh bound = testing::boundAtRandom(testing::tube(7, 9, true));
  const auto all = directDeltaMushRows(bound.surface(), bound.jointCount());
  for (const Index most : {1u, 2u, 3u}) {
    DirectDeltaMushOptions options;
    options.maxJoints = most;
    const auto rows = directDeltaMushRows(bound.surface(), bound.jointCount(), options);
    ASSERT_EQ(rows->begin.size(), all->begin.size());
    for (std::size_t r = 0; r + 1 < rows->begin.size(); ++r) {
      const std::vector<RowPart> parts = partsOf(*rows, r), wanted = partsOf(*all, r);
      ASSERT_EQ(parts.size(), std::min<std::size_t>(most, wanted.size()));
      double sum = 0, whole = 0;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_EQ(parts[i].joint, wanted[i].joint) << r;
        sum += static_cast<double>(parts[i].weight);
      }
      for (const RowPart& part : wanted) whole += static_cast<double>(part.weight);
      EXPECT_NEAR(sum, whole, 1e-6) << r;
    }
  }
}

TEST(DirectDeltaMush, FarFromTheJointIsRigid) {
  const Quat turn = bendBy(2);
  const BoundMesh bound = bentTube(12, 61, 0.1, turn);
  const std::vector<Vec3f> out = bound.deformed("direct-delta-mush");
  for (Index v = 0; v < bound.mesh.vertexCount(); ++v) {
    if (bound.mesh.positions[v].x() < -0.35f) {
      EXPECT_EQ(out[v], bound.mesh.positions[v]) << v;
    }
    if (bound.mesh.positions[v].x() > 0.35f) {
      EXPECT_LT((out[v].cast<double>() - turn * bound.mesh.position(v)).norm(), 1e-6) << v;
    }
  }
}

TEST(DirectDeltaMush, EveryBuildOfTheInnerLoopGivesTheSameBits) {
  if (!avx2DirectKernels()) GTEST_SKIP() << "no AVX2 here";
  const BoundMesh bound = testing::boundAtRandom(testing::tube(7, 9, true));
  const auto rows = directDeltaMushRows(bound.surface(), bound.jointCount());
  const std::size_t count = bound.mesh.positions.size();
  Random random(5);
  std::vector<float> maps(2 * kFloatsPerColumns * bound.jointCount()), motions(kFloatsPerMotion * bound.jointCount());
  for (float& x : maps) x = static_cast<float>(random.uniform(-1, 1));
  for (float& x : motions) x = static_cast<float>(random.uniform(-1, 1));
  const auto bits = [&](const DirectKernels& kernels, bool normals, bool scales) {
    std::vector<float> out(6 * count);
    DeformJob job;
    job.positions = bound.mesh.positions[0].data();
    job.normals = normals ? bound.mesh.positions[0].data() : nullptr;
    job.outPositions = out.data();
    job.outNormals = normals ? out.data() + 3 * count : nullptr;
    job.columns = maps.data();
    job.stretches = maps.data() + kFloatsPerColumns * bound.jointCount();
    job.motions = motions.data();
    job.rowOf = rows->rowOf.data();
    job.rowBegin = rows->begin.data();
    job.rowJoints = rows->joints.data();
    job.rowMoments = rows->moments.data();
    job.rowPositions = rows->positions.data();
    kernels.direct[normals][scales](job, 0, count);
    return out;
  };
  for (const bool normals : {false, true}) {
    for (const bool scales : {false, true}) {
      const std::vector<float> plain = bits(baselineDirectKernels(), normals, scales);
      EXPECT_EQ(bits(*avx2DirectKernels(), normals, scales), plain) << normals << scales;
      if (!avx512DirectKernels()) continue;
      EXPECT_EQ(bits(*avx512DirectKernels(), normals, scales), plain) << normals << scales;
    }
  }
}

// A tube along a chain of 21 joints, each point bound to the three nearest.
BoundMesh manyJointedTube() {
  BoundMesh bound;
  bound.mesh = testing::tube(8, 41, true);
  bound.weights.slots = 3;
  for (const Vec3f& p : bound.mesh.positions) {
    const Index middle = std::clamp(static_cast<Index>(20 * (p.x() + 0.5f) + 0.5f), 1u, 19u);
    bound.weights.joints.insert(bound.weights.joints.end(), {middle, middle - 1, middle + 1});
    bound.weights.weights.insert(bound.weights.weights.end(), {0.5f, 0.25f, 0.25f});
  }
  bound.transforms.assign(21, Affine(Eigen::Translation3d(1, 2, 3) * bendBy(0.6)));
  return bound;
}

// How many are left where entries of four are left out from the last on while they hold less than that.
std::size_t keptOf(const std::vector<RowPart>& parts, double least) {
  std::size_t count = parts.size();
  while (count > 4) {
    double total = 0;
    const std::size_t first = (count - 1) / 4 * 4;
    for (std::size_t i = first; i < count; ++i) total += static_cast<double>(parts[i].weight);
    if (total >= least) break;
    count = first;
  }
  return count;
}

TEST(DirectDeltaMush, AnEntryIsKeptWhereItsJointsHoldEnoughTogether) {
  const BoundMesh bound = manyJointedTube();
  DirectDeltaMushOptions options;
  options.minEntry = 0;
  options.minWeight = 1e-6;
  options.maxJoints = 21;
  const auto all = directDeltaMushRows(bound.surface(), bound.jointCount(), options);
  std::size_t before = all->joints.size();
  for (const double least : {0.005, 0.02, 0.5}) {
    options.minEntry = least;
    const auto rows = directDeltaMushRows(bound.surface(), bound.jointCount(), options);
    EXPECT_LE(rows->joints.size(), before) << least;
    before = rows->joints.size();
    for (std::size_t r = 0; r + 1 < rows->begin.size(); ++r) {
      const std::vector<RowPart> parts = partsOf(*rows, r);
      EXPECT_EQ(parts.size(), keptOf(partsOf(*all, r), least)) << r;
      double sum = 0;
      for (const RowPart& part : parts) sum += static_cast<double>(part.weight);
      EXPECT_NEAR(sum, 1, 1e-6) << r;
    }
    // One motion of all joints stays one motion.
    const std::vector<Vec3f> moved = bound.deformed(findDeformer("direct-delta-mush"), rows.get());
    for (Index v = 0; v < moved.size(); ++v) {
      const Vec3 wanted = bound.transforms[0] * bound.mesh.position(v);
      EXPECT_LT((moved[v].cast<double>() - wanted).norm(), 2e-6) << v;
    }
  }
  EXPECT_LT(before, all->joints.size());
}

TEST(DirectDeltaMush, RefusesOptionsOutOfRange) {
  const BoundMesh bound = bentTube(6, 5, 0.2, bendBy(1));
  DirectDeltaMushOptions alpha, reach, times, joints, entry;
  alpha.translationWeight = 1;
  reach.rotationReach = 0;
  times.smoothings = 0;
  joints.maxJoints = 0;
  entry.minEntry = -0.1;
  for (const DirectDeltaMushOptions& wrong : {alpha, reach, times, joints, entry}) {
    EXPECT_THROW(directDeltaMushRows(bound.surface(), 2, wrong), Error);
  }
}

}  // namespace
}  // namespace limber
