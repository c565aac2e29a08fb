#include "limber/templates/template_embedding.h"

#include <gtest/gtest.h>

#include "limber/body/testing/measured_person.h"
#include "limber/core/error.h"

namespace limber {

namespace {

std::vector<TemplateVariant> asIs(const TemplateSkeleton& skeleton) {
  return {{skeleton, 0}};
}

}  // namespace

TEST(TemplateEmbedding, PutsJointsIntoTheirLimbs) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  const TemplateEmbedding embedding = embedTemplate(asIs(skeleton), person.body, person.frame, pins).front();
  const auto place = [&](const char* name) { return person.frame.fromBody(embedding.places[*skeleton.find(name)]); };
  EXPECT_LT((place("leftHand") - person.shape.hand).norm(), 0.08);
  EXPECT_LT((place("leftLowerArm") - person.shape.elbow).norm(), 0.06);
  EXPECT_LT((place("leftFoot") - person.shape.ankle).norm(), 0.06);
  EXPECT_LT((place("leftLowerLeg") - person.shape.knee).norm(), 0.06);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {  // the body is symmetric
    const Index mirror = skeleton.joints[j].mirror.value_or(j);
    EXPECT_LT((embedding.places[mirror] - embedding.places[j].cwiseProduct(Vec3(-1, 1, 1))).norm(), 1e-9);
  }
}

TEST(TemplateEmbedding, IsRefinedTowardsTheMiddleOfLimbs) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  const auto embedded = [&](bool refine) {
    return embedTemplate(asIs(skeleton), person.body, person.frame, pins, {1000, refine}).front();
  };
  const TemplateEmbedding rough = embedded(false), fine = embedded(true);
  EXPECT_EQ(rough.cost, fine.cost);
  EXPECT_NE(rough.places, fine.places);
  // From the axes of the left leg's capsules.
  const auto offAxis = [&](const TemplateEmbedding& embedding) {
    double sum = 0;
    const Vec3 axis = (person.shape.knee - person.shape.ankle).normalized();
    for (const char* name : {"leftLowerLeg", "leftFoot"}) {
      const Vec3 place = person.frame.fromBody(embedding.places[*skeleton.find(name)]) - person.shape.ankle;
      sum += (place - place.dot(axis) * axis).norm();
    }
    return sum;
  };
  EXPECT_LT(offAxis(fine), offAxis(rough));
}

TEST(TemplateEmbedding, KeepsPins) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplatePins pins(skeleton.jointCount());
  const Vec3 pin(0.2, 0.7, 0.05);
  pins[*skeleton.find("leftLowerArm")] = pin;
  const TemplateEmbedding embedding = embedTemplate(asIs(skeleton), person.body, person.frame, pins).front();
  EXPECT_LT((embedding.places[*skeleton.find("leftLowerArm")] - pin).norm(), 1e-9);
}

TEST(TemplateEmbedding, CostsMoreInWhatIsNoPerson) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  TriMesh sausage;
  testing::addCapsule(sausage, {0, 0.2, 0}, {0, 0.8, 0}, 0.2);
  const BodyVolume body = measureBody(sausage);
  const BodyFrame frame = frameAlong(sausage, body, Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_GT(embedTemplate(asIs(skeleton), body, frame, pins).front().cost,
            2 * embedTemplate(asIs(skeleton), person.body, person.frame, pins).front().cost);
}

TEST(TemplateEmbedding, RefusesVariantsOfOtherJoints) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const std::vector<TemplateVariant> variants = {{findTemplate("humanoid"), 0}, {findTemplate("bird"), 0}};
  const TemplatePins pins(variants[0].skeleton.jointCount());
  EXPECT_THROW(embedTemplate(variants, person.body, person.frame, pins), Error);
}

// Joints between go along with their placed neighbours: turned and scaled as these are.
TEST(TemplateEmbedding, PlacesJointsBetween) {
  TemplateSkeleton skeleton;
  skeleton.joints = {{"a", {}, {0, 0, 0}, TemplateRole::kPlaced, 1, 1, {}},
                     {"b", 0, {0, 0.25, 0}, TemplateRole::kBetween, 1, 1, {}},
                     {"c", 1, {0, 1, 0}, TemplateRole::kPlaced, 1, 1, {}},
                     {"d", 2, {0, 2, 0}, TemplateRole::kTip, 1, 1, {}},
                     {"e", 2, {0.5, 1.5, 0}, TemplateRole::kBetween, 1, 1, {}}};
  std::vector<Vec3> places = {{0, 0, 0}, {9, 9, 9}, {2, 0, 0}, {4, 0, 0}, {9, 9, 9}};
  placeBetween(skeleton, places);
  EXPECT_LT((places[1] - Vec3(0.5, 0, 0)).norm(), 1e-9);
  EXPECT_LT((places[4] - Vec3(3, -1, 0)).norm(), 1e-9);
}

}  // namespace limber
