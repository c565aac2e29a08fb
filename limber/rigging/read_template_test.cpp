#include "limber/rigging/read_template.h"

#include <gtest/gtest.h>

#include "limber/reading/shape_weights.h"
#include "limber/rigging/body/testing/capsule_person.h"

namespace limber {

namespace {

std::optional<ReadTemplate> readOf(const TriMesh& mesh) {
  const BodyVolume body = measureBody(mesh);
  return readTemplate(mesh, body, possibleFrames(mesh, body, {}, {}), *shapeWeights());
}

}  // namespace

TEST(ReadTemplate, OfAPersonHasItsLimbs) {
  const testing::CapsulePerson person = testing::capsulePerson();
  const std::optional<ReadTemplate> read = readOf(person.mesh);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->matches.front().name.starts_with("humanoid"));
  EXPECT_GE(read->matches.front().confidence, kSureTemplate);
  ASSERT_EQ(read->positions.size(), read->skeleton.joints.size());
  const auto at = [&](const char* joint) {
    return read->frame.fromBody(read->positions[read->skeleton.find(joint).value()]);
  };
  EXPECT_LT((at("leftHand") - person.hand).norm(), 0.1);
  EXPECT_LT((at("rightFoot") - person.ankle.cwiseProduct(Vec3(-1, 1, 1))).norm(), 0.1);
  EXPECT_LT((at("leftUpperLeg") - person.hip).norm(), 0.1);
  EXPECT_GT(at("head").y(), at("neck").y());
  for (const TemplateLimb& limb : read->limbs) EXPECT_TRUE(limb.hasMatch);
}

TEST(ReadTemplate, OfASymmetricBodyIsSymmetric) {
  const std::optional<ReadTemplate> read = readOf(testing::capsulePerson().mesh);
  ASSERT_TRUE(read);
  for (Index j = 0; j < read->skeleton.jointCount(); ++j) {
    const std::optional<Index> mirror = read->skeleton.joints[j].mirror;
    if (!mirror) continue;
    EXPECT_LT((read->positions[j] - read->positions[*mirror].cwiseProduct(Vec3(-1, 1, 1))).norm(), 0.02)
        << read->skeleton.joints[j].name;
  }
}

TEST(ReadTemplate, OfABallIsNone) {
  TriMesh ball;
  testing::addCapsule(ball, {0, 0.49, 0}, {0, 0.51, 0}, 0.49);
  EXPECT_FALSE(readOf(ball));
}

}  // namespace limber
