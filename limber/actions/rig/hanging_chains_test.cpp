#include "limber/actions/rig/hanging_chains.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"

namespace limber {
namespace {

// A strip of cloth in the plane z = 0 that hangs from y = 1 to y = 0, as prepareMesh gives it.
struct Strip {
  PreparedMesh prepared;
  Accessories accessories;
  std::vector<HungAccessory> hung;
  Skeleton made;
  SkinWeights weights;

  explicit Strip(Index slots) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    constexpr Index kRows = 13;
    for (Index row = 0; row < kRows; ++row) {
      const float y = 3 - 2 * static_cast<float>(row) / (kRows - 1);
      positions.push_back({-0.1f, y, 0});
      positions.push_back({0.1f, y, 0});
      if (row == 0) continue;
      const Index a = 2 * row - 2;
      triangles.push_back({a, a + 1, a + 2});
      triangles.push_back({a + 1, a + 3, a + 2});
    }
    prepared = prepareMesh(positions, triangles);
    accessories.names = {"Red_Cape"};
    accessories.words = {"cape"};
    accessories.hangs = {true};
    HungAccessory cape;
    for (Index v = 0; v < prepared.mesh.vertexCount(); ++v) cape.vertices.push_back(v);
    cape.position = prepared.frame.toWorking({0, 3, 0});
    hung = {cape};
    made.joints.resize(2);
    made.joints[0].name = "chest";
    made.joints[1].name = "cape1";  // a name that is taken
    made.joints[1].parent = 0;
    weights.slots = slots;
    weights.joints.assign(cape.vertices.size() * slots, 0);
    weights.weights.assign(cape.vertices.size() * slots, 0.0f);
  }

  std::vector<HangingChain> add() { return addChains(prepared, accessories, hung, made, weights); }
};

TEST(HangingChains, RunFromTheBodyToTheFarEnd) {
  Strip strip(4);
  const std::vector<HangingChain> chains = strip.add();
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains[0].name, "Red_Cape");
  checkSkeleton(strip.made);
  ASSERT_EQ(strip.made.jointCount(), 6u);
  EXPECT_EQ(chains[0].joints, (std::vector<Index>{2, 3, 4, 5}));
  EXPECT_EQ(strip.made.joints[2].name, "cape2_1");
  EXPECT_EQ(strip.made.joints[5].name, "cape2_End");
  EXPECT_EQ(strip.made.joints[2].parent, 0u);
  const std::vector<Affine> globals = restGlobals(strip.made);
  EXPECT_NEAR(globals[2].translation().y(), 3, 1e-5);
  EXPECT_NEAR(globals[3].translation().y(), 3 - 2.0 / 3, 0.1);
  EXPECT_NEAR(globals[5].translation().y(), 1, 0.2);
  EXPECT_NEAR(globals[3].linear().col(1).y(), -1, 1e-6) << "along the chain";
}

TEST(HangingChains, BindTheirVerticesAlongThem) {
  for (const Index slots : {1u, 4u}) {
    Strip strip(slots);
    strip.add();
    for (Index v = 0; v < strip.weights.vertexCount(); ++v) {
      float sum = 0;
      for (Index k = 0; k < slots; ++k) {
        const float weight = strip.weights.weightsOf(v)[k];
        sum += weight;
        if (!(weight > 0)) continue;
        EXPECT_GE(strip.weights.jointsOf(v)[k], 2u);
        EXPECT_LE(strip.weights.jointsOf(v)[k], 4u) << "the end moves nothing";
      }
      EXPECT_NEAR(sum, 1, 1e-6);
    }
    EXPECT_EQ(strip.weights.jointsOf(0)[0], 2u);
    EXPECT_EQ(strip.weights.jointsOf(strip.weights.vertexCount() - 1)[0], 4u);
  }
}

TEST(HangingChains, AreNoneForWhatIsStiff) {
  Strip strip(4);
  strip.accessories.hangs = {false};
  EXPECT_TRUE(strip.add().empty());
  EXPECT_EQ(strip.made.jointCount(), 2u);
}

TEST(HangingChains, AreNoneForWhatHasNoLength) {
  Strip strip(4);
  strip.hung[0].vertices = {0};
  strip.hung[0].position = strip.prepared.mesh.position(0);
  EXPECT_TRUE(strip.add().empty());
  strip.hung[0].vertices.clear();
  EXPECT_TRUE(strip.add().empty());
}

TEST(HangingChains, AreWrittenAsSprings) {
  Strip strip(4);
  const std::vector<HangingChain> chains = strip.add();
  Asset asset;
  const std::vector<Index> nodes = {10, 11, 12, 13, 14, 15};
  writeSprings(asset, nodes, chains);
  const auto written = [&] { return extensionOf(asset.document, "VRMC_springBone")->at("springs"); };
  const Json springs = written();
  ASSERT_EQ(springs.size(), 1u);
  ASSERT_EQ(springs[0]["joints"].size(), 4u);
  EXPECT_EQ(springs[0]["joints"][0]["node"], 12);
  EXPECT_GT(springs[0]["joints"][0]["gravityPower"], 0);
  EXPECT_EQ(asset.document.extensionsUsed, std::vector<std::string>{"VRMC_springBone"});
  writeSprings(asset, nodes, chains);
  EXPECT_EQ(written().size(), 2u) << "beside those that there are";
  EXPECT_EQ(asset.document.extensionsUsed.size(), 1u);
  Asset bare;
  writeSprings(bare, nodes, {});
  EXPECT_FALSE(bare.document.extensions.exists());
}

}  // namespace
}  // namespace limber
