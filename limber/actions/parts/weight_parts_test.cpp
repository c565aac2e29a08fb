#include "limber/actions/parts/weight_parts.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

TEST(WeightParts, TheCutIsTheShortestLoopWhereWeightsLeaveTheChoice) {
  Progress progress;
  // A tube that is thinnest at x = 2.4, weights even at x = 2.1, between 3 to 1 and 1 to 3 from 1.6 to 2.6.
  const TriMesh mesh = testing::revolved(4, 41, 16, [](double x) { return 0.5 + 0.3 * std::abs(x - 2.4); });
  const SkinWeights weights = testing::twoJointWeights(mesh.positions, 2.1, 2);
  const JointGroups groups = jointGroups(testing::twoJoints(2), PartDetail::kJoints);
  const SurfaceParts parts = partsByWeights(faceGraph(mesh), mesh.triangles, weights, groups, progress);
  EXPECT_THAT(parts.names, ::testing::ElementsAre("lower", "upper"));
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    EXPECT_EQ(parts.partOf[t], testing::middleX(mesh, t) < 2.4 ? 0u : 1u) << testing::middleX(mesh, t);
  }
}

TEST(WeightParts, LeadsAreThoseOfTheCornersSums) {
  const TriMesh mesh = testing::flatGrid(6, 2);
  const SkinWeights weights = testing::twoJointWeights(mesh.positions, 0.5, 1);
  const FuzzyParts fuzzy =
      fuzzyByWeights(mesh.triangles, weights, jointGroups(testing::twoJoints(1), PartDetail::kJoints));
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const double upper = testing::middleX(mesh, t);  // the mean of its corners' weights, which are x
    EXPECT_NEAR(static_cast<double>(fuzzy.lead[t]), std::abs(2 * upper - 1), 1e-6);
    EXPECT_EQ(fuzzy.first[t], upper > 0.5 ? 1u : 0u);
  }
}

TEST(WeightParts, TrianglesWithoutWeightsGoWithTheNearest) {
  Progress progress;
  const TriMesh mesh = testing::flatGrid(10, 1);
  SkinWeights weights = testing::twoJointWeights(mesh.positions, 0.5, 1e-3);
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (mesh.positions[v].x() > 0.15f && mesh.positions[v].x() < 0.85f) {
      for (Index slot = 0; slot < 2; ++slot) weights.weights[2 * v + slot] = 0;
    }
  }
  const JointGroups groups = jointGroups(testing::twoJoints(1), PartDetail::kJoints);
  const SurfaceParts parts = partsByWeights(faceGraph(mesh), mesh.triangles, weights, groups, progress);
  EXPECT_EQ(parts.partOf.front(), 0u);
  EXPECT_EQ(parts.partOf.back(), 1u);
  EXPECT_TRUE(std::is_sorted(parts.partOf.begin(), parts.partOf.end()));
  std::fill(weights.weights.begin(), weights.weights.end(), 0.0f);
  EXPECT_THROW(partsByWeights(faceGraph(mesh), mesh.triangles, weights, groups, progress), Error);
}

TEST(WeightParts, PartsThatNoTriangleHasAreNone) {
  Progress progress;
  const TriMesh mesh = testing::icosphere(1);
  const SkinWeights weights = testing::twoJointWeights(mesh.positions, 5, 1);
  const SurfaceParts parts = partsByWeights(faceGraph(mesh), mesh.triangles, weights,
                                            jointGroups(testing::twoJoints(5), PartDetail::kJoints), progress);
  EXPECT_THAT(parts.names, ::testing::ElementsAre("lower"));
  EXPECT_THAT(parts.partOf, ::testing::Each(0u));
}

class WeightPartsOf : public ::testing::TestWithParam<testing::NamedMesh> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, WeightPartsOf, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST_P(WeightPartsOf, EachTriangleHasAPartAndEachPartATriangle) {
  Progress progress;
  TriMesh mesh = GetParam().mesh;
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  const SkinWeights weights = testing::twoJointWeights(mesh.positions, 0.1, 0.3);
  const SurfaceParts parts = partsByWeights(faceGraph(mesh), mesh.triangles, weights,
                                            jointGroups(testing::twoJoints(0.1), PartDetail::kJoints), progress);
  std::vector<bool> used(parts.names.size(), false);
  for (const Index part : parts.partOf) used.at(part) = true;
  EXPECT_THAT(used, ::testing::Each(true));
}

TEST(JointGroups, HandsGoWithTheArmAndCollarsWithTheTrunk) {
  const Skeleton person = testing::vrmPerson();
  const JointGroups groups = jointGroups(person, PartDetail::kLimbs);
  ASSERT_EQ(groups.groupOf.size(), person.joints.size());
  std::map<std::string, std::string> partOf;
  for (Index j = 0; j < person.jointCount(); ++j) partOf[person.joints[j].name] = groups.names[groups.groupOf[j]];
  const std::map<std::string, std::string> expected = {{"hips", "trunk"},         {"chest", "trunk"},
                                                       {"leftShoulder", "trunk"}, {"leftUpperArm", "leftArm"},
                                                       {"leftHand", "leftArm"},   {"rightUpperArm", "rightArm"},
                                                       {"rightHand", "rightArm"}, {"leftUpperLeg", "leftLeg"},
                                                       {"rightFoot", "rightLeg"}, {"neck", "neck"},
                                                       {"head", "head"}};
  for (const auto& [joint, part] : expected) EXPECT_EQ(partOf[joint], part) << joint;
}

TEST(JointGroups, EarsAndJawGoWithTheHeadAndShoulderBladesWithTheTrunk) {
  const Skeleton dog = testing::dog().skeleton;
  const JointGroups groups = jointGroups(dog, PartDetail::kLimbs);
  const auto groupOf = [&](Index joint) { return groups.groupOf[joint]; };
  for (Index j = 0; j < dog.jointCount(); ++j) {
    const std::string& name = dog.joints[j].name;
    if (name.ends_with("Ear") || name == "Jaw") {
      EXPECT_EQ(groupOf(j), groupOf(*dog.find("Head"))) << name;
    }
    if (name.ends_with("Scapula")) {
      EXPECT_EQ(groupOf(j), groupOf(*dog.find("Pelvis"))) << name;
    }
    if (name.ends_with("Hand")) {
      EXPECT_EQ(groupOf(j), groupOf(*dog.joints[j].parent)) << name;
      EXPECT_NE(groupOf(j), groupOf(*dog.find("Pelvis"))) << name;
    }
  }
}

TEST(JointGroups, JointsKeepTheirNames) {
  const Skeleton person = testing::vrmPerson();
  const JointGroups groups = jointGroups(person, PartDetail::kJoints);
  for (Index j = 0; j < person.jointCount(); ++j) EXPECT_EQ(groups.names[groups.groupOf[j]], person.joints[j].name);
}

}  // namespace
}  // namespace limber
