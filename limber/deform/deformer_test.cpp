// The deformers against the same sums in double, written down from their definitions.
#include "limber/deform/deformer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"
#include "limber/deform/centers_of_rotation.h"
#include "limber/deform/deform_kernels.h"
#include "limber/deform/testing/bent_tube.h"
#include "limber/skeleton/pose.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

struct Scene {
  std::vector<Vec3f> positions, normals;
  SkinWeights weights;
  std::vector<Affine> transforms;
  std::vector<Vec3> centers;
  std::vector<Triangle> triangles;
  std::shared_ptr<const RotationCenters> rotationCenters;

  Index jointCount() const { return static_cast<Index>(transforms.size()); }
  // As prepared for the deformer; random rotation centers, where there are any.
  std::shared_ptr<const DeformPreparation> prepared(const Deformer& deformer) const {
    if (deformer.prepare == &prepareRotationCenters && rotationCenters) return rotationCenters;
    return prepareDeformer(deformer, {positions, triangles, weights}, jointCount());
  }
  DeformInput input(const DeformPreparation* preparation) const {
    return {positions, normals, weights, transforms, centers, preparation};
  }
};

struct Deformed {
  std::vector<Vec3f> positions, normals;
};

Deformed run(std::string_view name, const Scene& scene) {
  const Deformer& deformer = findDeformer(name);
  const auto prepared = scene.prepared(deformer);
  std::vector<float> scratch(deformer.scratchSize(scene.positions.size(), scene.jointCount()));
  Deformed out = {std::vector<Vec3f>(scene.positions.size()), std::vector<Vec3f>(scene.normals.size())};
  deformer.deform(scene.input(prepared.get()), {out.positions, out.normals}, scratch);
  return out;
}

class RandomValues {
 public:
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Vec3 vector() { return {in(-1, 1), in(-1, 1), in(-1, 1)}; }
  Quat rotation(double maxAngle) { return Quat(Eigen::AngleAxisd(in(-maxAngle, maxAngle), vector().normalized())); }
  Index below(Index count) { return static_cast<Index>(generator_() % count); }

 private:
  std::mt19937 generator_{7};
};

enum class Maps { kIdentity, kRigid, kScaled, kSheared };

Affine randomMap(RandomValues& random, Maps kind, const Vec3& center) {
  Affine map = Affine::Identity();
  if (kind == Maps::kIdentity) return map;
  map.linear() = random.rotation(2.0).toRotationMatrix();
  if (kind == Maps::kScaled) map.linear() *= Vec3(random.in(0.5, 2), random.in(0.5, 2), random.in(0.5, 2)).asDiagonal();
  if (kind == Maps::kSheared) {
    map.linear() *= Mat3::Identity() + 0.3 * (Mat3() << random.vector(), random.vector(), random.vector()).finished();
  }
  map.translation() = center + 0.5 * random.vector() - map.linear() * center;
  return map;
}

Scene randomScene(Index vertices, Index slots, Maps kind) {
  RandomValues random;
  Scene scene;
  auto rotationCenters = std::make_shared<RotationCenters>();
  constexpr Index kJoints = 9;
  for (Index j = 0; j < kJoints; ++j) {
    scene.centers.push_back(random.vector());
    scene.transforms.push_back(randomMap(random, kind, scene.centers.back()));
  }
  scene.weights.slots = slots;
  for (Index v = 0; v < vertices; ++v) {
    scene.positions.push_back(random.vector().cast<float>());
    scene.normals.push_back(random.vector().normalized().cast<float>());
    rotationCenters->centers.push_back(random.vector().cast<float>());
    std::vector<double> raw;
    for (Index s = 0; s < slots; ++s) raw.push_back(random.in(0.01, 1));
    std::sort(raw.rbegin(), raw.rend());
    double sum = 0;
    for (const double w : raw) sum += w;
    for (Index s = 0; s < slots; ++s) {
      scene.weights.joints.push_back(random.below(kJoints));
      scene.weights.weights.push_back(static_cast<float>(raw[s] / sum));
    }
  }
  scene.rotationCenters = std::move(rotationCenters);
  return scene;
}

Mat4 blendedMatrix(const Scene& scene, Index v) {
  Mat4 sum = Mat4::Zero();
  for (Index s = 0; s < scene.weights.slots; ++s) {
    sum += scene.weights.weightsOf(v)[s] * scene.transforms[scene.weights.jointsOf(v)[s]].matrix();
  }
  return sum;
}

Vec3 linearOracle(const Scene& scene, Index v) {
  return (blendedMatrix(scene, v) * scene.positions[v].cast<double>().homogeneous()).head<3>();
}

// Kavan et al. 2008, sections 3 and 4, by quaternion products as there.
Vec3 dualOracle(const Scene& scene, Index v) {
  Mat3 stretch = Mat3::Zero();
  Vec3 offset = Vec3::Zero();
  Vec4 real = Vec4::Zero(), dual = Vec4::Zero();
  std::optional<Quat> pivot;
  for (Index s = 0; s < scene.weights.slots; ++s) {
    const Index joint = scene.weights.jointsOf(v)[s];
    const double weight = scene.weights.weightsOf(v)[s];
    const Affine& map = scene.transforms[joint];
    const Vec3 center = scene.centers.empty() ? Vec3(Vec3::Zero()) : scene.centers[joint];
    // Polar decomposition by the matrix root: L = R S, S^2 = L^T L.
    const Eigen::SelfAdjointEigenSolver<Mat3> squares(map.linear().transpose() * map.linear());
    const Mat3 s0 = squares.operatorSqrt();
    const Mat3 rotation = map.linear() * s0.inverse();
    stretch += weight * s0;
    offset += weight * (center - s0 * center);
    const Vec3 t = map * center - rotation * center;
    Quat q(rotation);
    if (!pivot) pivot = q;
    if (pivot->dot(q) < 0) q.coeffs() = -q.coeffs();
    real += weight * q.coeffs();
    dual += weight * 0.5 * (Quat(0, t.x(), t.y(), t.z()) * q).coeffs();
  }
  const double norm = real.norm();
  const Quat r(Vec4(real / norm)), d(Vec4(dual / norm));
  const Vec3 translation = 2.0 * (d * r.conjugate()).vec();
  return r * (stretch * scene.positions[v].cast<double>() + offset) + translation;
}

// Le, Hodgins 2016, equations 2 to 4, with the stretch as another linear blend.
Vec3 centeredOracle(const Scene& scene, Index v) {
  Mat3 stretch = Mat3::Zero();
  Vec4 turn = Vec4::Zero();
  std::optional<Quat> pivot;
  for (Index s = 0; s < scene.weights.slots; ++s) {
    const double weight = scene.weights.weightsOf(v)[s];
    const Mat3 linear = scene.transforms[scene.weights.jointsOf(v)[s]].linear();
    const Mat3 s0 = Eigen::SelfAdjointEigenSolver<Mat3>(linear.transpose() * linear).operatorSqrt();
    Quat q(Mat3(linear * s0.inverse()));
    if (!pivot) pivot = q;
    if (pivot->dot(q) < 0) q.coeffs() = -q.coeffs();
    turn += weight * q.coeffs();
    stretch += weight * s0;
  }
  const Vec3 center = scene.rotationCenters->centers[v].cast<double>();
  const Vec3 arm = stretch * (scene.positions[v].cast<double>() - center);
  return (blendedMatrix(scene, v) * center.homogeneous()).head<3>() + Quat(turn).normalized() * arm;
}

void expectNear(const Vec3f& actual, const Vec3& wanted, double tolerance, Index v) {
  EXPECT_LE((actual.cast<double>() - wanted).cwiseAbs().maxCoeff(), tolerance)
      << "vertex " << v << ": " << actual.transpose() << " for " << wanted.transpose();
}

struct Case {
  Index vertices, slots;
  Maps kind;
};

class DeformerTest : public ::testing::TestWithParam<Case> {
 protected:
  Scene scene() const { return randomScene(GetParam().vertices, GetParam().slots, GetParam().kind); }
};

TEST_P(DeformerTest, LinearBlendIsTheWeightedSum) {
  const Scene s = scene();
  const Deformed out = run("linear-blend", s);
  for (Index v = 0; v < s.positions.size(); ++v) expectNear(out.positions[v], linearOracle(s, v), 2e-6, v);
}

TEST_P(DeformerTest, LinearBlendNormalIsThatOfTheBlendedTangents) {
  const Scene s = scene();
  const Deformed out = run("linear-blend", s);
  for (Index v = 0; v < s.positions.size(); ++v) {
    const Mat3 linear = blendedMatrix(s, v).topLeftCorner<3, 3>();
    if (linear.determinant() < 0.05) continue;  // all but folded flat
    expectNear(out.normals[v], (linear.inverse().transpose() * s.normals[v].cast<double>()).normalized(), 2e-4, v);
  }
}

TEST_P(DeformerTest, DualQuaternionIsTwoPhases) {
  const Scene s = scene();
  const Deformed out = run("dual-quaternion", s);
  for (Index v = 0; v < s.positions.size(); ++v) expectNear(out.positions[v], dualOracle(s, v), 5e-5, v);
}

TEST_P(DeformerTest, CentersOfRotationTurnAboutThem) {
  const Scene s = scene();
  const Deformed out = run("centers-of-rotation", s);
  for (Index v = 0; v < s.positions.size(); ++v) expectNear(out.positions[v], centeredOracle(s, v), 5e-5, v);
}

TEST_P(DeformerTest, EveryBuildOfTheInnerLoopsGivesTheSameBits) {
  if (!avx2DeformKernels()) GTEST_SKIP() << "no AVX2 here";
  const Scene s = scene();
  const std::size_t count = s.positions.size();
  std::vector<float> columns(kFloatsPerColumns * 9), stretches(columns.size()), motions(kFloatsPerMotion * 9);
  RandomValues random;
  for (float& x : columns) x = static_cast<float>(random.in(-1, 1));
  for (float& x : stretches) x = static_cast<float>(random.in(-1, 1));
  for (float& x : motions) x = static_cast<float>(random.in(-1, 1));
  const auto bits = [&](DeformKernel kernel, bool normals) {
    std::vector<float> out(6 * count);
    const DeformJob job = {s.positions[0].data(),
                           normals ? s.normals[0].data() : nullptr,
                           out.data(),
                           normals ? out.data() + 3 * count : nullptr,
                           s.weights.joints.data(),
                           s.weights.weights.data(),
                           s.weights.slots,
                           columns.data(),
                           stretches.data(),
                           motions.data(),
                           s.rotationCenters->centers[0].data()};
    kernel(job, 0, count);
    return out;
  };
  const bool four = s.weights.slots == 4;
  const DeformKernels& plain = baselineDeformKernels();
  for (const DeformKernels* kernels : {avx2DeformKernels(), avx512DeformKernels()}) {
    if (!kernels) continue;
    for (const bool normals : {false, true}) {
      EXPECT_EQ(bits(kernels->linear[four][normals], normals), bits(plain.linear[four][normals], normals)) << normals;
      EXPECT_EQ(bits(kernels->dual[four][normals][1], normals), bits(plain.dual[four][normals][1], normals)) << normals;
      EXPECT_EQ(bits(kernels->centered[four][normals][1], normals), bits(plain.centered[four][normals][1], normals))
          << normals;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeformerTest,
                         ::testing::Values(Case{1, 4, Maps::kRigid}, Case{7, 4, Maps::kRigid},
                                           Case{400, 4, Maps::kRigid}, Case{64, 1, Maps::kRigid},
                                           Case{65, 3, Maps::kRigid}, Case{63, 8, Maps::kRigid},
                                           Case{200, 4, Maps::kScaled}, Case{50, 6, Maps::kScaled},
                                           Case{200, 4, Maps::kSheared}, Case{61, 2, Maps::kSheared}));

class EveryDeformer : public ::testing::TestWithParam<std::string_view> {};

std::vector<std::uint32_t> bitsOf(std::span<const Vec3f> vectors) {
  std::vector<std::uint32_t> bits;
  for (const Vec3f& v : vectors) {
    for (int i = 0; i < 3; ++i) bits.push_back(std::bit_cast<std::uint32_t>(v[i]));
  }
  return bits;
}

TEST_P(EveryDeformer, IdentityGivesEveryBitBack) {
  Scene s = randomScene(301, 4, Maps::kIdentity);
  s.positions[0] = {-0.0f, 0.0f, 1e-38f};
  s.positions[300] = {1e-45f, -1e30f, -0.0f};
  s.normals[3] = {-0.0f, -1.0f, 0.0f};
  const Deformed out = run(GetParam(), s);
  EXPECT_EQ(bitsOf(out.positions), bitsOf(s.positions));
  EXPECT_EQ(bitsOf(out.normals), bitsOf(s.normals));
}

TEST_P(EveryDeformer, OnlyVerticesBoundToMovedJointsChange) {
  Scene s = randomScene(301, 4, Maps::kIdentity);
  s.transforms[2] = Affine(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  const Deformed out = run(GetParam(), s);
  for (Index v = 0; v < 301; ++v) {
    const auto joints = s.weights.jointsOf(v);
    if (std::find(joints.begin(), joints.end(), 2u) == joints.end()) {
      EXPECT_EQ(out.positions[v], s.positions[v]) << v;
      EXPECT_EQ(out.normals[v], s.normals[v]) << v;
    } else {
      EXPECT_NE(out.positions[v], s.positions[v]) << v;
    }
  }
}

TEST_P(EveryDeformer, VertexWithoutWeightsStays) {
  Scene s = randomScene(6, 4, Maps::kScaled);
  std::fill(s.weights.weights.begin(), s.weights.weights.end(), 0.0f);
  const Deformed out = run(GetParam(), s);
  EXPECT_EQ(bitsOf(out.positions), bitsOf(s.positions));
  s.weights = {};
  EXPECT_EQ(bitsOf(run(GetParam(), s).positions), bitsOf(s.positions));
}

TEST_P(EveryDeformer, OneMotionForAllJointsMovesTheWholeModelByIt) {
  Scene s = randomScene(50, 4, Maps::kRigid);
  const Affine motion = s.transforms[0];
  std::fill(s.transforms.begin(), s.transforms.end(), motion);
  const Deformed out = run(GetParam(), s);
  for (Index v = 0; v < 50; ++v) {
    expectNear(out.positions[v], motion * s.positions[v].cast<double>(), 1e-6, v);
    expectNear(out.normals[v], motion.linear() * s.normals[v].cast<double>(), 1e-6, v);
  }
}

TEST_P(EveryDeformer, MirroringJointKeepsNormalsOnTheirSide) {
  Scene s = randomScene(10, 4, Maps::kIdentity);
  const Affine mirror(Eigen::Scaling(-1.0, 1.0, 1.0));
  std::fill(s.transforms.begin(), s.transforms.end(), mirror);
  const Deformed out = run(GetParam(), s);
  for (Index v = 0; v < 10; ++v) {
    expectNear(out.positions[v], mirror * s.positions[v].cast<double>(), 1e-6, v);
    expectNear(out.normals[v], mirror.linear() * s.normals[v].cast<double>(), 1e-6, v);
  }
}

TEST_P(EveryDeformer, MayWriteOverItsInput) {
  Scene s = randomScene(103, 4, Maps::kScaled);
  const Deformed apart = run(GetParam(), s);
  const Deformer& deformer = findDeformer(GetParam());
  const auto prepared = s.prepared(deformer);
  std::vector<float> scratch(deformer.scratchSize(s.positions.size(), 9));
  deformer.deform(s.input(prepared.get()), {s.positions, s.normals}, scratch);
  EXPECT_EQ(bitsOf(s.positions), bitsOf(apart.positions));
  EXPECT_EQ(bitsOf(s.normals), bitsOf(apart.normals));
}

TEST_P(EveryDeformer, ThreadsDoNotChangeABit) {
  const Scene s = randomScene(20011, 4, Maps::kScaled);
  setThreadCount(1);
  const Deformed one = run(GetParam(), s);
  setThreadCount(3);
  const Deformed three = run(GetParam(), s);
  setThreadCount(0);
  EXPECT_EQ(bitsOf(one.positions), bitsOf(three.positions));
  EXPECT_EQ(bitsOf(one.normals), bitsOf(three.normals));
}

TEST_P(EveryDeformer, SizesThatDoNotMatchAreRefused) {
  Scene s = randomScene(10, 4, Maps::kRigid);
  const Deformer& deformer = findDeformer(GetParam());
  const auto prepared = s.prepared(deformer);
  const DeformInput input = s.input(prepared.get());
  std::vector<float> scratch(deformer.scratchSize(10, 9));
  std::vector<Vec3f> out(10), tooFew(9);
  EXPECT_THROW(deformer.deform(input, {tooFew, {}}, scratch), Error);
  EXPECT_THROW(deformer.deform(input, {out, tooFew}, scratch), Error);
  EXPECT_THROW(deformer.deform(input, {out, {}}, std::span(scratch).first(8)), Error);
  s.weights.weights.pop_back();
  EXPECT_THROW(deformer.deform(input, {out, {}}, scratch), Error);
}

TEST_P(EveryDeformer, NeedsItsOwnPreparation) {
  const Scene s = randomScene(10, 4, Maps::kRigid), other = randomScene(11, 4, Maps::kRigid);
  const Deformer& deformer = findDeformer(GetParam());
  if (!deformer.prepare) GTEST_SKIP() << "prepares nothing";
  struct : DeformPreparation {
  } foreign;
  const auto forOther = other.prepared(deformer);
  std::vector<float> scratch(deformer.scratchSize(10, 9));
  std::vector<Vec3f> out(10);
  for (const DeformPreparation* wrong : {static_cast<const DeformPreparation*>(nullptr),
                                         static_cast<const DeformPreparation*>(&foreign), forOther.get()}) {
    EXPECT_THROW(deformer.deform(s.input(wrong), {out, {}}, scratch), Error);
  }
}

TEST_P(EveryDeformer, RefusesToPrepareWhatDoesNotFit) {
  Scene s = randomScene(10, 4, Maps::kRigid);
  const Deformer& deformer = findDeformer(GetParam());
  if (!deformer.prepare) GTEST_SKIP() << "prepares nothing";
  s.rotationCenters = nullptr;
  EXPECT_NO_THROW(s.prepared(deformer));
  EXPECT_THROW(prepareDeformer(deformer, {s.positions, s.triangles, s.weights}, 3), Error);
  s.triangles = {{0, 1, 10}};
  EXPECT_THROW(s.prepared(deformer), Error);
  s.triangles.clear();
  s.positions.pop_back();
  EXPECT_THROW(s.prepared(deformer), Error);
}

// The sums of DeformRows in double.
Vec3 rowsOracle(const DeformRows& rows, std::span<const Vec3f> positions, std::span<const Affine> transforms, Index v) {
  const Vec3 position = positions[v].cast<double>();
  const Index row = rows.rowOf[v];
  if (rows.begin[row] == rows.begin[row + 1]) return position;
  const float* at = rows.positions.data() + 4 * std::size_t{row};
  const Vec3 point(at[0], at[1], at[2]);
  Vec3 sum = point;
  Mat3 stretch = Mat3::Zero();
  Vec4 turn = Vec4::Zero();
  std::optional<Quat> pivot;
  double total = 0;
  for (std::size_t e = rows.begin[row]; e < rows.begin[row + 1]; ++e) {
    for (std::size_t i = 0; i < 4; ++i) {
      const float* m = rows.moments.data() + kFloatsPerMoments * e + i;
      const Vec4 moment(m[0], m[4], m[8], m[12]);
      const Affine& map = transforms[rows.joints[4 * e + i]];
      const Mat3 linear = map.linear();
      const Mat3 s0 = Eigen::SelfAdjointEigenSolver<Mat3>(linear.transpose() * linear).operatorSqrt();
      Quat q(Mat3(linear * s0.inverse()));
      if (!pivot) pivot = q;
      if (pivot->dot(q) < 0) q.coeffs() = -q.coeffs();
      sum += (map.matrix() * moment - moment).head<3>();
      turn += moment.w() * q.coeffs();
      stretch += moment.w() * (s0 - Mat3::Identity());
      total += moment.w();
    }
  }
  EXPECT_NEAR(total, 1, 1e-4) << v;
  return sum + Quat(turn).normalized() * (Vec3((Mat3::Identity() + stretch) * (position - point)));
}

TEST_P(EveryDeformer, ItsRowsMoveVerticesAsItDoes) {
  const Deformer& deformer = findDeformer(GetParam());
  if (!deformer.rows) GTEST_SKIP() << "rows cannot say it";
  for (const Index slots : {1u, 4u, 6u}) {
    const Scene s = randomScene(60, slots, slots == 4 ? Maps::kRigid : Maps::kScaled);
    const auto prepared = s.prepared(deformer);
    const auto rows = deformer.rows({s.positions, s.triangles, s.weights}, prepared);
    const Deformed out = run(GetParam(), s);
    for (Index v = 0; v < 60; ++v) {
      expectNear(out.positions[v], rowsOracle(*rows, s.positions, s.transforms, v), 5e-5, v);
    }
  }
  for (const double angle : {0.0, 0.7, 2.0}) {
    const testing::BoundMesh tube =
        testing::bentTube(12, 17, 0.2, Quat(Eigen::AngleAxisd(angle, Vec3(1, 0, 2).normalized())));
    const auto prepared = prepareDeformer(deformer, tube.surface(), 2);
    const auto rows = deformer.rows(tube.surface(), prepared);
    const std::vector<Vec3f> out = tube.deformed(deformer, prepared.get());
    for (Index v = 0; v < out.size(); ++v) {
      expectNear(out[v], rowsOracle(*rows, tube.mesh.positions, tube.transforms, v), 1e-5, v);
    }
  }
}

TEST_P(EveryDeformer, RowsNeedItsOwnPreparation) {
  const Deformer& deformer = findDeformer(GetParam());
  if (!deformer.rows) GTEST_SKIP() << "rows cannot say it";
  const Scene s = randomScene(10, 4, Maps::kRigid), other = randomScene(11, 4, Maps::kRigid);
  const BoundSurface surface = {s.positions, s.triangles, s.weights};
  EXPECT_THROW(deformer.rows(surface, nullptr), Error);
  EXPECT_THROW(deformer.rows(surface, other.prepared(deformer)), Error);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryDeformer, ::testing::ValuesIn([] {
                           std::vector<std::string_view> names;
                           for (const Deformer& deformer : deformers()) names.push_back(deformer.name);
                           return names;
                         }()));

// A tube along x, its far half twisted about x: the classic case that tells the two apart.
Scene twistedMiddle(double angle) {
  Scene s;
  for (int i = 0; i < 16; ++i) s.positions.emplace_back(0.0f, std::cos(i * kPi / 8), std::sin(i * kPi / 8));
  s.weights.slots = 2;
  for (int i = 0; i < 16; ++i) {
    s.weights.joints.insert(s.weights.joints.end(), {0, 1});
    s.weights.weights.insert(s.weights.weights.end(), {0.5f, 0.5f});
  }
  s.transforms = {Affine::Identity(), Affine(Eigen::AngleAxisd(angle, Vec3::UnitX()))};
  return s;
}

TEST(DualQuaternion, TwistKeepsTheRadiusWhereLinearBlendLosesIt) {
  const Scene s = twistedMiddle(2.0);
  for (const Vec3f& p : run("dual-quaternion", s).positions) EXPECT_NEAR(p.norm(), 1.0, 1e-6);
  for (const Vec3f& p : run("linear-blend", s).positions) EXPECT_NEAR(p.norm(), std::cos(1.0), 1e-6);
}

// A forearm twice its length, bent at an elbow far from the origin: the elbow itself must stay.
TEST(DualQuaternion, ScaleAboutTheJointKeepsTheJoint) {
  const Vec3 elbow(1.5, 1.2, 0.3);
  Scene s;
  s.positions = {elbow.cast<float>()};
  s.weights = {2, {0, 1}, {0.5f, 0.5f}};
  Affine forearm(Eigen::Translation3d(elbow) * Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  forearm = forearm * Eigen::Scaling(2.0) * Eigen::Translation3d(-elbow);
  s.transforms = {Affine::Identity(), forearm};
  s.centers = {Vec3::Zero(), elbow};
  expectNear(run("dual-quaternion", s).positions[0], elbow, 1e-6, 0);
}

TEST(DeformerTable, NamesWhatThereIs) {
  try {
    findDeformer("mush");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("linear-blend, dual-quaternion"));
  }
}

TEST(CheckWeights, NamesTheVertex) {
  EXPECT_NO_THROW(checkWeights({2, {0, 1, 1, 0}, {1, 0, 0.5f, 0.5f}}, 2));
  EXPECT_THROW(checkWeights({1, {0, 2}, {1, 1}}, 2), Error);
  EXPECT_THROW(checkWeights({1, {0, 1}, {1, std::nanf("")}}, 2), Error);
  EXPECT_THROW(checkWeights({1, {0, 1}, {1, -1}}, 2), Error);
}

}  // namespace
}  // namespace limber
