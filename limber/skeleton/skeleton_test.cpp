#include "limber/skeleton/skeleton.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

Joint joint(const char* name, std::optional<Index> parent, const Vec3& translation) {
  Joint result;
  result.name = name;
  result.parent = parent;
  result.rest.translation = translation;
  return result;
}

Skeleton arm() {
  Skeleton skeleton;
  skeleton.joints = {joint("shoulder", std::nullopt, {1, 0, 0}), joint("elbow", 0, {2, 0, 0}),
                     joint("hand", 1, {0, 3, 0}), joint("other", std::nullopt, {0, 0, 9})};
  return skeleton;
}

std::string problemOf(const Skeleton& skeleton) {
  try {
    checkSkeleton(skeleton);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    return error.what();
  }
  return {};
}

TEST(Skeleton, IsSearchedByName) {
  EXPECT_EQ(arm().find("hand"), 2u);
  EXPECT_EQ(arm().find("foot"), std::nullopt);
}

TEST(Skeleton, GlobalsMultiplyDownTheTree) {
  Skeleton skeleton = arm();
  skeleton.joints[0].rest.rotation = Quat(Eigen::AngleAxisd(EIGEN_PI / 2, Vec3::UnitZ()));
  skeleton.joints[1].rest.scale = Vec3(2, 2, 2);
  const std::vector<Affine> globals = restGlobals(skeleton);
  EXPECT_TRUE(globals[1].translation().isApprox(Vec3(1, 2, 0), 1e-12));   // two along the turned x
  EXPECT_TRUE(globals[2].translation().isApprox(Vec3(-5, 2, 0), 1e-12));  // three along the turned y, twice as large
  EXPECT_TRUE(globals[3].translation().isApprox(Vec3(0, 0, 9), 1e-12));
}

TEST(Skeleton, APoseMovesOnlyWhatIsBelow) {
  const Skeleton skeleton = arm();
  std::vector<Transform> pose = restLocals(skeleton);
  pose[1].translation += Vec3(0, 0, 5);
  std::vector<Affine> posed(4);
  globalTransforms(skeleton, pose, posed);
  const std::vector<Affine> rest = restGlobals(skeleton);
  EXPECT_TRUE(posed[0].isApprox(rest[0]));
  EXPECT_TRUE((posed[2].translation() - rest[2].translation()).isApprox(Vec3(0, 0, 5)));
  EXPECT_TRUE(posed[3].isApprox(rest[3]));
}

TEST(Skeleton, SizesThatDoNotFitAreABadCall) {
  const Skeleton skeleton = arm();
  std::vector<Transform> locals(3);
  std::vector<Affine> globals(4);
  EXPECT_THROW(globalTransforms(skeleton, locals, globals), Error);
}

TEST(CheckSkeleton, NamesTheJointThatIsWrong) {
  EXPECT_EQ(problemOf(arm()), "");
  Skeleton skeleton = arm();
  skeleton.joints[1].parent = 2;
  EXPECT_THAT(problemOf(skeleton), HasSubstr("elbow"));
  skeleton = arm();
  skeleton.joints[2].parent = 2;  // its own parent
  EXPECT_THAT(problemOf(skeleton), HasSubstr("before its parent"));
  skeleton = arm();
  skeleton.joints[3].name = "hand";
  EXPECT_THAT(problemOf(skeleton), HasSubstr("name of another joint"));
  skeleton = arm();
  skeleton.joints[0].name.clear();
  EXPECT_THAT(problemOf(skeleton), HasSubstr("joint 0"));
  skeleton = arm();
  skeleton.joints[2].rest.translation.x() = std::nan("");
  EXPECT_THAT(problemOf(skeleton), HasSubstr("not finite"));
  skeleton = arm();
  skeleton.joints[2].radius = -1;
  EXPECT_THAT(problemOf(skeleton), HasSubstr("radius"));
}

}  // namespace
}  // namespace limber
