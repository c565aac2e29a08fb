#include "limber/session/rigged_model.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/rig/pose_io.h"
#include "limber/document/testing/two_bind_poses.h"

namespace limber {
namespace {

void expectSamePositions(const std::vector<Vec3f>& found, const std::vector<Vec3f>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) EXPECT_LT((found[v] - expected[v]).norm(), 1e-5f) << v;
}

std::vector<Vec3f> asItsNodesStand(const RiggedModel& model) {
  return posedPositions(model, readNodePose(model.asset(), model.binding()));
}

TEST(OpenRiggedModel, BringsSkinsToOneBindPose) {
  const std::shared_ptr<const RiggedModel> alike = openRiggedModel(testing::partsInTwoBindPoses(Vec3f::Zero()));
  EXPECT_TRUE(alike->asset().warnings.empty());
  const Asset elsewhere = testing::partsInTwoBindPoses({0, 5, 0}),
              unbound = testing::partsInTwoBindPoses({0, 0, -3}, false);
  ASSERT_FALSE(unbound.document.skins[1].inverseBindMatrices);
  for (const Asset* asset : {&elsewhere, &unbound}) {
    const std::shared_ptr<const RiggedModel> model = openRiggedModel(*asset);
    expectSamePositions(model->geometry().positions, alike->geometry().positions);
    expectSamePositions(asItsNodesStand(*model), asItsNodesStand(*alike));
    ASSERT_EQ(model->asset().warnings.items().size(), 1u);
    EXPECT_EQ(model->asset().warnings.items()[0].kind, "joined-binds");
  }
}

}  // namespace
}  // namespace limber
