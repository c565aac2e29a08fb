#include "limber/document/uri.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

Bytes bytesIn(std::string_view text) {
  return Bytes(text.begin(), text.end());
}

// The test vectors of RFC 4648.
TEST(Uri, Base64KnownValues) {
  const std::pair<const char*, const char*> kVectors[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : kVectors) {
    EXPECT_EQ(encodeBase64(bytesIn(plain)), encoded);
    const DataUri data = decodeDataUri(std::string("data:application/gltf-buffer;base64,") + encoded);
    EXPECT_EQ(data.bytes, bytesIn(plain));
    EXPECT_EQ(data.header, "data:application/gltf-buffer;base64,");
  }
  EXPECT_EQ(decodeDataUri("data:;base64,Zm8").bytes, bytesIn("fo"));  // padding left out
}

TEST(Uri, Base64RoundTripsAllBytes) {
  Bytes all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<std::uint8_t>(i));
  EXPECT_EQ(decodeDataUri("data:;base64," + encodeBase64(all)).bytes, all);
}

TEST(Uri, BrokenDataUrisAreErrors) {
  for (const char* uri : {"data:", "data:;base64", "data:,plain", "data:text/plain,x", "data:;base64,A",
                          "data:;base64,Zg==Zg==", "data:;base64,Z g", "data:;base64,Zm9v\xc3\xa4"}) {
    EXPECT_THROW(decodeDataUri(uri), Error) << uri;
  }
}

TEST(Uri, LocalPathsAreDecoded) {
  EXPECT_EQ(localPath("model.bin"), "model.bin");
  EXPECT_EQ(localPath("a%20b/c%C3%A4.png"), "a b/c\xc3\xa4.png");
  EXPECT_EQ(localPath("100%.png"), "100%.png");
  EXPECT_EQ(localPath("./..hidden/x..bin"), "./..hidden/x..bin");
}

TEST(Uri, PathsOutOfTheFolderAreErrors) {
  for (const char* uri :
       {"", "/etc/passwd", "../x.bin", "a/../../x", "a/..", "..", "%2e%2e/x", "..%2fx", "%2Fetc/passwd", "\\\\host\\x",
        "a\\..\\..\\x", "C:/x", "c%3A/x", "file:///x", "http://host/x.bin", "//host/x", "a%00b", "a\nb"}) {
    EXPECT_THROW(localPath(uri), Error) << uri;
  }
}

TEST(Uri, PercentEncodingComesBack) {
  for (const char* path : {"plain.bin", "with space.bin", "100%25.bin", "\xc3\xa4/\xe2\x82\xac.png", "a#b?c.bin"}) {
    const std::string uri = percentEncode(path);
    EXPECT_EQ(uri.find_first_of(" #?"), std::string::npos);
    EXPECT_EQ(localPath(uri), path);
  }
}

TEST(Uri, TellsDataUris) {
  EXPECT_TRUE(isDataUri("data:;base64,"));
  EXPECT_TRUE(isDataUri("DATA:;base64,"));
  EXPECT_FALSE(isDataUri("data.bin"));
  EXPECT_FALSE(isDataUri(""));
}

}  // namespace
}  // namespace limber
