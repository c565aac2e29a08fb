#include "limber/rigging/templates/template_embedding.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/rigging/body/testing/measured_person.h"

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
  const TemplateEmbedding embedding =
      TemplateEmbedder(skeleton, person.body, person.frame, pins).embed(asIs(skeleton)).front();
  const auto positionOf = [&](const char* name) {
    return person.frame.fromBody(embedding.positions[*skeleton.find(name)]);
  };
  EXPECT_LT((positionOf("leftHand") - person.shape.hand).norm(), 0.08);
  EXPECT_LT((positionOf("leftLowerArm") - person.shape.elbow).norm(), 0.06);
  EXPECT_LT((positionOf("leftFoot") - person.shape.ankle).norm(), 0.06);
  EXPECT_LT((positionOf("leftLowerLeg") - person.shape.knee).norm(), 0.06);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {  // the body is symmetric
    const Index mirror = skeleton.joints[j].mirror.value_or(j);
    EXPECT_LT((embedding.positions[mirror] - embedding.positions[j].cwiseProduct(Vec3(-1, 1, 1))).norm(), 1e-9);
  }
}

TEST(TemplateEmbedding, IsRefinedTowardsTheMiddleOfLimbs) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  const auto embedded = [&](bool refine) {
    return TemplateEmbedder(skeleton, person.body, person.frame, pins, {1000, refine}).embed(asIs(skeleton)).front();
  };
  const TemplateEmbedding rough = embedded(false), fine = embedded(true);
  EXPECT_EQ(rough.cost, fine.cost);
  EXPECT_NE(rough.positions, fine.positions);
  // From the axes of the left leg's capsules.
  const auto offAxis = [&](const TemplateEmbedding& embedding) {
    double sum = 0;
    const Vec3 axis = (person.shape.knee - person.shape.ankle).normalized();
    for (const char* name : {"leftLowerLeg", "leftFoot"}) {
      const Vec3 position = person.frame.fromBody(embedding.positions[*skeleton.find(name)]) - person.shape.ankle;
      sum += (position - position.dot(axis) * axis).norm();
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
  const TemplateEmbedding embedding =
      TemplateEmbedder(skeleton, person.body, person.frame, pins).embed(asIs(skeleton)).front();
  EXPECT_LT((embedding.positions[*skeleton.find("leftLowerArm")] - pin).norm(), 1e-9);
}

TEST(TemplateEmbedding, CostsMoreInWhatIsNoPerson) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  TriMesh sausage;
  testing::addCapsule(sausage, {0, 0.2, 0}, {0, 0.8, 0}, 0.2);
  const BodyVolume body = measureBody(sausage);
  const AnatomicalFrame frame = frameAlong(sausage, body, Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_GT(TemplateEmbedder(skeleton, body, frame, pins).embed(asIs(skeleton)).front().cost,
            2 * TemplateEmbedder(skeleton, person.body, person.frame, pins).embed(asIs(skeleton)).front().cost);
}

TEST(TemplateEmbedding, RefusesVariantsOfOtherJoints) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const std::vector<TemplateVariant> variants = {{findTemplate("humanoid"), 0}, {findTemplate("bird"), 0}};
  const TemplatePins pins(variants[0].skeleton.jointCount());
  TemplateEmbedder embedder(variants[0].skeleton, person.body, person.frame, pins);
  EXPECT_THROW(embedder.embed(variants), Error);
  EXPECT_THROW(TemplateEmbedder(variants[1].skeleton, person.body, person.frame, pins), Error);
}

TEST(TemplateEmbedding, OfManyVariantsIsThatOfEach) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplatePins pins(skeleton.jointCount());
  const std::vector<TemplateVariant> variants = templateVariants(skeleton);
  ASSERT_GT(variants.size(), 2u);
  TemplateEmbedder embedder(skeleton, person.body, person.frame, pins);
  const std::vector<TemplateEmbedding> together = embedder.embed(variants);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const TemplateEmbedding alone =
        TemplateEmbedder(skeleton, person.body, person.frame, pins).embed(std::span(&variants[v], 1)).front();
    EXPECT_EQ(together[v].positions, alone.positions);
    EXPECT_EQ(together[v].cost, alone.cost);
  }
}

}  // namespace limber
