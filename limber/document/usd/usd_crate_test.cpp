#include "limber/document/usd/usd_crate.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/usd/testing/crate_reader.h"

namespace limber {
namespace {

using testing::CrateContent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::readCrate;

constexpr std::uint64_t kOffsetMask = 0xffffffffffff;

UsdStage emptyStage() {
  UsdStage stage;
  stage.root.type = "Xform";
  stage.root.name = kUsdRoot;
  return stage;
}

// The numbers at the offset that the 64 bits of a field give, after their count.
template <typename Number>
std::vector<Number> listAt(const Bytes& crate, std::uint64_t rep) {
  std::uint64_t count = 0;
  std::memcpy(&count, &crate.at(rep & kOffsetMask), 8);
  std::vector<Number> list(count);
  std::memcpy(list.data(), &crate.at((rep & kOffsetMask) + 8), count * sizeof(Number));
  return list;
}

TEST(UsdCrate, HoldsTheTreeOfPrimsAndProperties) {
  UsdStage stage = emptyStage();
  UsdPrim first{"Scope", "first", {}, {}, {}}, inner{"Mesh", "inner", {"SkelBindingAPI"}, {}, {}},
      second{"Mesh", "second", {}, {}, {}}, last{"Scope", "last", {}, {}, {}};
  inner.addUniform("bool", "doubleSided", true);
  first.children = {inner, last};
  second.relate("material:binding", {"/Model/first/inner"});
  second.add("float", "size", 1.5f);
  stage.root.children = {first, second};
  const Bytes crate = usdCrate(stage);
  const CrateContent content = readCrate(crate);
  std::vector<std::string> paths;
  for (const auto& [path, kind] : content.kinds) paths.push_back(path);
  EXPECT_THAT(
      paths, ElementsAre("/", "/Model", "/Model/first", "/Model/first/inner", "/Model/first/inner.doubleSided",
                         "/Model/first/last", "/Model/second", "/Model/second.material:binding", "/Model/second.size"));
  EXPECT_EQ(content.kinds.at("/"), 7);
  EXPECT_EQ(content.kinds.at("/Model/second"), 6);
  EXPECT_EQ(content.kinds.at("/Model/second.material:binding"), 8);
  EXPECT_EQ(content.kinds.at("/Model/second.size"), 1);
  const auto& size = content.fields.at("/Model/second.size");
  EXPECT_EQ(size.at("default"), 0x4008'0000'3fc0'0000u);  // inlined, of type 8, 1.5
  EXPECT_EQ(content.tokens[size.at("typeName") & kOffsetMask], "float");
  EXPECT_EQ(content.fields.at("/Model/first/inner.doubleSided").at("variability") & kOffsetMask, 1u);
}

TEST(UsdCrate, APrimMayHaveANameForUsers) {
  UsdStage stage = emptyStage();
  stage.root.displayName = "\xe8\x85\xb0";
  const Bytes crate = usdCrate(stage);
  const CrateContent content = readCrate(crate);
  const std::uint64_t rep = content.fields.at("/Model").at("displayName");
  EXPECT_EQ(rep >> 48, 0x400au);  // inlined, of type 10
  EXPECT_THAT(content.tokens, ::testing::Contains(stage.root.displayName));
}

TEST(UsdCrate, ListsOfNumbersLieAtMultiplesOfEightOnce) {
  UsdStage stage = emptyStage();
  const std::vector<Vec3f> points = {{1, 2, 3}, {4, 5, 6}};
  stage.root.add("point3f[]", "points", points);
  stage.root.add("float3[]", "others", points);
  stage.root.add("half3[]", "scales", points);
  stage.root.add("quatf[]", "turns", std::vector<Eigen::Quaternionf>{{0.5f, 1, 2, 3}});
  stage.root.add("int[]", "none", std::vector<int>());
  const Bytes crate = usdCrate(stage);
  const CrateContent content = readCrate(crate);
  const auto valueOf = [&](const char* name) { return content.fields.at(std::string("/Model.") + name).at("default"); };
  EXPECT_EQ(valueOf("points"), valueOf("others"));
  EXPECT_EQ(valueOf("points") % 8, 0u);
  EXPECT_EQ(valueOf("points") >> 48, 0x8018u);  // an array of type 24
  std::vector<float> numbers(6);
  std::memcpy(numbers.data(), &crate[(valueOf("points") & kOffsetMask) + 8], 24);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(listAt<std::uint16_t>(crate, valueOf("scales"))[0], 0x3c00);  // 1 as a half
  std::memcpy(numbers.data(), &crate[(valueOf("turns") & kOffsetMask) + 8], 16);
  EXPECT_THAT(std::vector<float>(numbers.begin(), numbers.begin() + 4), ElementsAre(1, 2, 3, 0.5f));  // w last
  EXPECT_EQ(valueOf("none"), 0x8003'0000'0000'0000u);
}

TEST(UsdCrate, FewDifferentNumbersComeOutOfATable) {
  UsdStage stage = emptyStage();
  std::vector<float> weights;
  for (int i = 0; i < 100; ++i) weights.push_back(i % 3 == 0 ? 0.25f : 0.75f);
  stage.root.add("float[]", "weights", weights);
  const Bytes crate = usdCrate(stage);
  const std::uint64_t rep = readCrate(crate).fields.at("/Model.weights").at("default");
  EXPECT_EQ(rep >> 48, 0xa008u);  // an array of type 8, compressed
  testing::ByteReader reader(crate, rep & kOffsetMask);
  ASSERT_EQ(reader.number(8), 100u);
  ASSERT_EQ(reader.number(1), 't');
  std::vector<float> table(reader.number(4));
  ASSERT_EQ(table.size(), 2u);
  std::memcpy(table.data(), reader.take(8).data(), 8);
  const std::vector<std::int32_t> numbers = testing::nextIntegers(reader, 100);
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_EQ(table.at(static_cast<std::size_t>(numbers[i])), weights[i]);
}

TEST(UsdCrate, SamplesHaveTheirTimes) {
  UsdStage stage = emptyStage();
  stage.endTimeCode = 12;
  UsdProperty& turns = stage.root.add("float[]", "weights");
  turns.samples = {{0, std::vector<float>{1}}, {12, std::vector<float>{2}}};
  const Bytes crate = usdCrate(stage);
  const CrateContent content = readCrate(crate);
  const std::uint64_t rep = content.fields.at("/Model.weights").at("timeSamples");
  EXPECT_EQ(rep >> 48, 46u);
  testing::ByteReader reader(crate, rep & kOffsetMask);
  EXPECT_EQ(reader.number(8), 8u);
  EXPECT_THAT(listAt<double>(crate, reader.number(8)), ElementsAre(0, 12));
  EXPECT_EQ(reader.number(8), 8u);
  ASSERT_EQ(reader.number(8), 2u);
  EXPECT_THAT(listAt<float>(crate, reader.number(8)), ElementsAre(1));
  EXPECT_THAT(listAt<float>(crate, reader.number(8)), ElementsAre(2));
  EXPECT_EQ(content.fields.at("/").count("endTimeCode"), 1u);
}

TEST(UsdCrate, ATargetThatIsNotThereIsAMistakeOfTheCaller) {
  UsdStage stage = emptyStage();
  stage.root.relate("material:binding", {"/Model/none"});
  EXPECT_THROW(usdCrate(stage), std::logic_error);
}

}  // namespace
}  // namespace limber
