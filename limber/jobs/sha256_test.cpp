#include "limber/jobs/sha256.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

std::string hashOf(std::string_view text) {
  Sha256 hash;
  hash.add(asBytes(text));
  return hash.hex();
}

// FIPS 180-4's examples, and lengths about a block's end, in one piece and byte by byte.
TEST(Sha256, GivesTheStandardsValues) {
  EXPECT_EQ(hashOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hashOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hashOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hashOf(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  for (const std::size_t length : {55, 56, 63, 64, 65, 119, 120, 128}) {
    const std::string text(length, 'q');
    Sha256 piecewise;
    for (const char& c : text) piecewise.add(asBytes({&c, 1}));
    EXPECT_EQ(piecewise.hex(), hashOf(text)) << length;
  }
}

}  // namespace
}  // namespace limber
