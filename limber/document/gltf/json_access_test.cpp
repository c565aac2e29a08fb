#include "limber/document/gltf/json_access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber {
namespace {

std::string whereOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    return error.where();
  }
  return "no error";
}

TEST(JsonView, ErrorsNameThePathOfTheElement) {
  const Json json = Json::parse(R"({"meshes": [{}, {"primitives": [{"indices": -1}]}]})");
  const JsonView primitive = JsonView(json).array("meshes")[1].array("primitives")[0];
  EXPECT_EQ(whereOf([&] { primitive.index("indices", 10); }), "meshes[1].primitives[0].indices");
  EXPECT_EQ(whereOf([&] { primitive.requireIndex("material", 10); }), "meshes[1].primitives[0].material");
  EXPECT_EQ(whereOf([&] { JsonView(json).array("meshes")[2]; }), "meshes[2]");
}

TEST(JsonView, AbsentIsEmptyOrTheDefault) {
  const Json json = Json::object();
  const JsonView root(json);
  EXPECT_EQ(root.array("nodes").size(), 0u);
  EXPECT_EQ(root.object("extensions").object("any").text("name", "none"), "none");
  EXPECT_EQ(root.number("scale", 2.5), 2.5);
  EXPECT_TRUE(root.flag("on", true));
  EXPECT_FALSE(root.index("mesh", 3).has_value());
}

TEST(JsonView, WrongTypesAreErrors) {
  const Json json = Json::parse(R"({"a": 1, "s": "text", "l": [], "o": {}, "n": null, "b": true})");
  const JsonView root(json);
  for (const char* key : {"s", "l", "o", "n", "b"}) {
    EXPECT_EQ(whereOf([&] { root.number(key, 0); }), key);
    EXPECT_EQ(whereOf([&] { root.index(key, 9); }), key);
  }
  for (const char* key : {"a", "s", "o", "n", "b"}) EXPECT_EQ(whereOf([&] { root.array(key); }), key);
  for (const char* key : {"a", "s", "l", "n", "b"}) EXPECT_EQ(whereOf([&] { root.object(key); }), key);
  for (const char* key : {"a", "l", "o", "n", "b"}) EXPECT_EQ(whereOf([&] { root.text(key); }), key);
  for (const char* key : {"a", "s", "l", "o", "n"}) EXPECT_EQ(whereOf([&] { root.flag(key, false); }), key);
}

TEST(JsonView, CountsAreWholeNumbersThatADoubleHolds) {
  const Json json = Json::parse(
      R"({"whole": 3, "float": 3.0, "half": 0.5, "negative": -1, "huge": 1e300, "long": 18446744073709551615})");
  const JsonView root(json);
  EXPECT_EQ(root.count("whole"), 3u);
  EXPECT_EQ(root.count("float"), 3u);
  for (const char* key : {"half", "negative", "huge", "long"}) EXPECT_EQ(whereOf([&] { root.count(key); }), key);
}

TEST(JsonView, IndicesAreBelowTheirLimit) {
  const Json json = Json::parse(R"({"i": 4, "max": 4294967295})");
  const JsonView root(json);
  EXPECT_EQ(root.index("i", 5), 4u);
  EXPECT_EQ(whereOf([&] { root.index("i", 4); }), "i");
  EXPECT_EQ(whereOf([&] { root.index("max", std::size_t{1} << 40); }), "max");  // kNoIndex is never an index
}

TEST(JsonView, VisitsMembersInOrder) {
  const Json json = Json::parse(R"({"z": 1, "a": 2, "": 3})");
  std::vector<std::pair<std::string, double>> seen;
  JsonView(json).forEachMember(
      [&](std::string_view key, const JsonView& value) { seen.emplace_back(key, value.asNumber()); });
  EXPECT_THAT(seen,
              ::testing::ElementsAre(::testing::Pair("z", 1.0), ::testing::Pair("a", 2.0), ::testing::Pair("", 3.0)));
}

TEST(JsonView, VeryDeepPlacesStayNameable) {
  Json json = 0;
  for (int i = 0; i < 50; ++i) json = Json{{"k", json}};
  JsonView view(json);
  for (int i = 0; i < 50; ++i) view = view.member("k");
  EXPECT_EQ(view.asNumber(), 0);
  EXPECT_EQ(view.path().size(), 10 * 2 - 1u);
}

}  // namespace
}  // namespace limber
