#include "limber/core/file/inflate.h"

#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

Bytes fromHex(std::string_view hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

// What Python's zlib makes of text(), with stored blocks, fixed codes and codes of their own.
constexpr std::string_view kStored =
    "7801014101befe626f6e6520736b696e206f6620746865206a6f696e7420736b696e2061206f66206a6f696e742074686520736b696e"
    "20776569676874206f66206120626f6e65207175616472757065640a6120736b696e20746865206f6620626f6e65206a6f696e74206a"
    "6f696e7420736b696e20626f6e6520746865206f662077656967687420736b696e2061207175616472757065640a626f6e6520736b69"
    "6e207175616472757065640a776569676874206f6620776569676874207175616472757065640a7175616472757065640a7468652071"
    "75616472757065640a7175616472757065640a626f6e6520736b696e2074686520626f6e652077656967687420626f6e65206f662061"
    "20736b696e206a6f696e74207175616472757065640a626f6e652061206a6f696e7420776569676874206a6f696e7420736b696e2062"
    "6f6e6520e269746e";
constexpr std::string_view kFixed =
    "78014bcacf4b5528cececc53c84f5328c94855c8cacfcc2b81882482c4207c900c58ac3c35333da3042491a89004d25b589a9852545a"
    "909ac295085101520a94064b42342319091685aa801a05b50a614e12dc49083184b55016420ac102998b4d1c6120480598073505cc06"
    "fb052c0d71289ac644a830540bba6700e269746e";
constexpr std::string_view kDynamic =
    "78da6d4f490e803008bcfb0abe4653b4d5a47569e3f79525628cb7613620d442702cb9401da12582b9e6d29441e6746645b893f2941a"
    "0b0881b35bc7b8f795e280ea60eb2d8ba8e157a5b0e6b02a5be53de139c9395f6bc82547dcfbc77b213b64b216c1f28bc87ae8278846"
    "5be4fbcc05e269746e";

// Sixty words of a language of eight, by a linear congruence: repeats at all distances, letters of all frequencies.
std::string text() {
  const char* words[] = {"joint ", "bone ", "skin ", "weight ", "of ", "the ", "a ", "quadruped\n"};
  std::string result;
  std::uint32_t state = 1;
  for (int i = 0; i < 60; ++i) {
    state = state * 1664525u + 1013904223u;
    result += words[state >> 29];
  }
  return result;
}

std::string unpacked(const Bytes& stream, std::size_t size) {
  Bytes out(size);
  inflateZlib(stream, out);
  return {out.begin(), out.end()};
}

TEST(Inflate, GivesBackWhatZlibDeflated) {
  const std::string wanted = text();
  for (const std::string_view stream : {kStored, kFixed, kDynamic}) {
    EXPECT_EQ(unpacked(fromHex(stream), wanted.size()), wanted);
  }
}

TEST(Inflate, OverlappingMatchesRepeat) {
  // 300 times 'a': a literal and matches at distance 1.
  EXPECT_EQ(unpacked(fromHex("78da4b4c1c05c40200d8a871ad"), 300), std::string(300, 'a'));
}

TEST(Inflate, EveryTruncationAndEveryWrongByteIsAnErrorOrDetectedByTheChecksum) {
  const std::string wanted = text();
  const Bytes stream = fromHex(kDynamic);
  for (std::size_t length = 0; length < stream.size(); ++length) {
    EXPECT_THROW(unpacked(Bytes(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(length)), wanted.size()),
                 Error);
  }
  for (std::size_t i = 2; i < stream.size(); ++i) {
    Bytes wrong = stream;
    wrong[i] ^= 0x55;
    EXPECT_THROW(unpacked(wrong, wanted.size()), Error) << i;
  }
}

TEST(Inflate, AnotherSizeIsRefused) {
  const std::size_t size = text().size();
  EXPECT_THROW(unpacked(fromHex(kDynamic), size - 1), Error);
  EXPECT_THROW(unpacked(fromHex(kDynamic), size + 1), Error);
  EXPECT_THROW(unpacked(fromHex("789c"), 0), Error);
}

TEST(Inflate, APresetDictionaryIsRefused) {
  Bytes stream = fromHex(kDynamic);
  stream[1] = 0x20 | static_cast<std::uint8_t>(31 - (0x7820 % 31));
  EXPECT_THROW(unpacked(stream, text().size()), Error);
}

}  // namespace
}  // namespace limber
