#include "limber/document/gltf/json_text.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber {
namespace {

Json parse(std::string_view text) {
  Warnings warnings;
  return parseJson(text, warnings);
}

ErrorCode codeOf(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error for " << text.substr(0, 60);
  return {};
}

TEST(JsonText, RoundTripsKeyOrderAndNumbers) {
  const std::string text =
      R"({"z":1,"a":-9007199254740993,"m":18446744073709551615,"d":0.1,"e":1e-300,"f":3.4028234663852886e+38,)"
      R"("n":[null,true,false,"ä\n\u0001"],"o":{"y":{},"x":[]}})";
  const std::string once = dumpJson(parse(text), -1);
  EXPECT_EQ(dumpJson(parse(once), -1), once);
  EXPECT_EQ(once.substr(0, 30), text.substr(0, 30));
  EXPECT_NE(once.find("18446744073709551615"), std::string::npos);
  EXPECT_NE(once.find("-9007199254740993"), std::string::npos);
  EXPECT_EQ(parse(once)["d"].get<double>(), 0.1);
  EXPECT_EQ(parse(once)["f"].get<float>(), std::numeric_limits<float>::max());
  EXPECT_EQ(parse(text), Json::parse(text));  // the library's own builder as the oracle
}

TEST(JsonText, LastOfEqualKeysCountsAndIsReported) {
  Warnings warnings;
  const Json json = parseJson(R"({"a":1,"b":2,"a":3,"c":{"x":1,"x":2},"a":4})", warnings);
  EXPECT_EQ(dumpJson(json, -1), R"({"b":2,"c":{"x":2},"a":4})");
  ASSERT_EQ(warnings.items().size(), 1u);
  EXPECT_EQ(warnings.items()[0].kind, "duplicate-keys");
  EXPECT_EQ(warnings.items()[0].count, 3u);
}

TEST(JsonText, DepthIsBounded) {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_EQ(dumpJson(parse(nested(200)), -1), nested(200));
  EXPECT_EQ(codeOf(nested(201)), ErrorCode::kLimit);
  EXPECT_EQ(codeOf(std::string(3000000, '[')), ErrorCode::kLimit);
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += R"({"a":)";
  EXPECT_EQ(codeOf(objects), ErrorCode::kLimit);
}

TEST(JsonText, ManyKeysAreBounded) {
  const auto withKeys = [](int count) {
    std::string text = "{";
    for (int i = 0; i < count; ++i) text += (i ? ",\"" : "\"") + std::to_string(i) + "\":0";
    return text + "}";
  };
  EXPECT_EQ(parse(withKeys(65536)).size(), 65536u);
  EXPECT_EQ(codeOf(withKeys(65537)), ErrorCode::kLimit);
}

TEST(JsonText, RefusesWhatIsNotJson) {
  for (const char* text : {"", "{", "{}}", "nul", "[1,]", "{\"a\" 1}", "\"\xff\xfe\"", "\"\xc3\"", "\"\\ud800\"",
                           "[1e400]", "\"\t\"", "'a'", "[NaN]", "\xef\xbb"}) {
    EXPECT_EQ(codeOf(text), ErrorCode::kBadData) << text;
  }
}

TEST(JsonText, SkipsAByteOrderMark) {
  EXPECT_EQ(parse("\xef\xbb\xbf{\"a\":1}")["a"], 1);
}

TEST(JsonText, RefusesToWriteWhatIsNotUtf8) {
  try {
    dumpJson(Json{{"name", "\xff"}}, -1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
  }
}

TEST(JsonText, ReportsHoldNoControlCharacters) {
  const Json json = {{"a\x7f", "\x1b\xc2\x80 \xc2\x9f\xc2\xa0 \xc3\x82\x7f"}};
  const std::string text = dumpReport(json, -1);
  EXPECT_EQ(text, "{\"a\\u007f\":\"\\u001b\\u0080 \\u009f\xc2\xa0 \xc3\x82\\u007f\"}");
  EXPECT_EQ(Json::parse(text), json);
  EXPECT_EQ(dumpReport(Json{{"a", "\xc3\xa4"}}, -1), "{\"a\":\"\xc3\xa4\"}");
}

}  // namespace
}  // namespace limber
