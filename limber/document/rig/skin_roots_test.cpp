#include "limber/document/rig/skin_roots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::ElementsAre;

TEST(SkinRoots, GetANodeAboveThemAll) {
  gltf::Document document;
  document.nodes.resize(5);  // 0 above 1 above 2; 3; 4 above nothing and in no skin
  document.nodes[0].children = {1};
  document.nodes[1].children = {2};
  document.scenes.resize(1);
  document.scenes[0].nodes = {4, 0, 3};
  document.scene = 0;
  document.skins.resize(1);
  document.skins[0].joints = {2, 3, 1};
  UniqueNames names;
  joinSkinRoots(document, names);
  ASSERT_EQ(document.nodes.size(), 6u);
  EXPECT_THAT(document.nodes[5].children, ElementsAre(0, 3));
  EXPECT_THAT(document.scenes[0].nodes, ElementsAre(4, 5));
}

// Joints times depth were minutes.
TEST(SkinRoots, OfALongChainAreFoundAtOnce) {
  constexpr Index kNodes = 400'000;
  gltf::Document document;
  document.nodes.resize(kNodes);
  document.skins.resize(1);
  for (Index n = 0; n < kNodes; ++n) {
    if (n + 1 < kNodes) document.nodes[n].children = {n + 1};
    document.skins[0].joints.push_back(n);
  }
  UniqueNames names;
  joinSkinRoots(document, names);
  EXPECT_EQ(document.nodes.size(), kNodes) << "one root needs none above it";
}

}  // namespace
}  // namespace limber
