#include "limber/rigging/body/medial_path.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {
namespace {

TEST(MedialPath, LeadsThroughTheLimbsAndNotAcrossTheGap) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const Vec3 right = person.shape.hand.cwiseProduct(Vec3(-1, 1, 1));
  const std::vector<Vec3> path = medialPath(person.body, person.shape.hand, right);
  ASSERT_GT(path.size(), 8u);
  EXPECT_LT((path.front() - person.shape.hand).norm(), 0.06);
  EXPECT_LT((path.back() - right).norm(), 0.06);
  double highest = 0;
  for (const Vec3& position : path) {
    EXPECT_LT(person.body.distance->at(position), 0) << "inside";
    highest = std::max(highest, position.y());
  }
  EXPECT_GT(highest, person.shape.shoulder.y() - 0.05) << "over the shoulders";
}

TEST(MedialPath, IsEmptyBetweenWhatDoesNotHangTogether) {
  TriMesh two;
  testing::addCapsule(two, {0, 0, 0}, {0, 0.3, 0}, 0.1);
  testing::addCapsule(two, {0.7, 0, 0}, {0.7, 0.3, 0}, 0.1);
  const BodyVolume body = measureBody(two);
  EXPECT_TRUE(medialPath(body, {0, 0, 0}, {0.7, 0, 0}).empty());
  EXPECT_FALSE(medialPath(body, {0, 0, 0}, {0, 0.3, 0}).empty());
}

TEST(MedialPath, SharesAreOfItsLength) {
  const std::vector<Vec3> path = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}};
  EXPECT_EQ(alongPath(path, 0), Vec3(0, 0, 0));
  EXPECT_LT((alongPath(path, 0.125) - Vec3(0.5, 0, 0)).norm(), 1e-12);
  EXPECT_LT((alongPath(path, 0.5) - Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT((alongPath(path, 1) - Vec3(1, 3, 0)).norm(), 1e-12);
  EXPECT_EQ(alongPath({{1, 2, 3}}, 0.7), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace limber
