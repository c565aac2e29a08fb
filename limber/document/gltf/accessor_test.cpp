#include "limber/document/gltf/accessor.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using testing::GltfBuilder;

Asset read(const GltfBuilder& model) {
  return readAsset(model.glb(), "model.glb");
}

template <typename T>
std::vector<float> floatsOf(const std::vector<T>& values, int componentType, bool normalized) {
  GltfBuilder model;
  const Index index = model.accessor(values, componentType, "SCALAR", values.size());
  model.json["accessors"][index]["normalized"] = normalized;
  return readFloats(read(model), index);
}

TEST(Accessor, NormalisedIntegersSpanTheirRange) {
  EXPECT_THAT(floatsOf<std::int8_t>({-128, -127, 0, 127}, 5120, true), ElementsAre(-1, -1, 0, 1));
  EXPECT_THAT(floatsOf<std::uint8_t>({0, 51, 255}, 5121, true), ElementsAre(0, 0.2f, 1));
  EXPECT_THAT(floatsOf<std::int16_t>({-32768, -32767, 0, 32767}, 5122, true), ElementsAre(-1, -1, 0, 1));
  EXPECT_THAT(floatsOf<std::uint16_t>({0, 13107, 65535}, 5123, true), ElementsAre(0, 0.2f, 1));
}

TEST(Accessor, OtherIntegersStayAsTheyAre) {
  EXPECT_THAT(floatsOf<std::int8_t>({-128, 127}, 5120, false), ElementsAre(-128, 127));
  EXPECT_THAT(floatsOf<std::uint16_t>({65535}, 5123, false), ElementsAre(65535));
  EXPECT_THAT(floatsOf<std::uint32_t>({16777216}, 5125, false), ElementsAre(16777216));
  EXPECT_THAT(floatsOf<float>({-1.5f, 1e30f}, 5126, false), ElementsAre(-1.5f, 1e30f));
}

TEST(Accessor, FollowsStrideAndOffsets) {
  GltfBuilder model;
  model.view<float>({9, 9});
  const Index view = model.view<float>({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, 20);
  const Index index = model.push(
      "accessors", {{"bufferView", view}, {"byteOffset", 4}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}});
  EXPECT_THAT(readFloats(read(model), index), ElementsAre(1, 2, 3, 6, 7, 8));
}

TEST(Accessor, LastElementNeedsNoFullStride) {
  GltfBuilder model;
  const Index view = model.view<std::uint8_t>({1, 0, 0, 0, 2, 0, 0, 0, 3}, 4);
  const Index index =
      model.push("accessors", {{"bufferView", view}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}});
  EXPECT_THAT(readIndices(read(model), index), ElementsAre(1, 2, 3));
}

// Columns of matrices begin at multiples of four bytes.
TEST(Accessor, SkipsMatrixPadding) {
  GltfBuilder model;
  const Index small = model.accessor<std::uint8_t>({1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0, 7, 8}, 5121, "MAT2", 2);
  const Index mat3 = model.accessor<std::int16_t>({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, -9, 0}, 5122, "MAT3", 1);
  const Index plain = model.accessor<float>({1, 2, 3, 4, 5, 6, 7, 8, 9}, 5126, "MAT3", 1);
  const Asset asset = read(model);
  EXPECT_THAT(readFloats(asset, small), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(readIndices(asset, small), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(readFloats(asset, mat3), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, -9));
  EXPECT_THAT(readFloats(asset, plain), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST(Accessor, SparseSubstitutesIntoDataOrZeros) {
  GltfBuilder model;
  const Index base = model.view<float>({1, 2, 3, 4, 5, 6}), values = model.view<float>({70, 80});
  const Index indices = model.view<std::uint16_t>({2});
  const Json sparse = {{"count", 1},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  const Index over = model.push(
      "accessors", {{"bufferView", base}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}, {"sparse", sparse}});
  const Index zeros =
      model.push("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}, {"sparse", sparse}});
  const Asset asset = read(model);
  EXPECT_THAT(readFloats(asset, over), ElementsAre(1, 2, 3, 4, 70, 80));
  EXPECT_THAT(readFloats(asset, zeros), ElementsAre(0, 0, 0, 0, 70, 80));
}

TEST(Accessor, WithoutAViewIsZeros) {
  GltfBuilder model;
  const Index index = model.push("accessors", {{"componentType", 5123}, {"count", 2}, {"type", "VEC2"}});
  const Asset asset = read(model);
  EXPECT_THAT(readFloats(asset, index), ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(readIndices(asset, index), ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(accessorInfo(asset, index).count, 2u);
  EXPECT_EQ(accessorInfo(asset, index).components, 2u);
  EXPECT_EQ(accessorInfo(asset, index).type, ComponentType::kU16);
}

TEST(Accessor, IndicesOfEveryWidth) {
  GltfBuilder model;
  const Index bytes = model.accessor<std::uint8_t>({0, 255}, 5121, "SCALAR", 2);
  const Index shorts = model.accessor<std::uint16_t>({1, 65535}, 5123, "SCALAR", 2);
  const Index words = model.accessor<std::uint32_t>({2, 4294967295u}, 5125, "SCALAR", 2);
  const Index floats = model.accessor<float>({0}, 5126, "SCALAR", 1);
  const Index signedBytes = model.accessor<std::int8_t>({0}, 5120, "SCALAR", 1);
  const Asset asset = read(model);
  EXPECT_THAT(readIndices(asset, bytes), ElementsAre(0, 255));
  EXPECT_THAT(readIndices(asset, shorts), ElementsAre(1, 65535));
  EXPECT_THAT(readIndices(asset, words), ElementsAre(2, 4294967295u));
  EXPECT_THROW(readIndices(asset, floats), Error);
  EXPECT_THROW(readIndices(asset, signedBytes), Error);
}

TEST(Accessor, AddedOnesReadBack) {
  Asset asset = readAsset(testing::everythingModel().glb(), "model.glb");
  const std::size_t buffers = asset.buffers.size();
  const std::vector<std::uint8_t> joints = {1, 2, 3, 4, 250, 0, 0, 9};
  const Index a = addAccessor(asset, {2, 4, ComponentType::kU8, false}, joints, kVertexTarget);
  const std::vector<float> values = {1, 5, -2, 0.1f, 3, -8};
  const Index b = addFloatAccessor(asset, values, 3, kVertexTarget, true);
  EXPECT_EQ(asset.buffers.size(), buffers);  // the binary chunk grew
  checkAsset(asset);
  const Asset again = readAsset(writeGlb(asset), "again.glb");
  EXPECT_THAT(readIndices(again, a), ElementsAre(1, 2, 3, 4, 250, 0, 0, 9));
  EXPECT_EQ(readFloats(again, b), values);
  const gltf::Accessor& accessor = again.document.accessors[b];
  EXPECT_EQ(accessor.min, (std::vector<double>{0.1f, 3, -8}));
  EXPECT_EQ(accessor.max, (std::vector<double>{1, 5, -2}));
  EXPECT_EQ(accessor.type, gltf::ElementType::kVec3);
  EXPECT_EQ(again.document.bufferViews[*accessor.bufferView].target, kVertexTarget);
}

TEST(Accessor, AddingToFilesBesideMakesANewBuffer) {
  Asset asset = readAsset(asBytes(testing::everythingModel().gltf()), "model.gltf");
  const Bytes before = asset.buffers[0].bytes;
  const Index a = addFloatAccessor(asset, std::vector<float>{1, 2}, 1);
  const Index b = addFloatAccessor(asset, std::vector<float>{3}, 1);
  ASSERT_EQ(asset.buffers.size(), 2u);
  EXPECT_EQ(asset.buffers[0].bytes, before);
  EXPECT_EQ(readFloats(asset, a), (std::vector<float>{1, 2}));
  EXPECT_EQ(readFloats(asset, b), (std::vector<float>{3}));
  checkAsset(asset);
}

TEST(Accessor, AddingToAnEmptyAsset) {
  Asset asset;
  const Index index = addFloatAccessor(asset, std::vector<float>{1, 2, 3, 4}, 4);
  checkAsset(asset);
  EXPECT_EQ(readFloats(asset, index), (std::vector<float>{1, 2, 3, 4}));
}

TEST(Accessor, AddingWhatDoesNotFitIsAnError) {
  Asset asset;
  const Bytes seven(7);
  EXPECT_THROW(addAccessor(asset, {2, 1, ComponentType::kF32, false}, seven), Error);
  EXPECT_THROW(addFloatAccessor(asset, std::vector<float>{1, 2, 3}, 2), Error);
  EXPECT_THROW(addAccessor(asset, {1, 7, ComponentType::kU8, false}, seven), Error);
}

TEST(Accessor, BoundsAreRawValuesAndFinite) {
  GltfBuilder model;
  const Index shorts = model.accessor<std::int16_t>({-5, 7, 32767, -9}, 5122, "VEC2", 2);
  model.json["accessors"][shorts]["normalized"] = true;
  const Index bad = model.accessor<float>({0, std::numeric_limits<float>::infinity()}, 5126, "SCALAR", 2);
  model.json["accessors"][bad]["min"] = {0};
  Asset asset = read(model);
  setBounds(asset, shorts);
  setBounds(asset, bad);
  const Json json = testing::documentJson(asset);
  EXPECT_EQ(json["accessors"][shorts]["min"].dump(), "[-5,-9]");
  EXPECT_EQ(json["accessors"][shorts]["max"].dump(), "[32767,7]");
  EXPECT_FALSE(json["accessors"][bad].contains("min"));
}

}  // namespace
}  // namespace limber
