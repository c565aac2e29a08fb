// A body of one tall box, with a small box beside it under different names.
#include "limber/actions/rig/accessories.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/document/gltf/accessor.h"

namespace limber {
namespace {

struct Named {
  std::string node, mesh, material;
};

void addBox(Asset& asset, const Vec3f& low, const Vec3f& high, const Named& names) {
  std::vector<float> positions;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back((corner >> axis & 1) != 0 ? high[axis] : low[axis]);
  }
  const std::vector<std::uint32_t> corners = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                              2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  gltf::Document& document = asset.document;
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.indices =
      addAccessor(asset, {static_cast<Index>(corners.size()), 1, ComponentType::kU32, false},
                  {reinterpret_cast<const std::uint8_t*>(corners.data()), 4 * corners.size()}, kIndexTarget);
  gltf::Material material;
  material.name = names.material;
  primitive.material = addElement(document.materials, std::move(material));
  gltf::Mesh mesh;
  mesh.name = names.mesh;
  mesh.primitives.push_back(std::move(primitive));
  gltf::Node node;
  node.name = names.node;
  node.mesh = addElement(document.meshes, std::move(mesh));
  document.scenes[0].nodes.push_back(addElement(document.nodes, std::move(node)));
}

// The body reaches from 0 to 2 in y; the thing touches it at its top end.
Asset bodyWith(const Named& thing, float size = 0.2f) {
  Asset asset;
  asset.document.scenes.emplace_back();
  addBox(asset, {-0.3f, 0, -0.3f}, {0.3f, 2, 0.3f}, {"Body", "Body", "Skin"});
  addBox(asset, {0.31f, 1.8f, -0.1f}, {0.31f + size, 1.8f + size, 0.1f}, thing);
  checkAsset(asset);
  return asset;
}

std::vector<std::string> namesIn(const Named& thing, float size = 0.2f) {
  const Asset asset = bodyWith(thing, size);
  return findAccessories(asset, collectGeometry(asset)).names;
}

using Names = std::vector<std::string>;

TEST(Accessories, AreToldByTheWordsOfNodesMeshesAndMaterials) {
  EXPECT_EQ(namesIn({"Knight_Cape", "Cube.001", ""}), Names{"Knight_Cape"});
  const Asset cape = bodyWith({"Knight_Cape", "", ""});
  EXPECT_EQ(findAccessories(cape, collectGeometry(cape)).words, Names{"cape"});
  EXPECT_TRUE(findAccessories(cape, collectGeometry(cape)).hangs[0]);
  EXPECT_EQ(namesIn({"Cube", "1H_Sword", ""}), Names{"1H_Sword"});
  EXPECT_EQ(namesIn({"Cube", "Cube", "GunMetal_gun"}), Names{"GunMetal_gun"});
  EXPECT_EQ(namesIn({"Cube", "Cube", "Capelin"}), Names{});
  EXPECT_EQ(namesIn({"ArmLeft_Shield", "Cube", ""}), Names{});  // names a part of the body, too
}

TEST(Accessories, AreNoneWhereTheyAreMostOfTheModel) {
  EXPECT_EQ(namesIn({"Sword", "", ""}, 3), Names{});
}

TEST(Accessories, FollowTheJointOfTheBodyThatIsNearest) {
  const Asset asset = bodyWith({"Mug", "", ""});
  const Geometry geometry = collectGeometry(asset);
  const Accessories accessories = findAccessories(asset, geometry);
  EXPECT_EQ(bodyTriangles(geometry, accessories).size(), 12u);

  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  SkinWeights weights;
  weights.slots = 2;
  for (Index v = 0; v < prepared.mesh.vertexCount(); ++v) {
    const double height = prepared.frame.toSource(prepared.mesh.position(v)).y();
    const auto upper = static_cast<float>(std::clamp(height / 2, 0.0, 1.0));
    weights.joints.insert(weights.joints.end(), {0, 1});
    weights.weights.insert(weights.weights.end(), {1 - upper, upper});
  }
  const SkinWeights before = weights;
  hangAccessories(geometry, prepared, accessories, weights);
  for (Index source = 0; source < 16; ++source) {
    const Index v = prepared.weldedVertex[source];
    if (source < 8) {
      EXPECT_EQ(weights.weightsOf(v)[0], before.weightsOf(v)[0]);
    } else {
      EXPECT_EQ(weights.jointsOf(v)[0], 1u);
      EXPECT_EQ(weights.weightsOf(v)[0], 1);
      EXPECT_EQ(weights.weightsOf(v)[1], 0);
    }
  }
}

}  // namespace
}  // namespace limber
