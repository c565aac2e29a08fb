#include "limber/skeleton/ik/solvers/jacobian.h"

#include <random>

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/core/small_solve.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"
#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

namespace limber {
namespace {

// Central differences of the residual along each column against the column.
void expectDerivatives(IkSystem& system) {
  std::vector<double> gains = freedomsOf(system);
  for (double& gain : gains) gain *= 0.7;
  IkJacobian jacobian(system, gains);
  jacobian.build(system);
  IkSystem::State start = system.makeState();
  constexpr double kStep = 1e-5;
  Eigen::VectorXd ahead(jacobian.rows()), behind(jacobian.rows());
  Eigen::VectorXd step = Eigen::VectorXd::Zero(jacobian.maxColumns());
  for (Eigen::Index c = 0; c < jacobian.columns(); ++c) {
    const int node = jacobian.freedoms[static_cast<std::size_t>(c)].node;
    const auto n = static_cast<std::size_t>(node);
    const auto move = [&](double by, Eigen::VectorXd& residual) {
      step.setZero();
      step[c] = by;
      system.locals[n] = system.locals[n] * fromRotationVector(jacobian.turnOf(node, step));
      system.offsets[n] += jacobian.slideOf(node, step);
      system.forward();
      jacobian.residual(system, residual);
      system.restore(start);
    };
    move(kStep, ahead);
    move(-kStep, behind);
    const Eigen::VectorXd slope = (behind - ahead) / (2 * kStep);  // the residual is target - effector
    EXPECT_LT((slope - jacobian.matrix.col(c)).norm(), 1e-7) << "column " << c;
  }
}

void poseAtRandom(IkSystem& system, std::mt19937_64& generator) {
  std::uniform_real_distribution<> uniform;
  static const JointLimit kFree;
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3 numbers(uniform(generator), uniform(generator), uniform(generator));
    system.locals[i] = allowedRotation(system.nodes[i].limit ? *system.nodes[i].limit : kFree, numbers);
  }
  system.forward();
}

TEST(Jacobian, ColumnsAreDerivatives) {
  std::mt19937_64 generator(5);
  const Skeleton humanoid = practiceHumanoid();
  const JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
  std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
  targets[2].weight = 3;
  targets[4].priority = 1;
  IkOptions options;
  options.rootMotion = RootMotion::kTranslate;
  for (const JointLimits* some : {static_cast<const JointLimits*>(nullptr), &limits}) {
    IkSystem system(humanoid, targets, some, options);
    system.load(restPose(humanoid), targets);
    for (int i = 0; i < 5; ++i) {
      poseAtRandom(system, generator);
      expectDerivatives(system);
    }
  }
}

// Orientation rows near their target, where the rotation vector's own derivative is the identity.
TEST(Jacobian, OrientationColumnsAreDerivatives) {
  std::mt19937_64 generator(6);
  const Skeleton chain = straightChain(6, 1);
  std::vector<IkTarget> targets(1);
  targets[0].joint = 5;
  targets[0].orientation = Quat::Identity();
  IkSystem system(chain, targets, nullptr, {});
  for (int i = 0; i < 5; ++i) {
    system.load(restPose(chain), targets);
    poseAtRandom(system, generator);
    system.effectors[0].orientation = system.globals[5];
    expectDerivatives(system);
  }
}

TEST(Jacobian, SlidingJointsHaveTheirColumns) {
  const Skeleton chain = straightChain(4, 1);
  JointLimits limits;
  limits.joints.resize(4);
  limits.joints[1].motion = PlaneJoint{{-1, 1}, {-1, 1}};
  limits.joints[1].axes = fromRotationVector(Vec3(0.3, 0.4, 0.5));
  limits.joints[1].restTranslation = chain.joints[1].rest.translation;
  std::vector<IkTarget> targets(1);
  targets[0].joint = 3;
  IkSystem system(chain, targets, &limits, {});
  system.load(restPose(chain), targets);
  IkJacobian jacobian(system, freedomsOf(system));
  jacobian.build(system);
  EXPECT_EQ(jacobian.columns(), 3 + 2 + 3 + 3);
  expectDerivatives(system);
}

TEST(SmallSolve, CholeskySolvesAndLeavesSingularDirectionsOut) {
  std::mt19937_64 generator(7);
  std::normal_distribution<> normal;
  for (Eigen::Index m = 1; m <= 12; ++m) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::NullaryExpr(m, m + 3, [&] { return normal(generator); });
    const Eigen::MatrixXd a = b * b.transpose();
    const Eigen::VectorXd right = Eigen::VectorXd::NullaryExpr(m, [&] { return normal(generator); });
    Eigen::MatrixXd work = a;
    Eigen::VectorXd x = right;
    solveCholesky(work, 0.5, x);
    EXPECT_LT((a * x + 0.5 * x - right).norm(), 1e-9);
  }
  Eigen::MatrixXd singular = Eigen::Vector3d(1, 0, 2).asDiagonal();
  Eigen::VectorXd x = Eigen::Vector3d(1, 1, 1);
  solveCholesky(singular, 0, x);
  EXPECT_LT((x - Eigen::Vector3d(1, 0, 0.5)).norm(), 1e-12);
}

TEST(SmallSolve, EigenvectorsDiagonalise) {
  std::mt19937_64 generator(8);
  std::normal_distribution<> normal;
  for (Eigen::Index m = 1; m <= 12; ++m) {
    const Eigen::MatrixXd b =
        Eigen::MatrixXd::NullaryExpr(m, std::max<Eigen::Index>(1, m - 2), [&] { return normal(generator); });
    const Eigen::MatrixXd a = b * b.transpose();
    Eigen::MatrixXd values = a, vectors(m, m);
    symmetricEigen(values, vectors);
    EXPECT_LT((vectors * vectors.transpose() - Eigen::MatrixXd::Identity(m, m)).norm(), 1e-12);
    EXPECT_LT((vectors * values.diagonal().asDiagonal() * vectors.transpose() - a).norm(), 1e-11 * (1 + a.norm()));
  }
}

}  // namespace
}  // namespace limber
