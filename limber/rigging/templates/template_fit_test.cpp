#include "limber/rigging/templates/template_fit.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

TemplateFit personFacing(const Vec3& front) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const AnatomicalFrame frame = frameAlong(person.shape.mesh, person.body, Vec3::UnitY(), front);
  TemplateEmbedder embedder(skeleton, person.body, frame, TemplatePins(skeleton.jointCount()));
  return fitVariants({{skeleton, 0}}, embedder).front();
}

}  // namespace

TEST(TemplateFit, CostsMoreBackToFrontAndOnTheSide) {
  const double cost = personFacing(Vec3::UnitZ()).cost;
  EXPECT_LT(cost, 1);
  EXPECT_GT(personFacing(-Vec3::UnitZ()).cost, cost + 1);
  EXPECT_GT(personFacing(Vec3::UnitX()).cost, cost + 1);
}

TEST(TemplateFit, CountsWhatTheVariantCosts) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplateEmbedder embedder(skeleton, person.body, person.frame, TemplatePins(skeleton.jointCount()));
  const std::vector<TemplateFit> fits = fitVariants({{skeleton, 0}, {skeleton, 0.25}}, embedder);
  ASSERT_EQ(fits.size(), 2u);
  EXPECT_NEAR(fits[1].cost, fits[0].cost + 0.25, 1e-12);
  EXPECT_TRUE(cheaper(fits[0], fits[1]));
}

TEST(FarFromBones, IsNothingOnABoneAndOneFarAway) {
  const TemplateFit fit = personFacing(Vec3::UnitZ());
  const std::vector<Vec3>& positions = fit.embedding.positions;
  const Vec3 thigh = 0.5 * (positions[fit.skeleton.find("leftUpperLeg").value()] +
                            positions[fit.skeleton.find("leftLowerLeg").value()]);
  EXPECT_EQ(farFromBones(fit.skeleton, positions, thigh, 0), 0);
  EXPECT_EQ(farFromBones(fit.skeleton, positions, thigh + Vec3(0, 0, 1), 0), 1);
  const double between = farFromBones(fit.skeleton, positions, thigh + Vec3(0, 0, 0.15), 0);
  EXPECT_GT(between, 0);
  EXPECT_LT(between, 1);
  EXPECT_LT(farFromBones(fit.skeleton, positions, thigh + Vec3(0, 0, 0.15), 0.05), between);
}

}  // namespace limber
