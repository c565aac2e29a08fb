#include "limber/actions/parts/part_meshes.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/model_parts.h"
#include "limber/actions/parts/part_materials.h"
#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/core/error.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/samples/samples.h"
#include "shared_data.h"

namespace limber {
namespace {

// A capped tube along x that bends at its middle, as a rigged document.
Asset bendingTube() {
  const TriMesh mesh = testing::revolved(4, 21, 12, [](double) { return 0.5; });
  Asset asset = testing::assetOf(mesh);
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton = testing::twoJoints(2);
  skeleton.joints[0].rest.translation = {1, 2, 3};
  attachRig(asset, geometry, skeleton, testing::twoJointWeights(geometry.positions, 2, 1, 1));
  return asset;
}

SurfaceParts byWeights(const Asset& asset) {
  Progress progress;
  return modelParts(asset, {PartMethod::kWeights, PartDetail::kJoints, {}}, progress);
}

std::vector<PartNodes> takeApart(Asset& asset, const Geometry& geometry, const SurfaceParts& parts,
                                 const SplitOptions& options = {}) {
  Progress progress;
  return splitParts(asset, geometry, parts, options, progress);
}

// The corners of all triangles, those of each smallest first: positions, and weights in order of joints.
using Corner = std::vector<float>;
std::vector<std::array<Corner, 3>> cornersOf(const Asset& asset, const std::set<std::string>& without = {}) {
  const Geometry geometry = collectGeometry(asset);
  SkinWeights weights;
  if (hasRig(asset)) weights = readWeights(asset, geometry, readSkeleton(asset));
  std::vector<std::array<Corner, 3>> corners;
  for (const Triangle& t : geometry.triangles) {
    const auto instance = std::find_if(geometry.instances.rbegin(), geometry.instances.rend(),
                                       [&](const PrimitiveInstance& at) { return at.firstVertex <= t[0]; });
    const std::optional<Index> material =
        asset.document.meshes[instance->mesh].primitives[instance->primitive].material;
    if (material && without.count(asset.document.materials[*material].name) > 0) continue;
    std::array<Corner, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f& p = geometry.positions[t[c]];
      triangle[c] = {p.x(), p.y(), p.z()};
      if (weights.slots == 0) continue;
      std::map<Index, float> byJoint;
      for (Index slot = 0; slot < weights.slots; ++slot) {
        const float weight = weights.weightsOf(t[c])[slot];
        if (weight > 0) byJoint[weights.jointsOf(t[c])[slot]] += weight;
      }
      for (const auto& [joint, weight] : byJoint) {
        triangle[c].insert(triangle[c].end(), {static_cast<float>(joint), weight});
      }
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    corners.push_back(triangle);
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Edges that have other than two triangles, of what these nodes show.
std::size_t oddEdges(const Asset& asset, const std::vector<Index>& nodes) {
  const Geometry geometry = collectGeometry(asset);
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  std::map<std::pair<Index, Index>, int> edges;
  for (const Triangle& t : geometry.triangles) {
    const auto instance = std::find_if(geometry.instances.rbegin(), geometry.instances.rend(),
                                       [&](const PrimitiveInstance& at) { return at.firstVertex <= t[0]; });
    if (std::find(nodes.begin(), nodes.end(), instance->node) == nodes.end()) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = prepared.weldedVertex[t[c]], b = prepared.weldedVertex[t[(c + 1) % 3]];
      if (a != b) ++edges[std::minmax(a, b)];
    }
  }
  return static_cast<std::size_t>(
      std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 2; }));
}

void keepForValidator(const Asset& asset, const std::string& name) {
  checkAsset(asset);
  writeAsset(asset, testing::testOutputFolder() / ("parts_" + name + ".glb"));
}

TEST(SplitParts, ARiggedModelKeepsSkinWeightsAndTrianglesAndIsClosed) {
  Asset asset = bendingTube();
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  const Geometry geometry = collectGeometry(asset);
  const std::vector<PartNodes> parts = takeApart(asset, geometry, byWeights(asset));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "lower");
  for (const PartNodes& part : parts) {
    ASSERT_EQ(part.nodes.size(), 1u);
    const gltf::Node& node = asset.document.nodes[part.nodes[0]];
    EXPECT_EQ(node.name, part.name + "_part");  // joints have the names themselves
    EXPECT_TRUE(node.skin);
    EXPECT_EQ(oddEdges(asset, part.nodes), 0u);
  }
  EXPECT_EQ(cornersOf(asset, {"cut"}), before);
  EXPECT_GT(cornersOf(asset).size(), before.size());
  EXPECT_TRUE(asset.warnings.empty());
  keepForValidator(asset, "split_tube");
}

TEST(SplitParts, CapsHaveTheWeightsRoundThem) {
  Asset asset = bendingTube();
  const Geometry geometry = collectGeometry(asset);
  takeApart(asset, geometry, byWeights(asset));
  const Geometry split = collectGeometry(asset);
  const SkinWeights weights = readWeights(asset, split, readSkeleton(asset));
  std::map<std::array<float, 3>, float> upper;
  for (Index v = 0; v < split.positions.size(); ++v) {
    const Vec3f& p = split.positions[v];
    float sum = 0;
    for (Index slot = 0; slot < weights.slots; ++slot) {
      if (weights.jointsOf(v)[slot] == 1) sum += weights.weightsOf(v)[slot];
    }
    const auto [known, fresh] = upper.try_emplace({p.x(), p.y(), p.z()}, sum);
    EXPECT_NEAR(known->second, sum, 1e-6f);
  }
}

TEST(SplitParts, WithoutCapsTheSameTrianglesAreLeft) {
  Asset asset = bendingTube();
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  const Geometry geometry = collectGeometry(asset);
  takeApart(asset, geometry, byWeights(asset), {false});
  EXPECT_EQ(cornersOf(asset), before);
  checkAsset(asset);
}

TEST(SplitParts, AStaticModelHangsItsPartsBelowItsNode) {
  for (const bool unwelded : {false, true}) {
    Asset asset = testing::assetOf(testing::dumbbell(), unwelded);
    asset.document.nodes[0].scale = Vec3(-1, 2, 1);
    const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
    const Geometry geometry = collectGeometry(asset);
    Progress progress;
    const SurfaceParts found = modelParts(asset, {PartMethod::kAuto, {}, 2}, progress);
    const std::vector<PartNodes> parts = takeApart(asset, geometry, found);
    EXPECT_EQ(cornersOf(asset, {"cut"}), before);
    EXPECT_EQ(asset.document.nodes[0].children.size(), 2u);
    EXPECT_FALSE(asset.document.nodes[0].mesh);
    for (const PartNodes& part : parts) EXPECT_EQ(oddEdges(asset, part.nodes), 0u);
    keepForValidator(asset, unwelded ? "split_unwelded" : "split_static");
  }
}

TEST(SplitParts, MorphTargetsAndTheirAnimationGoWithEachPart) {
  Asset asset = readAsset(testing::everythingModel().glb(), "model.glb");
  const Geometry geometry = collectGeometry(asset);
  SurfaceParts parts;
  for (Index t = 0; t < geometry.triangles.size(); ++t) {
    parts.partOf.push_back(t);
    parts.names.push_back("part_" + std::to_string(t));
  }
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  const std::vector<PartNodes> split = takeApart(asset, geometry, parts);
  EXPECT_EQ(cornersOf(asset, {"cut"}), before);
  ASSERT_EQ(split.size(), 2u);
  for (const PartNodes& part : split) {
    const Index mesh = asset.document.nodes[part.nodes.at(0)].mesh.value();
    for (const gltf::Primitive& primitive : asset.document.meshes[mesh].primitives) {
      EXPECT_EQ(primitive.targets.size(), 1u);
    }
  }
  EXPECT_THAT(asset.warnings.items(), ::testing::Contains(::testing::Field(&Warning::kind, "open-cuts")));
  checkAsset(asset);
}

TEST(SplitParts, ASampleComesApartWhole) {
  Asset asset = makeSample("quadruped");
  const Geometry geometry = collectGeometry(asset);
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  Progress progress;
  const SurfaceParts found = modelParts(asset, {}, progress);
  EXPECT_GT(found.partCount(), 1u);
  const std::vector<PartNodes> parts = takeApart(asset, geometry, found);
  EXPECT_EQ(cornersOf(asset, {"cut"}), before);
  for (const PartNodes& part : parts) EXPECT_EQ(oddEdges(asset, part.nodes), 0u) << part.name;
  keepForValidator(asset, "split_quadruped");
}

TEST(PaintParts, EachPartHasAMaterialAndNothingElseChanges) {
  Asset asset = bendingTube();
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  const Geometry geometry = collectGeometry(asset);
  const SurfaceParts parts = byWeights(asset);
  const std::vector<Vec3f> tints = {{1, 0, 0}, {0, 0.5f, 0}};
  paintParts(asset, geometry, parts, tints);
  EXPECT_EQ(cornersOf(asset), before);
  const std::vector<gltf::Material>& materials = asset.document.materials;
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_EQ(materials[0].name, "lower");
  EXPECT_EQ(materials[1].pbrMetallicRoughness.value().baseColorFactor, Vec4(0, 0.5, 0, 1));
  EXPECT_EQ(cornersOf(asset, {"lower"}).size() + cornersOf(asset, {"upper"}).size(), before.size());
  keepForValidator(asset, "painted_tube");
}

TEST(PaintParts, TexturedMaterialsKeepTheirTextures) {
  Asset asset = readAsset(testing::everythingModel().glb(), "model.glb");
  const Geometry geometry = collectGeometry(asset);
  const SurfaceParts parts{{0, 1}, {"one", "two"}};
  paintParts(asset, geometry, parts, {});
  for (const gltf::Primitive& primitive : asset.document.meshes[geometry.instances[0].mesh].primitives) {
    const gltf::Material& material = asset.document.materials.at(primitive.material.value());
    EXPECT_TRUE(material.pbrMetallicRoughness.value().baseColorTexture);
    EXPECT_TRUE(material.name == "one" || material.name == "two");
  }
  checkAsset(asset);
}

TEST(PaintParts, NodesThatShowOneMeshGetOneEach) {
  Asset asset = testing::assetOf(testing::icosphere(1));
  gltf::Node other;
  other.mesh = 0;
  other.translation = Vec3(9, 0, 0);
  asset.document.scenes[0].nodes.push_back(addElement(asset.document.nodes, other));
  const std::vector<std::array<Corner, 3>> before = cornersOf(asset);
  const Geometry geometry = collectGeometry(asset);
  SurfaceParts parts;
  parts.names = {"a", "b", "c"};
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) parts.partOf.push_back(t < 80 ? (t < 30 ? 0 : 1) : 2);
  Asset split = asset.clone();
  paintParts(asset, geometry, parts, {});
  EXPECT_EQ(cornersOf(asset), before);
  EXPECT_EQ(asset.document.meshes.size(), 2u);
  EXPECT_EQ(cornersOf(asset, {"c"}).size(), 80u);
  takeApart(split, geometry, parts);
  EXPECT_EQ(cornersOf(split, {"cut"}), before);
  EXPECT_EQ(split.document.meshes.size(), 3u);
}

}  // namespace
}  // namespace limber
