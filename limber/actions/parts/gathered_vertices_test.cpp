#include "limber/actions/parts/gathered_vertices.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_layout.h"

namespace limber {
namespace {

// Equal to within rounding.
::testing::Matcher<const std::vector<float>&> floats(const std::vector<float>& values) {
  return ::testing::Pointwise(::testing::FloatEq(), values);
}

template <typename T>
Index addValues(Asset& asset, const AccessorInfo& info, const std::vector<T>& values) {
  return addAccessor(asset, info, {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)},
                     kVertexTarget);
}

TEST(GatheredVertices, NormalisedIntegersKeepTheirTypeAndValues) {
  Asset asset;
  const std::vector<std::uint8_t> colors = {255, 0, 51, 255, 0, 102, 0, 255, 204, 0, 0, 0};
  const Index from = addValues(asset, {3, 4, ComponentType::kU8, true}, colors);
  const Index to = gatherAccessor(asset, from, std::vector<Index>{2, 0, 2}, false);
  const AccessorInfo info = accessorInfo(asset, to);
  EXPECT_EQ(info.count, 3u);
  EXPECT_EQ(info.components, 4u);
  EXPECT_EQ(info.type, ComponentType::kU8);
  EXPECT_TRUE(info.normalized);
  const std::vector<float> values = readFloats(asset, to);
  EXPECT_THAT(values, floats({0.8f, 0, 0, 0, 1, 0, 0.2f, 1, 0.8f, 0, 0, 0}));
}

TEST(GatheredVertices, ElementsThatFillNoWholeWordsBecomeFloatsOfTheSameValue) {
  Asset asset;
  const std::vector<std::uint16_t> values = {0, 65535, 13107, 65535, 0, 26214};
  const Index from = addValues(asset, {2, 3, ComponentType::kU16, true}, values);
  const Index to = gatherAccessor(asset, from, std::vector<Index>{1, 0}, false);
  EXPECT_EQ(accessorInfo(asset, to).type, ComponentType::kF32);
  EXPECT_FALSE(accessorInfo(asset, to).normalized);
  EXPECT_THAT(readFloats(asset, to), floats({1, 0, 0.4f, 0, 1, 0.2f}));
}

TEST(GatheredVertices, SparseElementsAreReadAsTheyAreAndBoundsAreThoseOfTheNewOnes) {
  Asset asset;
  const Index from = addFloatAccessor(asset, std::vector<float>{0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}, 3, kVertexTarget);
  const Index numbers = addValues(asset, {2, 1, ComponentType::kU16, false}, std::vector<std::uint16_t>{1, 3});
  const Index replaced = addFloatAccessor(asset, std::vector<float>{-5, 7, 9, 30, 40, 50}, 3, kVertexTarget);
  std::vector<gltf::Accessor>& accessors = asset.document.accessors;
  gltf::Sparse& sparse = accessors[from].sparse.emplace();
  sparse.count = 2;
  sparse.indices.bufferView = accessors[numbers].bufferView.value();
  sparse.indices.componentType = ComponentType::kU16;
  sparse.values.bufferView = accessors[replaced].bufferView.value();
  const Index to = gatherAccessor(asset, from, std::vector<Index>{3, 2, 1}, true);
  EXPECT_THAT(readFloats(asset, to), floats({30, 40, 50, 2, 2, 2, -5, 7, 9}));
  EXPECT_FALSE(accessors[to].sparse);
  EXPECT_THAT(accessors[to].min, ::testing::ElementsAre(-5, 2, 2));
  EXPECT_THAT(accessors[to].max, ::testing::ElementsAre(30, 40, 50));
}

TEST(GatheredVertices, MorphTargetsGoAlongAndIndicesDoNot) {
  Asset asset;
  const Index positions = addFloatAccessor(asset, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3, kVertexTarget);
  const Index offsets = addFloatAccessor(asset, std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 3}, 3, kVertexTarget);
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", positions);
  primitive.indices = 7;
  primitive.material = 2;
  primitive.targets.emplace_back().set("POSITION", offsets);
  const gltf::Primitive gathered = gatherVertices(asset, primitive, std::vector<Index>{2, 1});
  EXPECT_FALSE(gathered.indices);
  EXPECT_EQ(gathered.material, 2u);
  const auto read = [&](const gltf::Attributes& attributes) {
    return readFloats(asset, attributes.find("POSITION").value());
  };
  EXPECT_THAT(read(gathered.attributes), floats({0, 1, 0, 1, 0, 0}));
  EXPECT_THAT(read(gathered.targets.at(0)), floats({0, 0, 3, 0, 0, 2}));
}

}  // namespace
}  // namespace limber
