#include "limber/rigging/templates/limb_matches.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {
namespace {

struct Embedded {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplateEmbedding embedding;

  Embedded() {
    const std::vector<TemplateVariant> variant = {{skeleton, 0}};
    embedding = TemplateEmbedder(skeleton, person.body, person.frame, TemplatePins(skeleton.jointCount()))
                    .embed(variant)
                    .front();
  }
  Index joint(const char* name) const { return skeleton.find(name).value(); }
  std::string missing() const {
    return unmatchedLimbs(skeleton, limbsIn(skeleton, embedding, person.body, person.frame));
  }
};

TEST(LimbMatches, EveryJointIsInOneLimbAndAWholeBodyHasAll) {
  const Embedded embedded;
  std::vector<int> count(embedded.skeleton.jointCount(), 0);
  for (const TemplateLimb& limb :
       limbsIn(embedded.skeleton, embedded.embedding, embedded.person.body, embedded.person.frame)) {
    EXPECT_TRUE(limb.hasMatch) << embedded.skeleton.joints[limb.joints.front()].name;
    for (const Index j : limb.joints) ++count[j];
  }
  for (Index j = 0; j < embedded.skeleton.jointCount(); ++j) {
    EXPECT_EQ(count[j], embedded.skeleton.joints[j].role == TemplateRole::kTip ? 0 : 1);
  }
  EXPECT_EQ(embedded.missing(), "");
}

TEST(LimbMatches, FingersAreNoneAndDoNotEndAnArm) {
  const auto placed = [](const char* name) {
    const TemplateSkeleton& skeleton = findTemplate(name);
    std::vector<std::string> limbs;
    for (const TemplateLimb& limb : limbChains(skeleton)) {
      limbs.emplace_back();
      for (const Index j : limb.placed) limbs.back() += skeleton.joints[j].name + " ";
    }
    return limbs;
  };
  EXPECT_EQ(placed("humanoid-fingers"), placed("humanoid"));
}

TEST(LimbMatches, JointsThatStandIllHaveNone) {
  Embedded embedded;
  for (const char* name : {"neck", "head"}) embedded.embedding.costs[embedded.joint(name)] = 20;
  EXPECT_EQ(embedded.missing(), "neck to head");
}

TEST(LimbMatches, FeetInOnePartOfTheBodyHaveNone) {
  Embedded embedded;
  for (const auto& [name, x] : {std::pair("leftFoot", 0.04), std::pair("rightFoot", -0.04)}) {
    embedded.embedding.positions[embedded.joint(name)] = Vec3(x, 0.62, 0);  // in the trunk
  }
  for (const auto& [name, x] : {std::pair("leftLowerLeg", 0.04), std::pair("rightLowerLeg", -0.04)}) {
    embedded.embedding.positions[embedded.joint(name)] = Vec3(x, 0.7, 0);
  }
  EXPECT_EQ(embedded.missing(), "leftUpperLeg to leftToes, rightUpperLeg to rightToes");
}

TEST(LimbMatches, AnArmInTheTrunkHasNone) {
  Embedded embedded;
  std::vector<Vec3>& positions = embedded.embedding.positions;
  positions[embedded.joint("leftLowerArm")] = Vec3(0.03, 0.7, 0);
  positions[embedded.joint("leftHand")] = Vec3(0.03, 0.6, 0);
  EXPECT_EQ(embedded.missing(), "leftShoulder to leftHand");
}

TEST(LimbMatches, OfABentTemplateLimbsThatLieInOthersHaveNone) {
  Embedded embedded;
  TemplateSkeleton bent = embedded.skeleton;
  for (const TemplateJoint& joint : bent.joints) bent.standing.push_back(joint.position);
  const auto missing = [&] {
    return unmatchedLimbs(bent, limbsIn(bent, embedded.embedding, embedded.person.body, embedded.person.frame));
  };
  EXPECT_EQ(missing(), "");
  std::vector<Vec3>& positions = embedded.embedding.positions;
  positions[embedded.joint("leftLowerArm")] = positions[embedded.joint("spine")];
  positions[embedded.joint("leftHand")] = positions[embedded.joint("hips")];
  EXPECT_EQ(missing(), "leftShoulder to leftHand");
}

}  // namespace
}  // namespace limber
