// A figure of four limbs with a handle in each, and the same with one fault after another.
#include "limber/evaluate/rig/handle_quality.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

const std::array<Vec3, 4> kEnds = {Vec3(1, 0, 0), Vec3(-0.9, 0, 0), Vec3(0, 1.1, 0), Vec3(0, -1.2, 0)};

// A ball with four limbs. Handle 0 is in the ball, handle k + 1 in the outer half of limb k, on handle 0; each vertex
// follows the one that it is nearest to.
SkinnedModel figure() {
  SkinnedModel model;
  model.mesh = testing::moved(testing::icosphere(3), Vec3f::Constant(0.3f), Vec3f::Zero());
  for (const Vec3& end : kEnds) testing::addCapsule(model.mesh, 0.2 * end, end, 0.1 + 0.001 * end.y());
  model.skeleton.joints.resize(5);
  for (Index k = 0; k < 4; ++k) {
    model.skeleton.joints[k + 1].parent = 0;
    model.skeleton.joints[k + 1].rest.translation = 0.8 * kEnds[k];
  }
  model.weights.slots = 2;
  for (const Vec3f& p : model.mesh.positions) {
    Index own = 0;
    for (Index k = 0; k < 4; ++k) {
      if (p.cast<double>().dot(kEnds[k].normalized()) > 0.45) own = k + 1;
    }
    model.weights.joints.insert(model.weights.joints.end(), {own, 0});
    model.weights.weights.insert(model.weights.weights.end(), {1, 0});
  }
  return model;
}

// All four limbs are equal but the last.
HandleQuality qualityOf(const SkinnedModel& model) {
  std::vector<LimbEndOnModel> ends;
  for (const Vec3& end : kEnds) ends.push_back({end, 1, 0.1});
  ends.back().reach = 2;
  return measureHandles(model, ends);
}

// Vertices of one handle follow another.
void rename(SkinnedModel& model, Index from, Index to) {
  for (Index& joint : model.weights.joints) joint = joint == from ? to : joint;
}

TEST(HandleQuality, EndsAreThoseOfTheLimbs) {
  const std::vector<LimbEndOnModel> ends = limbEndsOf(figure().mesh);
  ASSERT_EQ(ends.size(), 4u);
  for (const Vec3& end : kEnds) {
    const bool isFound =
        std::any_of(ends.begin(), ends.end(), [&](const auto& found) { return (found.position - end).norm() < 0.2; });
    EXPECT_TRUE(isFound) << end.transpose();
  }
  EXPECT_TRUE(limbEndsOf(testing::flatGrid(3, 3)).empty());
}

TEST(HandleQuality, AGoodOneHasNoFault) {
  const HandleQuality quality = qualityOf(figure());
  EXPECT_EQ(quality.handles, 5u);
  EXPECT_EQ(quality.idle, 0u);
  EXPECT_EQ(quality.ends, 4u);
  EXPECT_EQ(quality.coveredEnds, 4u);
  EXPECT_EQ(quality.strayParents, 0u);
  EXPECT_EQ(quality.inside, 1);
  EXPECT_NEAR(quality.overAir, 0, 1e-12);
  EXPECT_EQ(quality.unequalEnds, 0u);
  EXPECT_EQ(quality.movedBeside, 0);
}

TEST(HandleQuality, EachFaultIsSeen) {
  SkinnedModel outside = figure();
  outside.skeleton.joints[1].rest.translation = Vec3(1, 1, 0);
  EXPECT_NEAR(qualityOf(outside).inside, 0.8, 1e-12);

  SkinnedModel idle = figure();
  idle.skeleton.joints.push_back({});
  idle.skeleton.joints.back().parent = 0;
  EXPECT_EQ(qualityOf(idle).idle, 1u);

  SkinnedModel lost = figure();  // a limb follows the root
  rename(lost, 2, 0);
  EXPECT_EQ(qualityOf(lost).coveredEnds, 3u);
  EXPECT_EQ(qualityOf(lost).idle, 1u);
  EXPECT_EQ(qualityOf(lost).unequalEnds, 1u) << "two equal ones have a handle";
  rename(lost, 1, 0);
  rename(lost, 3, 0);
  EXPECT_EQ(qualityOf(lost).unequalEnds, 0u) << "only the last has, and is longer";

  SkinnedModel shared = figure();  // two limbs follow one handle
  rename(shared, 2, 1);
  EXPECT_EQ(qualityOf(shared).coveredEnds, 2u);

  SkinnedModel stray = figure();  // one limb is a child of another
  stray.skeleton.joints[4].parent = 1;
  stray.skeleton.joints[4].rest.translation -= stray.skeleton.joints[1].rest.translation;
  EXPECT_EQ(qualityOf(stray).strayParents, 1u);
}

TEST(HandleQuality, ALimbThatAnotherDragsIsMovedBeside) {
  SkinnedModel model = figure();
  double dragged = 0, whole = 0;
  const std::vector<double> areas = vertexAreas(model.mesh);
  for (Index v = 0; v < model.mesh.vertexCount(); ++v) {
    whole += areas[v];
    if (model.weights.joints[2 * v] != 2) continue;
    model.weights.joints[2 * v + 1] = 1;
    model.weights.weights[2 * v] = 0.8f;
    model.weights.weights[2 * v + 1] = 0.2f;
    dragged += areas[v];
  }
  EXPECT_NEAR(qualityOf(model).movedBeside, dragged / whole / 4, 1e-9) << "by one handle of four";
  model.skeleton.joints[2].parent = 1;  // its child comes along
  EXPECT_EQ(qualityOf(model).movedBeside, 0);
}

TEST(HandleQuality, WeightBeyondAGapIsOverAir) {
  SkinnedModel model;
  model.mesh = testing::tube(24, 61, true);
  model.skeleton.joints.resize(3);
  model.skeleton.joints[1].parent = model.skeleton.joints[2].parent = 0;
  model.weights.slots = 2;
  Box box;
  for (Index v = 0; v < model.mesh.vertexCount(); ++v) box.add(model.mesh.position(v));
  Vec3::Index axis = 0;
  box.size().maxCoeff(&axis);
  for (Index v = 0; v < model.mesh.vertexCount(); ++v) {
    const double along = (model.mesh.position(v)[axis] - box.min[axis]) / box.longestSide();
    const Index own = along < 0.3 ? 1 : along > 0.7 ? 2 : 0;
    const float leaked = own == 2 ? 0.1f : 0;
    model.weights.joints.insert(model.weights.joints.end(), {own, own == 2 ? 1u : 0u});
    model.weights.weights.insert(model.weights.weights.end(), {1 - leaked, leaked});
  }
  EXPECT_NEAR(measureHandles(model, {}).overAir, 0.03, 0.01);
}

TEST(HandleQuality, TableHasALineForEachAndOneForAll) {
  const std::vector<HandleTableRow> rows = {{"stool", {8, 1, 4, 2, 2, 0, 1, 0.1, 0}},
                                            {"horse", {12, 0, 5, 5, 0, 1, 0.5, 0, 0.02}}};
  const Table table = handleTable(rows);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows.back().cells[1].number, 20);
  EXPECT_EQ(table.rows.back().cells[3].number, 1);
  EXPECT_EQ(table.rows.back().cells[5].number, 7);
  EXPECT_NEAR(*table.rows.back().cells[2].number, 70, 1e-9);
  EXPECT_EQ(table.rows.back().cells[6].number, 2);
  EXPECT_NEAR(*table.rows.back().cells[9].number, 1, 1e-9);
}

}  // namespace
}  // namespace limber
