#include "limber/rigging/shape/plan_fit.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "limber/core/error.h"
#include "limber/rigging/body/testing/capsule_animal.h"

namespace limber {
namespace {

ShapeReading shapeOf(const TriMesh& mesh) {
  const testing::MeasuredAnimal animal = testing::measured(mesh);
  return readShape(animal.body, animal.frames, false).value();
}

// In the unit of the mesh, over the plane between left and right and the ground.
Vec3 positionOf(const TemplateFit& fit, std::string_view joint) {
  return fit.frame.height * fit.embedding.positions[fit.skeleton.find(joint).value()];
}

// The mesh's longest side becomes 1.
double sizeOf(const TriMesh& mesh) {
  Box box;
  for (const Vec3f& p : mesh.positions) box.add(p.cast<double>());
  return box.longestSide();
}

}  // namespace

TEST(PlanFit, PutsJointsWhereALegBends) {
  const TriMesh mesh = testing::capsuleTheropod();
  const ShapeReading reading = shapeOf(mesh);
  const TemplateFit fit = fitPlan(*findPlanKind("dinosaur"), reading);
  const double size = sizeOf(mesh);
  EXPECT_LT((positionOf(fit, "leftLowerLeg") * size - Vec3(0.09, 0.2, 0.08)).tail<2>().norm(), 0.06);
  EXPECT_LT((positionOf(fit, "leftFoot") * size - Vec3(0.09, 0.1, -0.04)).tail<2>().norm(), 0.06);
  EXPECT_TRUE(fit.skeleton.find("leftHand") && fit.skeleton.find("tail2") && fit.skeleton.find("head"));
  EXPECT_LT(positionOf(fit, "tail2").z(), positionOf(fit, "hips").z());
  EXPECT_GT(positionOf(fit, "head").z(), positionOf(fit, "chest").z());
}

TEST(PlanFit, BothSidesMirrorEachOther) {
  const TemplateFit fit = fitPlan(*findPlanKind("spider"), shapeOf(testing::capsuleSpider(4)));
  std::size_t paired = 0;
  for (Index j = 0; j < fit.skeleton.jointCount(); ++j) {
    const std::optional<Index> other = fit.skeleton.joints[j].mirror;
    if (!other) continue;
    ++paired;
    EXPECT_EQ(fit.skeleton.joints[*other].mirror, std::optional<Index>(j));
    EXPECT_LT((fit.embedding.positions[j] - fit.embedding.positions[*other].cwiseProduct(Vec3(-1, 1, 1))).norm(),
              1e-12);
  }
  EXPECT_EQ(paired, 2u * 4 * 4) << "three joints and a tip a leg";
  for (const char* joint : {"leftUpperLeg", "leftFoot1", "rightFoot3"}) EXPECT_TRUE(fit.skeleton.find(joint)) << joint;
}

TEST(PlanFit, KindsAreTheLikelierTheBetterTheShapeSuits) {
  const ShapeReading snake = shapeOf(testing::capsuleSnake()), insect = shapeOf(testing::capsuleSpider(3));
  for (const PlanKind& kind : planKinds()) {
    EXPECT_EQ(likelihood(kind, snake) > 0.5, kind.name == "serpent") << kind.name;
    EXPECT_EQ(likelihood(kind, insect) > 0.5, kind.name == "insect") << kind.name;
  }
}

TEST(PlanFit, WingsMakeADragon) {
  TriMesh dragon = testing::capsuleHound();
  for (const double z : {0.0, 0.03, 0.06, 0.09, 0.12, 0.15}) {
    testing::addChain(dragon, {{0.05, 0.5, z}, {0.55, 0.6, z - 0.05}}, 0.018, 0.018);
  }
  const ShapeReading winged = shapeOf(dragon), hound = shapeOf(testing::capsuleHound());
  EXPECT_GT(likelihood(*findPlanKind("dragon"), winged), 0.6);
  EXPECT_EQ(likelihood(*findPlanKind("dragon"), hound), 0);
  EXPECT_EQ(likelihood(*findPlanKind("crawler"), winged), 0);
  const TemplateFit fit = fitPlan(*findPlanKind("dragon"), winged);
  for (const char* joint : {"leftUpperWing", "rightWingHand", "leftFrontFoot", "rightHindFoot", "tail"}) {
    EXPECT_TRUE(fit.skeleton.find(joint)) << joint;
  }
  EXPECT_GT(positionOf(fit, "leftWingHand").x(), 0.2);
}

TEST(PlanFit, AChainFollowsASnake) {
  const TriMesh mesh = testing::capsuleSnake();
  const TemplateFit fit = fitPlan(*findPlanKind("serpent"), shapeOf(mesh));
  EXPECT_EQ(std::count_if(fit.skeleton.joints.begin(), fit.skeleton.joints.end(),
                          [](const TemplateJoint& joint) { return joint.role != TemplateRole::kTip; }),
            12);
  EXPECT_GT(positionOf(fit, "head").y() * sizeOf(mesh), 0.28);
  EXPECT_LT(positionOf(fit, "tail4").z(), positionOf(fit, "tail").z());
}

TEST(PlanFit, AKindThatAsksForMoreLegsSaysSo) {
  try {
    fitPlan(*findPlanKind("spider"), shapeOf(testing::capsuleHound()));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    EXPECT_NE(std::string(error.what()).find("the model has 2"), std::string::npos) << error.what();
  }
  EXPECT_EQ(findPlanKind("centaur"), nullptr);
}

}  // namespace limber
