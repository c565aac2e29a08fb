#include "limber/rigging/curve_skeleton/joint_choice.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "limber/core/disjoint_sets.h"
#include "limber/core/error.h"

namespace limber {

namespace {

void addCurve(CurveTree& tree, Index from, const Vec3& to, int nodes, bool isPaired = false) {
  const Vec3 start = tree.points[from];
  for (int i = 1; i <= nodes; ++i) {
    tree.points.push_back(start + double(i) / nodes * (to - start));
    tree.radii.push_back(0.05);
    tree.weights.push_back(0.01);
    tree.isPaired.push_back(isPaired);
    tree.parents.push_back(i == 1 ? from : static_cast<Index>(tree.points.size() - 2));
  }
}

CurveTree rootAlone() {
  CurveTree tree;
  tree.points = {Vec3::Zero()};
  tree.radii = {0.1};
  tree.weights = {0.1};
  tree.isPaired = {0};
  tree.parents = {kNoIndex};
  return tree;
}

// Three straight curves of the lengths 3, 2 and 1 from one point.
CurveTree star() {
  CurveTree tree = rootAlone();
  addCurve(tree, 0, {3, 0, 0}, 30);
  addCurve(tree, 0, {0, 2, 0}, 20);
  addCurve(tree, 0, {0, 0, 1}, 10);
  return tree;
}

// Half of a person: trunk up and down on the plane, an arm at its top, a leg at its lower end.
CurveTree halfPerson() {
  CurveTree tree = rootAlone();
  tree.isMirrored = true;
  addCurve(tree, 0, {0, 1, 0}, 10);
  const Index neck = 10;
  addCurve(tree, neck, {0, 1.5, 0}, 5);
  addCurve(tree, neck, {2, 1, 0}, 20, true);
  addCurve(tree, 0, {0.4, -2, 0}, 20, true);
  return tree;
}

std::vector<int> degrees(const SphereMeshLevel& level) {
  std::vector<int> degree(level.spheres.size(), 0);
  for (const auto& [a, b] : level.edges) {
    ++degree[a];
    ++degree[b];
  }
  return degree;
}

void expectTree(const SphereMeshLevel& level, Index count) {
  ASSERT_EQ(level.spheres.size(), count);
  ASSERT_EQ(level.weights.size(), count);
  EXPECT_EQ(level.edges.size() + 1, count);
  DisjointSets sets(count);
  for (const auto& [a, b] : level.edges) sets.unite(a, b);
  EXPECT_EQ(sets.count(), 1u);
}

TEST(JointChoice, GivesAnyNumberInOneTree) {
  for (const CurveTree& tree : {star(), halfPerson()}) {
    for (Index count = 1; count < 150; ++count) expectTree(chooseJoints(tree, count), count);
  }
}

TEST(JointChoice, TakesLongBranchesFirst) {
  const SphereMeshLevel two = chooseJoints(star(), 2), four = chooseJoints(star(), 4);
  EXPECT_LT((two.spheres[1].center - Vec3(3, 0, 0)).norm(), 1e-12);
  std::set<double> ends;
  for (const Sphere& sphere : four.spheres) ends.insert(std::round(sphere.center.norm() * 1e6) / 1e6);
  // The middle of the longest comes between: a quarter of 3 counts less than 1.
  EXPECT_EQ(ends, (std::set<double>{0, 1, 2, 3}));
  EXPECT_EQ(degrees(four)[0], 3);
}

TEST(JointChoice, HalvesWhatIsStraight) {
  CurveTree tree = rootAlone();
  addCurve(tree, 0, {8, 0, 0}, 80);
  std::set<double> positions;
  for (const Sphere& sphere : chooseJoints(tree, 5).spheres)
    positions.insert(std::round(1e6 * sphere.center.x()) / 1e6);
  EXPECT_EQ(positions, (std::set<double>{0, 2, 4, 6, 8}));
}

TEST(JointChoice, PutsAJointWhereTheCurveBends) {
  CurveTree tree = rootAlone();
  addCurve(tree, 0, {1, 0, 0}, 10);
  addCurve(tree, 10, {1, 3, 0}, 30);
  const SphereMeshLevel level = chooseJoints(tree, 3);
  EXPECT_LT((level.spheres[2].center - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST(JointChoice, ABranchGetsAJointWhereItComesOff) {
  CurveTree tree = rootAlone();
  addCurve(tree, 0, {4, 0, 0}, 40);
  addCurve(tree, 17, {1.7, 3, 0}, 30);  // 17 nodes along
  const SphereMeshLevel level = chooseJoints(tree, 4);
  const std::vector<int> degree = degrees(level);
  const auto branch = std::find(degree.begin(), degree.end(), 3);
  ASSERT_NE(branch, degree.end());
  EXPECT_LT((level.spheres[branch - degree.begin()].center - Vec3(1.7, 0, 0)).norm(), 1e-12);
}

TEST(JointChoice, WhatStaysInTheBodyComesLast) {
  CurveTree tree = rootAlone();
  addCurve(tree, 0, {4, 0, 0}, 40);
  addCurve(tree, 20, {2, 0.2, 0}, 2);
  for (Index n = 0; n <= 40; ++n) tree.radii[n] = 0.3;
  for (const Sphere& sphere : chooseJoints(tree, 12).spheres) EXPECT_EQ(sphere.center.y(), 0);
}

TEST(JointChoice, MirrorsEveryJointThatIsNotOnThePlane) {
  for (Index count = 1; count < 60; ++count) {
    const SphereMeshLevel level = chooseJoints(halfPerson(), count);
    ASSERT_EQ(level.images.size(), count);
    for (Index h = 0; h < count; ++h) {
      ASSERT_NE(level.images[h], kNoIndex) << count;
      const Vec3 p = level.spheres[h].center;
      EXPECT_EQ(level.spheres[level.images[h]].center, Vec3(-p.x(), p.y(), p.z()));
      EXPECT_EQ(level.images[level.images[h]], h);
      if (level.images[h] > h) {
        EXPECT_GT(p.x(), 0);
      }
    }
  }
}

TEST(JointChoice, HasAllTheWeight) {
  for (const CurveTree& tree : {star(), halfPerson()}) {
    double expected = 0;
    for (std::size_t n = 0; n < tree.weights.size(); ++n) expected += tree.weights[n] * (tree.isPaired[n] ? 2 : 1);
    for (const Index count : {1u, 2u, 5u, 40u}) {
      double sum = 0;
      for (const double weight : chooseJoints(tree, count).weights) sum += weight;
      EXPECT_NEAR(sum, expected, 1e-12) << count;
    }
  }
}

TEST(JointChoice, WithoutAPlaneTheOddOneHasNoImage) {
  CurveTree tree = rootAlone();
  tree.isMirrored = true;
  tree.points[0].x() = 1;
  tree.isPaired[0] = 1;
  addCurve(tree, 0, {4, 0, 0}, 10, true);
  for (Index count = 2; count < 20; ++count) {
    const SphereMeshLevel level = chooseJoints(tree, count);
    expectTree(level, count);
    EXPECT_EQ(std::count(level.images.begin(), level.images.end(), kNoIndex), count % 2);
  }
}

TEST(JointChoice, APointHasOneJoint) {
  expectTree(chooseJoints(rootAlone(), 1), 1);
  EXPECT_THROW(chooseJoints(rootAlone(), 2), Error);
}

TEST(JointChoice, ErrorsNeverGrow) {
  for (const CurveTree& tree : {star(), halfPerson(), rootAlone()}) {
    const std::vector<double> errors = choiceErrors(tree, 60);
    ASSERT_EQ(errors.size(), 61u);
    EXPECT_TRUE(std::isinf(errors[0]));
    for (std::size_t i = 1; i < errors.size(); ++i) {
      EXPECT_LE(errors[i], errors[i - 1]);
      EXPECT_GE(errors[i], 0);
    }
  }
  // Of a star with all its ends the longest bone's half is next.
  EXPECT_NEAR(choiceErrors(star(), 4)[4], 0.75, 1e-9);
}

}  // namespace

}  // namespace limber
