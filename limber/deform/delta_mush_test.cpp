// Delta mush against the same sums in dense matrices, and what both delta mushes promise on any surface.
#include "limber/deform/delta_mush.h"

#include <bit>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/deform/direct_delta_mush.h"
#include "limber/deform/testing/bent_tube.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {
namespace {

using testing::bentTube;
using testing::boundAtRandom;
using testing::BoundMesh;
using testing::NamedMesh;

// The smoothings as one matrix, edges and polar decompositions from dense rows.
std::vector<Vec3> densely(const BoundMesh& bound, int smoothings, double step) {
  const TriMesh& mesh = bound.mesh;
  const Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
  Eigen::MatrixXd flow(laplacian.stiffness);
  flow.triangularView<Eigen::StrictlyUpper>() = flow.transpose();
  const Eigen::VectorXd diagonal = flow.diagonal();
  for (Eigen::Index i = 0; i < flow.rows(); ++i) flow.row(i) /= -diagonal[i];
  flow.diagonal().setZero();
  const Eigen::Index count = flow.rows();
  const Eigen::MatrixXd once = (1 - step) * Eigen::MatrixXd::Identity(count, count) + step * flow;
  Eigen::MatrixXd rest(count, 3), blended(count, 3);
  for (Index v = 0; v < count; ++v) {
    rest.row(v) = mesh.position(v).transpose();
    Vec3 sum = Vec3::Zero();
    for (Index s = 0; s < bound.weights.slots; ++s) {
      sum += bound.weights.weightsOf(v)[s] * (bound.transforms[bound.weights.jointsOf(v)[s]] * mesh.position(v));
    }
    blended.row(v) = sum.transpose();
  }
  Eigen::MatrixXd smoothRest = rest, smoothBlended = blended;
  for (int i = 0; i < smoothings; ++i) smoothRest = once * smoothRest, smoothBlended = once * smoothBlended;
  std::vector<Vec3> result;
  for (Eigen::Index v = 0; v < count; ++v) {
    Mat3 fit = Mat3::Zero();
    for (Eigen::Index k = 0; k < count; ++k) {
      fit += flow(v, k) * (smoothBlended.row(k) - smoothBlended.row(v)).transpose() *
             (smoothRest.row(k) - smoothRest.row(v));
    }
    const Eigen::JacobiSVD<Mat3> svd(fit, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 flip = Mat3::Identity();
    flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    const Vec3 detail = (rest.row(v) - smoothRest.row(v)).transpose();
    result.push_back(smoothBlended.row(v).transpose() + svd.matrixU() * flip * svd.matrixV().transpose() * detail);
  }
  return result;
}

TEST(DeltaMush, IsTheDenseSum) {
  const BoundMesh bound = bentTube(10, 21, 0.2, Quat(Eigen::AngleAxisd(1.4, Vec3::UnitZ())));
  DeltaMushOptions options;
  options.reach = 0.06;
  const auto surface = deltaMushSurface(bound.surface(), 2, options);
  EXPECT_GT(surface->smoothings, 2);
  const std::vector<Vec3f> out = bound.deformed(findDeformer("delta-mush"), surface.get());
  const std::vector<Vec3> wanted = densely(bound, surface->smoothings, options.step);
  for (Index v = 0; v < out.size(); ++v) EXPECT_LT((out[v].cast<double>() - wanted[v]).norm(), 1e-4) << v;
}

TEST(DeltaMush, RefusesOptionsOutOfRange) {
  const BoundMesh bound = bentTube(6, 5, 0.2, Quat::Identity());
  DeltaMushOptions reach, step, smoothings;
  reach.reach = -1;
  step.step = 1.5;
  smoothings.maxSmoothings = 0;
  for (const DeltaMushOptions& wrong : {reach, step, smoothings}) {
    EXPECT_THROW(deltaMushSurface(bound.surface(), 2, wrong), Error);
  }
}

class EveryMush : public ::testing::TestWithParam<std::string_view> {};

std::shared_ptr<const DeformPreparation> preparedWith(std::string_view name, const BoundMesh& bound, double reach) {
  DeltaMushOptions mush;
  mush.reach = reach;
  mush.maxSmoothings = 1000;
  DirectDeltaMushOptions direct;
  direct.rotationReach = direct.translationReach = reach;
  if (name == "delta-mush") return deltaMushSurface(bound.surface(), bound.jointCount(), mush);
  return directDeltaMushRows(bound.surface(), bound.jointCount(), direct);
}

// By the mean distance of a ring's vertices from their middle, as a part of the radius; away from the ends.
double thinnestRing(const std::vector<Vec3f>& positions) {
  double least = 1e9;
  for (int ring = 20; ring <= 60; ++ring) {
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < 24; ++i) middle += positions[24 * ring + i].cast<double>() / 24;
    double radius = 0;
    for (int i = 0; i < 24; ++i) radius += (positions[24 * ring + i].cast<double>() - middle).norm() / 24;
    least = std::min(least, radius);
  }
  return least / 0.1;
}

// Where it reaches twice the radius, as the paper's smoothing does on a limb of 24 vertices around.
TEST_P(EveryMush, JointKeepsItsWidthBetterThanWithLinearBlend) {
  const Deformer& deformer = findDeformer(GetParam());
  for (const double soft : {0.0, 0.2}) {
    const BoundMesh bent = bentTube(24, 81, soft, Quat(Eigen::AngleAxisd(2, Vec3::UnitZ()))),
                    twisted = bentTube(24, 81, soft, Quat(Eigen::AngleAxisd(2.5, Vec3::UnitX())));
    const auto prepared = preparedWith(GetParam(), bent, 0.2);
    EXPECT_GT(thinnestRing(bent.deformed(deformer, prepared.get())), 0.84) << soft;
    EXPECT_LT(thinnestRing(bent.deformed("linear-blend")), 0.79) << soft;
    EXPECT_GT(thinnestRing(twisted.deformed(deformer, prepared.get())), 0.55) << soft;
    EXPECT_LT(thinnestRing(twisted.deformed("linear-blend")), 0.32) << soft;
  }
}

// Whatever the weights: where they jump from one joint to the next, the surface bends over a distance.
TEST_P(EveryMush, NoEdgeIsTornAtAHardBoundary) {
  const BoundMesh bound = bentTube(24, 81, 0, Quat(Eigen::AngleAxisd(1.5, Vec3::UnitZ())));
  const auto maxStretched = [&](const std::vector<Vec3f>& positions) {
    float most = 0;
    for (const Triangle& t : bound.mesh.triangles) {
      const float before = (bound.mesh.positions[t[0]] - bound.mesh.positions[t[2]]).norm();
      most = std::max(most, (positions[t[0]] - positions[t[2]]).norm() / before);
    }
    return most;
  };
  const auto prepared = preparedWith(GetParam(), bound, 0.1);
  EXPECT_LT(maxStretched(bound.deformed(findDeformer(GetParam()), prepared.get())),
            0.5f * maxStretched(bound.deformed("linear-blend")));
}

TEST_P(EveryMush, FinenessOfTheTrianglesHardlyMatters) {
  const Quat turn(Eigen::AngleAxisd(1.5, Vec3::UnitZ()));
  const std::vector<Vec3f> coarse = bentTube(16, 41, 0.2, turn).deformed(GetParam()),
                           fine = bentTube(32, 81, 0.2, turn).deformed(GetParam());
  for (Index ring = 0; ring < 41; ++ring) {
    for (Index i = 0; i < 16; ++i) {
      EXPECT_LT((coarse[16 * ring + i] - fine[64 * ring + 2 * i]).norm(), 5e-3f) << ring << " " << i;
    }
  }
}

// Every triangle with corners of its own, as at seams of textures.
TEST_P(EveryMush, SeamsStayClosed) {
  const BoundMesh whole = boundAtRandom(testing::tube(12, 15, true));
  BoundMesh cut = whole;
  cut.mesh = {};
  cut.weights = {whole.weights.slots, {}, {}};
  std::vector<Index> of;
  for (const Triangle& t : whole.mesh.triangles) {
    const Index first = cut.mesh.vertexCount();
    cut.mesh.triangles.push_back({first, first + 1, first + 2});
    for (const Index v : t) {
      of.push_back(v);
      cut.mesh.positions.push_back(whole.mesh.positions[v]);
      for (Index s = 0; s < whole.weights.slots; ++s) {
        cut.weights.joints.push_back(whole.weights.jointsOf(v)[s]);
        cut.weights.weights.push_back(whole.weights.weightsOf(v)[s]);
      }
    }
  }
  const std::vector<Vec3f> expected = whole.deformed(GetParam()), out = cut.deformed(GetParam());
  std::vector<Index> firstCopy(whole.mesh.vertexCount(), kNoIndex);
  for (Index v = 0; v < out.size(); ++v) {
    if (firstCopy[of[v]] == kNoIndex) firstCopy[of[v]] = v;
    EXPECT_EQ(out[v], out[firstCopy[of[v]]]) << v;
    EXPECT_LT((out[v] - expected[of[v]]).norm(), 1e-5f) << v;
  }
}

// Two boxes of a robot that lie face on face and follow joints of their own.
TEST_P(EveryMush, PartsThatTouchStayApart) {
  BoundMesh bound;
  bound.mesh = testing::join(testing::flatGrid(6, 6), testing::flatGrid(6, 6));
  const Index half = bound.mesh.vertexCount() / 2;
  bound.weights.slots = 1;
  for (Index v = 0; v < 2 * half; ++v) bound.weights.joints.push_back(v / half), bound.weights.weights.push_back(1);
  bound.transforms = {Affine::Identity(), Affine(Eigen::Translation3d(0, 0, 1))};
  const std::vector<Vec3f> out = bound.deformed(GetParam());
  for (Index v = 0; v < half; ++v) {
    EXPECT_EQ(out[v], bound.mesh.positions[v]) << v;
    EXPECT_LT((out[half + v] - bound.mesh.positions[v] - Vec3f::UnitZ()).norm(), 1e-6f) << v;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMush, ::testing::Values("delta-mush", "direct-delta-mush"));

class MushCatalogue : public ::testing::TestWithParam<NamedMesh> {
 protected:
  static constexpr const char* kNames[] = {"delta-mush", "direct-delta-mush"};
};

TEST_P(MushCatalogue, IdentityGivesEveryBitBack) {
  BoundMesh bound = boundAtRandom(GetParam().mesh);
  std::fill(bound.transforms.begin(), bound.transforms.end(), Affine::Identity());
  for (const char* name : kNames) {
    const std::vector<Vec3f> out = bound.deformed(name);
    for (Index v = 0; v < out.size(); ++v) EXPECT_EQ(out[v], bound.mesh.positions[v]) << name << " " << v;
  }
}

TEST_P(MushCatalogue, OneMotionOfAllJointsIsTheSurfacesMotion) {
  BoundMesh bound = boundAtRandom(GetParam().mesh);
  const Affine motion = bound.transforms[1], scaled = motion * Eigen::Scaling(0.5, 1.5, 2.0);
  for (const Affine& map : {motion, scaled}) {
    std::fill(bound.transforms.begin(), bound.transforms.end(), map);
    for (const char* name : kNames) {
      const std::vector<Vec3f> out = bound.deformed(name);
      for (Index v = 0; v < out.size(); ++v) {
        EXPECT_LT((out[v].cast<double>() - map * bound.mesh.position(v)).norm(), 5e-6) << name << " " << v;
      }
    }
  }
}

TEST_P(MushCatalogue, StaysFiniteAndNearTheLinearBlend) {
  BoundMesh bound = boundAtRandom(GetParam().mesh);
  for (int scaled = 0; scaled < 2; ++scaled) {
    const std::vector<Vec3f> blended = bound.deformed("linear-blend");
    for (const char* name : kNames) {
      const std::vector<Vec3f> out = bound.deformed(name);
      for (Index v = 0; v < out.size(); ++v) EXPECT_LT((out[v] - blended[v]).norm(), 2.0f) << name << " " << v;
    }
    for (Affine& map : bound.transforms) map = map * Eigen::Scaling(1.2, 0.8, 1.0);
  }
}

TEST_P(MushCatalogue, ThreadsDoNotChangeABit) {
  const BoundMesh bound = boundAtRandom(GetParam().mesh);
  for (const char* name : kNames) {
    setThreadCount(1);
    const std::vector<Vec3f> one = bound.deformed(name);
    setThreadCount(3);
    const std::vector<Vec3f> three = bound.deformed(name);
    setThreadCount(0);
    EXPECT_EQ(one, three) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, MushCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

}  // namespace
}  // namespace limber
