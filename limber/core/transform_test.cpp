#include "limber/core/transform.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

Transform sample() {
  Transform t;
  t.translation = Vec3(1, -2, 3);
  t.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  t.scale = Vec3(2, 0.5, 3);
  return t;
}

TEST(Transform, ScalesThenTurnsThenMoves) {
  const Transform t = sample();
  const Vec3 point(0.3, 0.4, 0.5);
  const Vec3 expected = t.translation + t.rotation * Vec3(t.scale.cwiseProduct(point));
  EXPECT_LT((t.toAffine() * point - expected).norm(), 1e-15);
}

TEST(Transform, DecomposeGivesBackWhatWasComposed) {
  bool sheared = true;
  const Transform t = sample();
  const Transform back = decompose(t.toAffine(), &sheared);
  EXPECT_FALSE(sheared);
  EXPECT_LT((back.translation - t.translation).norm(), 1e-14);
  EXPECT_LT((back.scale - t.scale).norm(), 1e-14);
  EXPECT_LT(back.rotation.angularDistance(t.rotation), 1e-7);
}

TEST(Transform, DecomposeKeepsAMirror) {
  Affine mirror = sample().toAffine();
  mirror.linear().col(1) *= -1;
  const Transform back = decompose(mirror);
  EXPECT_LT((back.toAffine().matrix() - mirror.matrix()).norm(), 1e-12);
  EXPECT_NEAR(back.rotation.norm(), 1, 1e-12);
}

TEST(Transform, DecomposeSaysWhatItDrops) {
  Affine shear = Affine::Identity();
  shear.linear()(0, 1) = 0.5;
  bool sheared = false;
  const Transform back = decompose(shear, &sheared);
  EXPECT_TRUE(sheared);
  EXPECT_TRUE(back.toAffine().matrix().allFinite());
}

TEST(Transform, DecomposeAnswersForAFlattenedMap) {
  Affine flat = Affine::Identity();
  flat.linear() = Vec3(1, 0, 2).asDiagonal();
  const Transform back = decompose(flat);
  EXPECT_LT((back.toAffine().matrix() - flat.matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace limber
