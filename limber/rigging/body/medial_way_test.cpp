#include "limber/rigging/body/medial_way.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {
namespace {

TEST(MedialWay, LeadsThroughTheLimbsAndNotAcrossTheGap) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const Vec3 right = person.shape.hand.cwiseProduct(Vec3(-1, 1, 1));
  const std::vector<Vec3> way = medialWay(person.body, person.shape.hand, right);
  ASSERT_GT(way.size(), 8u);
  EXPECT_LT((way.front() - person.shape.hand).norm(), 0.06);
  EXPECT_LT((way.back() - right).norm(), 0.06);
  double highest = 0;
  for (const Vec3& place : way) {
    EXPECT_LT(person.body.distance->at(place), 0) << "inside";
    highest = std::max(highest, place.y());
  }
  EXPECT_GT(highest, person.shape.shoulder.y() - 0.05) << "over the shoulders";
}

TEST(MedialWay, IsEmptyBetweenWhatDoesNotHangTogether) {
  TriMesh two;
  testing::addCapsule(two, {0, 0, 0}, {0, 0.3, 0}, 0.1);
  testing::addCapsule(two, {0.7, 0, 0}, {0.7, 0.3, 0}, 0.1);
  const BodyVolume body = measureBody(two);
  EXPECT_TRUE(medialWay(body, {0, 0, 0}, {0.7, 0, 0}).empty());
  EXPECT_FALSE(medialWay(body, {0, 0, 0}, {0, 0.3, 0}).empty());
}

TEST(MedialWay, SharesAreOfItsLength) {
  const std::vector<Vec3> way = {{0, 0, 0}, {1, 0, 0}, {1, 3, 0}};
  EXPECT_EQ(alongWay(way, 0), Vec3(0, 0, 0));
  EXPECT_LT((alongWay(way, 0.125) - Vec3(0.5, 0, 0)).norm(), 1e-12);
  EXPECT_LT((alongWay(way, 0.5) - Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT((alongWay(way, 1) - Vec3(1, 3, 0)).norm(), 1e-12);
  EXPECT_EQ(alongWay({{1, 2, 3}}, 0.7), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace limber
