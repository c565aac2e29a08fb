#include "limber/rigging/templates/figure_fit.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/rigging/figure/testing/figure_body.h"

namespace limber {

namespace {

struct Crouching {
  MatchedFigure figure;
  AnatomicalFrame frame;  // of the mesh as it is: its middle is not the figure's

  Crouching() {
    figure.figure = testing::crouchingFigure();
    figure.total = 7;
    figure.limbs = {1, 1, 1.5, 1.5};
    frame.origin = {0.3, 0.1, -0.2};
    frame.height = 0.7;
  }
};

Vec3 positionOf(const TemplateFit& fit, const char* joint) {
  return fit.frame.fromBody(fit.embedding.positions[fit.skeleton.find(joint).value()]);
}

double off(const TemplateFit& fit, const char* joint, const Vec3& position) {
  return (positionOf(fit, joint) - position).norm();
}

TemplatePins noPins(const TemplateSkeleton& skeleton) {
  return TemplatePins(skeleton.jointCount());
}

std::size_t missing(const TemplateFit& fit) {
  return static_cast<std::size_t>(
      std::count_if(fit.limbs.begin(), fit.limbs.end(), [](const TemplateLimb& limb) { return !limb.hasMatch; }));
}

}  // namespace

TEST(FigureFit, HumanoidsHaveTheJointsOfAFigure) {
  EXPECT_TRUE(isHumanoid(findTemplate("humanoid")));
  EXPECT_TRUE(isHumanoid(findTemplate("humanoid-fingers")));
  EXPECT_FALSE(isHumanoid(findTemplate("quadruped")));
  EXPECT_FALSE(isHumanoid(findTemplate("bird")));
}

TEST(FigureFit, JointsStandInTheFigure) {
  const Crouching person;
  for (const char* name : {"humanoid", "humanoid-fingers"}) {
    const TemplateSkeleton& skeleton = findTemplate(name);
    const TemplateFit fit = fitOfFigure(skeleton, person.figure, noPins(skeleton), person.frame);
    const Figure& figure = person.figure.figure;
    EXPECT_LT(off(fit, "leftLowerArm", figure.positions(0).middle), 1e-4);
    EXPECT_LT(off(fit, "rightHand", figure.positions(1).ankle), 1e-4);
    EXPECT_LT(off(fit, "leftUpperLeg", figure.positions(2).root), 1e-4);
    EXPECT_LT(off(fit, "rightFoot", figure.positions(3).ankle), 1e-4);
    EXPECT_LT(off(fit, "hips", figure.hips()), 0.02);
    EXPECT_TRUE(fit.skeleton.bent());
    EXPECT_EQ(missing(fit), 0u);
    // Joints between others lie between them.
    const double toes = off(fit, "leftToes", figure.positions(2).ankle);
    EXPECT_GT(toes, 0.02);
    EXPECT_LT(toes, proportions::kFoot);
  }
}

TEST(FigureFit, TheFrameFacesWithTheFigure) {
  Crouching person;
  const Mat3 turn = Eigen::AngleAxisd(2, Vec3::UnitY()).toRotationMatrix();
  Figure& figure = person.figure.figure;
  figure.chest = turn * figure.chest;
  figure.pelvis = turn * figure.pelvis;
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const TemplateFit fit = fitOfFigure(skeleton, person.figure, noPins(skeleton), person.frame);
  EXPECT_NEAR(fit.frame.axes.determinant(), 1, 1e-9);
  EXPECT_EQ(Vec3(fit.frame.axes.row(1).transpose()), Vec3::UnitY());
  EXPECT_GT(fit.frame.axes.row(2).dot((turn * Vec3(0.1, 0, 1)).transpose()), 0.95);
  EXPECT_NEAR(fit.frame.toBody(figure.hips()).x(), 0, 1e-12) << "the hips are in the middle";
  EXPECT_NEAR(fit.frame.toBody(person.frame.origin).y(), 0, 1e-12) << "the ground stays";
}

TEST(FigureFit, BetterMatchesCostLessAndLimbsThatHardlyMatchHaveNoPlace) {
  Crouching person;
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  const double sure = fitOfFigure(skeleton, person.figure, noPins(skeleton), person.frame).cost;
  person.figure.total = 4;
  person.figure.limbs[1] = 0;
  const TemplateFit doubtful = fitOfFigure(skeleton, person.figure, noPins(skeleton), person.frame);
  EXPECT_GT(doubtful.cost, 2 * sure);
  EXPECT_EQ(unmatchedLimbs(doubtful.skeleton, doubtful.limbs), "rightShoulder to rightHand");
}

TEST(FigureFit, PinnedJointsStandWhereTheyArePinnedAndEndsGoAlong) {
  const Crouching person;
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplatePins pins = noPins(skeleton);
  const Vec3 hand = person.figure.figure.positions(0).ankle + Vec3(0.05, 0.02, 0);
  pins[skeleton.find("leftHand").value()] = person.frame.toBody(hand);
  const TemplateFit fit = fitOfFigure(skeleton, person.figure, pins, person.frame);
  EXPECT_LT(off(fit, "leftHand", hand), 1e-9);
  EXPECT_LT(off(fit, "leftHandTip", person.figure.figure.positions(0).tip + Vec3(0.05, 0.02, 0)), 1e-3);
  EXPECT_TRUE(fit.pins[skeleton.find("leftHand").value()]);
}

TEST(FigureFit, TellsAFigureOfThePinsItKnows) {
  const Crouching person;
  const TemplateSkeleton& skeleton = findTemplate("humanoid");
  TemplatePins pins = noPins(skeleton);
  for (const char* joint : {"head", "rightLowerLeg", "leftToes"}) {
    pins[skeleton.find(joint).value()] = person.frame.toBody(Vec3(1, 2, 3));
  }
  const std::vector<FigurePin> pinned = figurePins(skeleton, pins, person.frame);
  ASSERT_EQ(pinned.size(), 2u);
  EXPECT_EQ(pinned[0].joint, FigurePin::Joint::kHead);
  EXPECT_EQ(pinned[1].joint, FigurePin::Joint::kMiddle);
  EXPECT_EQ(pinned[1].limb, 3);
  EXPECT_LT((pinned[1].position - Vec3(1, 2, 3)).norm(), 1e-9);
}

}  // namespace limber
