#include "limber/asset/ply_check.h"

#include <gmock/gmock.h>

#include <string_view>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

PlyCounts check(std::string_view text) {
  return checkPly({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string refusal(std::string_view text) {
  try {
    check(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PlyCheck, TellsWhatAWholeFileAnnounces) {
  EXPECT_EQ(check(kTriangle).vertices, 3u);
  EXPECT_EQ(check(kTriangle).faces, 1u);
}

TEST(PlyCheck, AHeaderWithoutEndIsRefused) {
  for (const std::size_t length : {5u, 19u, 40u, 120u}) {
    EXPECT_EQ(refusal(kTriangle.substr(0, length)), "cannot be read as PLY: its header has no end");
  }
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n0 0 0\n"),
              HasSubstr("more elements than it can hold"));
}

TEST(PlyCheck, ACutFileIsRefused) {
  EXPECT_THAT(refusal(kTriangle.substr(0, kTriangle.find("0 1 0\n"))), HasSubstr("it is cut off"));
  EXPECT_THAT(refusal(kTriangle.substr(0, kTriangle.find("3 0 1 2"))), HasSubstr("it is cut off"));
  std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nend_header\n";
  binary += std::string(8, '\0');
  EXPECT_EQ(refusal(binary), "");
  EXPECT_THAT(refusal(std::string_view(binary).substr(0, binary.size() - 2)), HasSubstr("it is cut off"));
}

}  // namespace
}  // namespace limber
