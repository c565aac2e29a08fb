#include "limber/document/live/osc_packet.h"

#include <bit>
#include <string>

#include <gmock/gmock.h>

#include "limber/document/testing/osc_bytes.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using testing::oscBundle;
using testing::oscMessage;

struct Read {
  bool whole = false;
  std::vector<std::string> addresses;
  std::vector<std::vector<OscValue>> values;
};

Read readPacket(const Bytes& packet) {
  Read read;
  read.whole = readOscPacket(packet, [&](const OscMessage& message) {
    read.addresses.emplace_back(message.address);
    read.values.push_back(message.values);
  });
  return read;
}

// The example of the specification, byte by byte: /foo 1000 -1 "hello" 1.234 5.678.
TEST(OscPacket, ReadsTheSpecificationsExample) {
  const Bytes packet = {0x2f, 0x66, 0x6f, 0x6f, 0,    0,    0,    0,    0x2c, 0x69, 0x69, 0x73, 0x66, 0x66,
                        0,    0,    0,    0,    3,    0xe8, 0xff, 0xff, 0xff, 0xff, 0x68, 0x65, 0x6c, 0x6c,
                        0x6f, 0,    0,    0,    0x3f, 0x9d, 0xf3, 0xb6, 0x40, 0xb5, 0xb2, 0x2d};
  const Read found = readPacket(packet);
  ASSERT_TRUE(found.whole);
  EXPECT_THAT(found.addresses, ElementsAre("/foo"));
  EXPECT_THAT(found.values[0], ElementsAre(OscValue(1000), OscValue(-1), OscValue(std::string_view("hello")),
                                           OscValue(1.234f), OscValue(5.678f)));
}

TEST(OscPacket, TakesBundlesInBundles) {
  const Bytes one = oscMessage("/a", {1.0f}), two = oscMessage("/b", {std::string("text")}),
              three = oscMessage("/c", {});
  EXPECT_THAT(readPacket(oscBundle({one, oscBundle({two, three})})).addresses, ElementsAre("/a", "/b", "/c"));
  EXPECT_TRUE(readPacket(oscBundle({})).whole);
  Bytes deep = one;
  for (int i = 0; i < 8; ++i) deep = oscBundle({deep});
  EXPECT_TRUE(readPacket(deep).whole);
  EXPECT_FALSE(readPacket(oscBundle({deep})).whole);
}

TEST(OscPacket, RefusesWhatIsNone) {
  EXPECT_FALSE(readPacket({}).whole);
  EXPECT_FALSE(readPacket(oscMessage("no slash", {})).whole);
  EXPECT_FALSE(readPacket(oscMessage("/many", std::vector<testing::OscArgument>(33, 1.0f))).whole);
  Bytes other = oscMessage("/a", {1.0f});
  other[5] = 'b';  // a blob
  EXPECT_FALSE(readPacket(other).whole);
}

TEST(OscPacket, IsRefusedAtEveryLength) {
  const Bytes packet = oscBundle({oscMessage("/a", {std::string("name"), 1.0f, 2.0f})});
  ASSERT_TRUE(readPacket(packet).whole);
  for (std::size_t size = 0; size < packet.size(); ++size) {
    if (size == 16) continue;  // an empty bundle
    EXPECT_FALSE(readPacket(Bytes(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size))).whole) << size;
  }
}

TEST(OscPacket, DoesNotTrustAByte) {
  const Bytes packet = oscBundle({oscMessage("/a", {std::string("name"), 1.0f}), oscMessage("/b", {2.0f})});
  std::size_t refused = 0;
  for (std::size_t at = 0; at < packet.size(); ++at) {
    for (const int flip : {1, 0x80, 0xff}) {
      Bytes patched = packet;
      patched[at] = static_cast<std::uint8_t>(patched[at] ^ flip);
      const Read found = readPacket(patched);
      EXPECT_LE(found.addresses.size(), 2u);
      refused += found.whole ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 50u);
}

}  // namespace
}  // namespace limber
