#include "limber/document/mesh/rest_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/testing/two_bind_poses.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(RestMesh, APlainModelIsWholeWithoutAWarning) {
  testing::SceneBuilder scene;
  const Index mesh = scene.addTetrahedron(Vec3f(2, 0, 0));
  const Index node = scene.addNode({{"mesh", mesh}, {"translation", {0, 5, 0}}});
  scene.asset().document.scene = scene.addScene({node});
  const Asset asset = scene.build();
  Warnings warnings;
  const ExportMesh rest = exportRestMesh(asset, warnings);
  EXPECT_EQ(rest.positions, collectGeometry(asset).positions);
  EXPECT_EQ(rest.positions.at(0), Vec3f(2, 5, 0));
  EXPECT_THAT(testing::warningKinds(warnings), IsEmpty());
}

// The second part is bound 7 to the side of where its joint is, and comes back to it.
TEST(RestMesh, ARiggedOneIsInOneRestPoseAndSaysWhatIsLost) {
  const Asset asset = testing::partsInTwoBindPoses(Vec3f(0, 7, 0));
  Warnings warnings;
  const ExportMesh rest = exportRestMesh(asset, warnings);
  ASSERT_EQ(rest.positions.size(), 8u);
  EXPECT_LT((rest.positions[4] - Vec3f(2, 0, 0)).norm(), 1e-5f) << rest.positions[4].transpose();
  EXPECT_THAT(testing::warningKinds(warnings), ElementsAre("lost-rig"));
}

TEST(RestMesh, CountsClipsThatAreLost) {
  Asset asset = testing::partsInTwoBindPoses(Vec3f::Zero());
  for (const char* name : {"walk", "run"}) asset.document.animations.emplace_back().name = name;
  Warnings warnings;
  exportRestMesh(asset, warnings);
  EXPECT_THAT(testing::warningKinds(warnings), ElementsAre("lost-rig", "lost-clips"));
  EXPECT_EQ(testing::countOf(warnings, "lost-clips"), 2u);
}

}  // namespace
}  // namespace limber
