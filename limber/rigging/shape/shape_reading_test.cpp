#include "limber/rigging/shape/shape_reading.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/capsule_animal.h"
#include "limber/rigging/body/testing/capsule_person.h"

namespace limber {
namespace {

std::optional<ShapeReading> readingOf(const TriMesh& mesh) {
  const testing::MeasuredAnimal animal = testing::measured(mesh);
  return readShape(animal.body, animal.frames, false);
}

struct Case {
  const char* name;
  TriMesh (*mesh)();
  BodyPlan plan;
  std::size_t legs;
};

class ShapeReadingTest : public ::testing::TestWithParam<Case> {};

TEST_P(ShapeReadingTest, TellsWhatABodyStandsOn) {
  const std::optional<ShapeReading> reading = readingOf(GetParam().mesh());
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->plan, GetParam().plan);
  EXPECT_GT(reading->confidence, 0.6);
  EXPECT_EQ(reading->legs().size(), GetParam().legs);
  ASSERT_EQ(reading->along.size(), reading->trunk().points.size());
  EXPECT_EQ(reading->along.front(), 0);
  EXPECT_EQ(reading->along.back(), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, ShapeReadingTest,
    ::testing::Values(Case{"person", [] { return testing::capsulePerson().mesh; }, BodyPlan::kUpright, 1},
                      Case{"hound", &testing::capsuleHound, BodyPlan::kFourLegs, 2},
                      Case{"theropod", &testing::capsuleTheropod, BodyPlan::kTwoLegs, 1},
                      Case{"insect", [] { return testing::capsuleSpider(3); }, BodyPlan::kManyLegs, 3},
                      Case{"spider", [] { return testing::capsuleSpider(4); }, BodyPlan::kManyLegs, 4},
                      Case{"fish", &testing::capsuleFish, BodyPlan::kSwimming, 0},
                      Case{"snake", &testing::capsuleSnake, BodyPlan::kCrawling, 0}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ShapeReading, BeginsTheTrunkAtTheHead) {
  for (TriMesh (*mesh)() : {&testing::capsuleHound, &testing::capsuleTheropod, &testing::capsuleSnake}) {
    const std::optional<ShapeReading> reading = readingOf(mesh());
    ASSERT_TRUE(reading);
    EXPECT_GT(reading->trunk().points.front().position.z(), reading->trunk().end().z() + 0.5);
    EXPECT_GT(reading->frame.axes(2, 2), 0.9) << "faces +Z";
  }
}

// An animal whose nose is at -Z is found to face -Z, unless the front is given.
TEST(ShapeReading, FindsTheFrontOfAnAnimalThatIsTurned) {
  TriMesh turned = testing::capsuleTheropod();
  for (Vec3f& p : turned.positions) p = Vec3f(-p.x(), p.y(), -p.z());
  const testing::MeasuredAnimal animal = testing::measured(turned);
  EXPECT_LT(readShape(animal.body, animal.frames, false)->frame.axes(2, 2), -0.9);
  EXPECT_GT(readShape(animal.body, animal.frames, true)->frame.axes(2, 2), 0.9);
}

TEST(ShapeReading, SaysNothingOfABall) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.5, 0}, {0, 0.52, 0}, 0.5);
  const std::optional<ShapeReading> reading = readingOf(ball);
  EXPECT_TRUE(!reading || reading->confidence < 0.4);
}

TEST(ShapeReading, NeedsTwoSidesThatAreAlike) {
  TriMesh lopsided = testing::capsuleHound();
  testing::addCapsule(lopsided, {0.1, 0.4, 0}, {0.7, 0.7, 0.2}, 0.12);
  EXPECT_FALSE(readingOf(lopsided));
}

TEST(ShapeReading, SeesWings) {
  TriMesh bird = testing::capsuleTheropod();
  for (const double z : {0.1, 0.13, 0.16, 0.19, 0.22, 0.25}) {
    testing::addChain(bird, {{0.05, 0.48, z}, {0.5, 0.6, z - 0.05}}, 0.018, 0.018);
  }
  EXPECT_TRUE(readingOf(bird)->wings());
  EXPECT_FALSE(readingOf(testing::capsuleTheropod())->wings());
}

}  // namespace
}  // namespace limber
