#include "limber/session/rigged_model.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/asset/pose_io.h"
#include "limber/asset/testing/scene_builder.h"

namespace limber {
namespace {

using testing::SceneBuilder;

// Two tetrahedra, each held by one of two joints, whose nodes stand as the first's skin is bound. The second's skin
// holds its mesh `off` its place; at (0, 0, -3) its inverse binds are the identity, as which no binds are read.
Asset partsToOpen(const Vec3f& off, bool hasBinds = true) {
  SceneBuilder scene;
  const Index left = scene.addNode({{"name", "left"}});
  const Index right = scene.addNode({{"name", "right"}, {"translation", {0, 0, 3}}});
  const Affine toRight = testing::translation(0, 0, -3);
  const Affine elsewhere = toRight * testing::translation(-off.x(), -off.y(), -off.z());
  std::vector<Affine> binds = {Affine::Identity(), toRight}, others = {Affine::Identity(), elsewhere};
  if (!hasBinds) others.clear();
  const Index skins[] = {scene.addSkin({left, right}, binds), scene.addSkin({left, right}, others)};
  std::vector<Index> roots = {left, right};
  for (std::uint8_t part = 0; part < 2; ++part) {
    const Vec3f place(2.0f * part, 0, 0);
    const Index mesh = scene.addTetrahedron(part == 1 ? Vec3f(place + off) : place);
    scene.bindRigidly(mesh, std::vector<std::uint8_t>(4, part));
    roots.push_back(scene.addNode({{"mesh", mesh}, {"skin", skins[part]}}));
  }
  scene.asset().document.scene = scene.addScene(roots);
  return scene.build();
}

void expectSamePlaces(const std::vector<Vec3f>& found, const std::vector<Vec3f>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) EXPECT_LT((found[v] - wanted[v]).norm(), 1e-5f) << v;
}

std::vector<Vec3f> asItsNodesStand(const RiggedModel& model) {
  return posedPositions(model, readNodePose(*model.asset, model.binding));
}

TEST(OpenRiggedModel, BringsSkinsToOneBindPose) {
  const std::shared_ptr<const RiggedModel> alike = openRiggedModel(partsToOpen(Vec3f::Zero()));
  EXPECT_TRUE(alike->asset->warnings.empty());
  const Asset elsewhere = partsToOpen({0, 5, 0}), unbound = partsToOpen({0, 0, -3}, false);
  ASSERT_FALSE(unbound.document.skins[1].inverseBindMatrices);
  for (const Asset* asset : {&elsewhere, &unbound}) {
    const std::shared_ptr<const RiggedModel> model = openRiggedModel(*asset);
    expectSamePlaces(model->geometry->positions, alike->geometry->positions);
    expectSamePlaces(asItsNodesStand(*model), asItsNodesStand(*alike));
    ASSERT_EQ(model->asset->warnings.items().size(), 1u);
    EXPECT_EQ(model->asset->warnings.items()[0].kind, "joined-binds");
  }
}

}  // namespace
}  // namespace limber
