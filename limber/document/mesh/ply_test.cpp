#include "limber/document/mesh/ply.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/core/file/bits.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/testing/attribute_values.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using testing::warningKinds;

constexpr std::string_view kPlyTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

Asset read(std::string_view text, const Resolver& resolver = {}) {
  return readAsset(asBytes(text), "t.ply", resolver);
}

std::string refusal(std::string_view text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// A header for vertices of x, y, z and one kind of face.
std::string header(const char* format, int vertices, const char* scalar, int faces, const char* lineEnd = "\n") {
  std::string text;
  const auto line = [&](const std::string& words) { text += words + lineEnd; };
  line("ply");
  line(std::string("format ") + format + " 1.0");
  line("element vertex " + std::to_string(vertices));
  for (const char* axis : {"x", "y", "z"}) line(std::string("property ") + scalar + ' ' + axis);
  line("element face " + std::to_string(faces));
  line("property list uchar ushort vertex_index");
  line("end_header");
  return text;
}

template <class Number>
void append(std::string& text, Number number, bool bigEndian) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  if (bigEndian) bytes.assign(bytes.rbegin(), bytes.rend());
  text += bytes;
}

template <class Number>
std::string binaryTriangle(bool bigEndian, Number firstX, const char* lineEnd = "\n") {
  std::string text = header(bigEndian ? "binary_big_endian" : "binary_little_endian", 3,
                            sizeof(Number) == 8 ? "double" : "float", 1, lineEnd);
  for (const Number x :
       {firstX, Number{0}, Number{0}, Number{1}, Number{0}, Number{0}, Number{0}, Number{1}, Number{0}}) {
    append(text, x, bigEndian);
  }
  append(text, std::uint8_t{3}, bigEndian);
  for (const std::uint16_t v : {0, 1, 2}) append(text, v, bigEndian);
  return text;
}

TEST(Ply, TextAndBothOrdersOfBytesAreTheSame) {
  const std::vector<float> wanted = attributeOf(read(kPlyTriangle), "POSITION");
  EXPECT_THAT(wanted, ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  for (const bool bigEndian : {false, true}) {
    for (const char* lineEnd : {"\n", "\r\n", "\r"}) {
      EXPECT_EQ(attributeOf(read(binaryTriangle(bigEndian, 0.f, lineEnd)), "POSITION"), wanted);
      EXPECT_EQ(attributeOf(read(binaryTriangle(bigEndian, 0.0, lineEnd)), "POSITION"), wanted);
    }
  }
  EXPECT_EQ(collectGeometry(read(kPlyTriangle)).triangles.size(), 1u);
}

// A number's first byte may be one that ends lines or separates words in text.
TEST(Ply, NumbersMayBeginWithTheByteOfASpace) {
  for (const unsigned first : {0x0au, 0x0du, 0x20u, 0x09u}) {
    const float x = bitCast<float>(0x3e000000u + first);
    EXPECT_EQ(attributeOf(read(binaryTriangle(false, x)), "POSITION")[0], x) << first;
    EXPECT_EQ(attributeOf(read(binaryTriangle(false, x, "\r\n")), "POSITION")[0], x) << first;
  }
}

// As three.js and Blender take them.
TEST(Ply, ColorsAreSrgbInTheFileAndLinearInTheDocument) {
  const auto colorOf = [](const char* type, const char* row) {
    std::string text = std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n") +
                       "property float z\n";
    for (const char* name : {"red", "green", "blue", "alpha"}) {
      text += std::string("property ") + type + ' ' + name + '\n';
    }
    return attributeOf(read(text + "end_header\n0 0 0 " + row + "\n"), "COLOR_0");
  };
  EXPECT_THAT(colorOf("uchar", "51 255 0 51"), ElementsAre(FloatEq(0.033104766f), 1, 0, FloatEq(0.2f)));
  EXPECT_THAT(colorOf("float", "0.2 1 0 0.2"), ElementsAre(FloatEq(0.033104766f), 1, 0, FloatEq(0.2f)));
}

TEST(Ply, ColorsOfFacesAreReportedAsLost) {
  const Asset asset = read(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 1u);
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"face-colors"});
}

TEST(Ply, PolygonsAreCutIntoTriangles) {
  const std::string square = header("ascii", 4, "float", 1) + "0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n";
  EXPECT_EQ(collectGeometry(read(square)).triangles.size(), 2u);
}

TEST(Ply, StripsTurnEveryOtherTriangleRound) {
  const Asset asset = read(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n5 5 5\n9 0 1 2 3 -1 4 0 1 -1\n");
  const Geometry geometry = collectGeometry(asset);
  ASSERT_EQ(geometry.triangles.size(), 3u);
  for (int t = 0; t < 2; ++t) {
    const Triangle& corners = geometry.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int k) { return geometry.positions[corners[static_cast<std::size_t>(k)]].cast<double>(); };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0) << t;
  }
}

TEST(Ply, CornersMayHaveTextureCoordinatesOfTheirOwn) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment TextureFile my skin.png\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0 1 1 0 1\n";
  std::string asked;
  const Asset asset = read(text, [&](std::string_view path) -> std::optional<Bytes> {
    asked = path;
    return std::nullopt;
  });
  EXPECT_EQ(asked, "my skin.png");
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("missing-images"));
  EXPECT_EQ(attributeOf(asset, "POSITION").size(), 15u);  // the first vertex twice, the third once
  EXPECT_THAT(attributeOf(asset, "TEXCOORD_0"), ElementsAre(0, 1, 1, 1, 1, 0, 0.5f, 1, 0, 0));
}

TEST(Ply, WhatElseItHoldsIsPassedOver) {
  const Asset asset = read(
      "ply\nformat ascii 1.0\nobj_info made\nelement camera 2\nproperty float f\nproperty list uchar int k\n"
      "element vertex 3\nproperty list uchar float extra\nproperty float x\nproperty float quality\nproperty float y\n"
      "property float z\nelement face 1\nproperty uchar flags\nproperty list uchar int vertex_indices\nend_header\n"
      "1 2 7 7\n1 0\n1 9 0 5 0 0\n0 1 5 0 0\n0 0 5 1 0\n1 3 0 1 2\n");
  EXPECT_THAT(attributeOf(asset, "POSITION"), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0));
  EXPECT_THAT(warningKinds(asset.warnings), ElementsAre("other-elements"));
}

TEST(Ply, AHeaderWithoutEndIsRefused) {
  for (const std::size_t length : {5u, 19u, 40u, 120u}) {
    EXPECT_EQ(refusal(kPlyTriangle.substr(0, length)), "t.ply: cannot be read as PLY: its header has no end");
  }
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n0 0 0\n"),
              HasSubstr("more elements than it can hold"));
}

TEST(Ply, ACutFileIsRefused) {
  EXPECT_THAT(refusal(kPlyTriangle.substr(0, kPlyTriangle.find("0 1 0\n"))), HasSubstr("it is cut off"));
  EXPECT_THAT(refusal(kPlyTriangle.substr(0, kPlyTriangle.find("3 0 1 2"))), HasSubstr("it is cut off"));
  const std::string binary = binaryTriangle(false, 0.f);
  for (std::size_t length = binary.find("end_header") + 11; length < binary.size(); ++length) {
    EXPECT_THAT(refusal(std::string_view(binary).substr(0, length)), HasSubstr("it is cut off"));
  }
}

TEST(Ply, WhatMakesNoSenseIsRefusedByName) {
  const auto triangle = [](const char* what, const char* instead) {
    std::string text(kPlyTriangle);
    return text.replace(text.find(what), std::strlen(what), instead);
  };
  EXPECT_THAT(refusal(triangle("ascii", "binary_mixed_endian")), HasSubstr("none of PLY's three"));
  EXPECT_THAT(refusal(triangle("float x", "quarter x")), HasSubstr("a type \"quarter\""));
  EXPECT_THAT(refusal(triangle("float z", "float depth")), HasSubstr("its vertices have no z"));
  EXPECT_THAT(refusal(triangle("\n1 0 0", "\n1 zero 0")), HasSubstr("\"zero\" where a number"));
  EXPECT_THAT(refusal(triangle("\n1 0 0", "\n1 nan 0")), HasSubstr("vertex 1 has a position that is not a finite"));
  EXPECT_THAT(refusal(triangle("3 0 1 2", "3 0 1 3")), HasSubstr("face 0 names vertex 3 of 3"));
  EXPECT_THAT(refusal(triangle("3 0 1 2", "3 0 1 -1")), HasSubstr("face 0 names vertex -1 of 3"));
  EXPECT_THAT(refusal(triangle("3 0 1 2", "-3 0 1 2")), HasSubstr("negative length"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0 0 0\n"), HasSubstr("without properties"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nend_header\n0\n"), HasSubstr("no vertices"));
  for (const char* encoding : {"ascii", "binary_little_endian"}) {
    const std::string header = fmt::format(
        "ply\nformat {} 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 0\nproperty list uchar int vertex_indices\nend_header\n",
        encoding);
    EXPECT_EQ(refusal(header), "t.ply: cannot be read as PLY: it has no vertices");
  }
}

}  // namespace
}  // namespace limber
