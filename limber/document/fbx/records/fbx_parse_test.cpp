#include "limber/document/fbx/records/fbx_parse.h"

#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/document/fbx/records/fbx_values.h"

namespace limber {
namespace {

template <typename T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// Binary records by hand, as Blender's notes on the format lay them out.
struct BinaryWriter {
  std::uint32_t version;

  bool isLong() const { return version >= 7500; }
  std::string offset(std::size_t value) const {
    return isLong() ? raw(static_cast<std::uint64_t>(value)) : raw(static_cast<std::uint32_t>(value));
  }
  std::string end() const { return std::string(isLong() ? 25 : 13, '\0'); }
  std::string header() const { return std::string("Kaydara FBX Binary  \0\x1a\0", 23) + raw(version); }
  // A record that begins at `at`; `children` is called with the offset where they begin.
  template <typename Children>
  std::string node(std::size_t at, const std::string& name, const std::vector<std::string>& values,
                   const Children& children) const {
    std::string joined;
    for (const std::string& value : values) joined += value;
    const std::size_t head = (isLong() ? 25 : 13) + name.size();
    const std::string below = children(at + head + joined.size());
    return offset(at + head + joined.size() + below.size()) + offset(values.size()) + offset(joined.size()) +
           static_cast<char>(name.size()) + name + joined + below;
  }
  std::string leaf(std::size_t at, const std::string& name, const std::vector<std::string>& values) const {
    return node(at, name, values, [](std::size_t) { return std::string(); });
  }
};

std::string valueText(const std::string& text) {
  return "S" + raw(static_cast<std::uint32_t>(text.size())) + text;
}

template <typename T>
std::string plainArray(char type, const std::vector<T>& values) {
  std::string bytes;
  for (const T& value : values) bytes += raw(value);
  return type + raw(static_cast<std::uint32_t>(values.size())) + raw(std::uint32_t{0}) +
         raw(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

// 0, 1, 2, ... 9 as int32, deflated by Python's zlib.
std::string deflatedCount() {
  const unsigned char stream[] = {0x78, 0xda, 0x0d, 0xc3, 0x89, 0x0d, 0x00, 0x20, 0x0c, 0x04, 0xa0,
                                  0xd3, 0xfa, 0x75, 0xff, 0x85, 0x85, 0x84, 0x24, 0x19, 0x4e, 0xcb,
                                  0xe5, 0xf6, 0x78, 0x7d, 0xb6, 0x1f, 0x02, 0xbc, 0x00, 0x2e};
  return "i" + raw(std::uint32_t{10}) + raw(std::uint32_t{1}) + raw(static_cast<std::uint32_t>(sizeof stream)) +
         std::string(reinterpret_cast<const char*>(stream), sizeof stream);
}

std::string sample(std::uint32_t version) {
  const BinaryWriter write{version};
  std::string file = write.header();
  file += write.node(file.size(), "Objects", {}, [&](std::size_t at) {
    std::string below = write.leaf(at, "Scalars",
                                   {"C\1", "Y" + raw(std::int16_t{-2}), "I" + raw(std::int32_t{70000}),
                                    "L" + raw(std::int64_t{1} << 40), "F" + raw(0.5f), "D" + raw(0.25),
                                    valueText(std::string("Body\0\1Model", 11)), "R" + raw(std::uint32_t{2}) + "\1\2"});
    below += write.leaf(at + below.size(), "Arrays", {plainArray<double>('d', {1.5, -2}), deflatedCount()});
    return below + write.end();
  });
  file += write.leaf(file.size(), "After", {});
  return file + write.end() + "a footer that nobody reads";
}

FbxFile parse(std::string_view text) {
  return parseFbx(asBytes(text));
}

ErrorCode codeOf(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "was read";
  return ErrorCode::kCancelled;
}

TEST(FbxParse, BinaryRecordsOfBothWidths) {
  for (const std::uint32_t version : {7100u, 7400u, 7500u, 7700u}) {
    const std::string bytes = sample(version);
    EXPECT_TRUE(looksLikeFbx(asBytes(bytes)));
    const FbxFile file = parse(bytes);
    EXPECT_EQ(file.version, version);
    ASSERT_EQ(file.root.children.size(), 2u);
    EXPECT_EQ(file.root.children[1].name, "After");
    const FbxNode& scalars = *file.root.find("Objects")->find("Scalars");
    EXPECT_EQ(std::get<bool>(scalars.values[0]), true);
    EXPECT_EQ(fbxInteger(scalars, 1), -2);
    EXPECT_EQ(fbxInteger(scalars, 2), 70000);
    EXPECT_EQ(fbxInteger(scalars, 3), std::int64_t{1} << 40);
    EXPECT_EQ(fbxNumber(scalars, 4), 0.5);
    EXPECT_EQ(fbxNumber(scalars, 5), 0.25);
    EXPECT_EQ(fbxText(scalars, 6)->substr(0, 4), "Body");
    EXPECT_EQ(std::get<Bytes>(scalars.values[7]), (Bytes{1, 2}));
    EXPECT_FALSE(fbxNumber(scalars, 6));
    EXPECT_FALSE(fbxNumber(scalars, 8));
    const FbxNode& arrays = *file.root.find("Objects")->find("Arrays");
    EXPECT_EQ(std::get<std::vector<double>>(arrays.values[0]), (std::vector<double>{1.5, -2}));
    EXPECT_EQ(std::get<std::vector<std::int32_t>>(arrays.values[1]),
              (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  }
}

// "Type: C" of a curve: one byte, as truths are.
TEST(FbxParse, ALetterInABinaryFileIsItsNumber) {
  const BinaryWriter writer{7400};
  const std::string letters = writer.leaf(27, "Type", {"CR", std::string("C\0", 2), "C\1"});
  const FbxFile file = parse(writer.header() + letters + writer.end());
  const FbxNode& type = *file.root.find("Type");
  EXPECT_EQ(fbxInteger(type, 0), 'R');
  EXPECT_EQ(std::get<bool>(type.values[1]), false);
  EXPECT_EQ(std::get<bool>(type.values[2]), true);
}

TEST(FbxParse, TextRecords) {
  const FbxFile file = parse(
      "; FBX 7.4.0 project file\n\nFBXHeaderExtension:  {\n\tFBXVersion: 7400 ; a comment\n}\n"
      "Objects:  {\n\tModel: 140, \"Model::A &quot;b&quot;\", \"Mesh\" {\n\t\tShading: T\n\t\tPath: \"C:\\x.png\"\n"
      "\t\tContent: ,\n\t\t\"QUJD\"\n\t\tKeyTime: *3 {\n\t\t\ta: 9223372036854775807,-2,\n3\n\t\t}\n"
      "\t\tVertices: *2 {\n\t\t\ta: 1,-2.5e-1\n\t\t}\n\t\tEmpty: *0 {\n\t\t}\n\t}\n}\n"
      "Connections:  {\n\tC: \"OO\",140,0\n}\n");
  EXPECT_EQ(file.version, 7400u);
  const FbxNode& model = file.root.find("Objects")->children.at(0);
  EXPECT_EQ(fbxInteger(model, 0), 140);
  EXPECT_EQ(fbxText(model, 1), "Model::A \"b\"");
  EXPECT_EQ(fbxChildText(model, "Shading"), "T");
  EXPECT_EQ(fbxChildText(model, "Path"), "C:\\x.png");
  EXPECT_EQ(fbxChildText(model, "Content"), "QUJD");
  EXPECT_EQ(fbxIntegers(model, "KeyTime"), (std::vector<std::int64_t>{9223372036854775807, -2, 3}));
  EXPECT_EQ(fbxNumbers(model, "Vertices"), (std::vector<double>{1, -0.25}));
  EXPECT_TRUE(fbxNumbers(model, "Empty").empty());
  const FbxNode& link = file.root.find("Connections")->children.at(0);
  EXPECT_EQ(link.values.size(), 3u);
}

TEST(FbxParse, WhatIsNoNumberInAnArrayIsNan) {
  const FbxFile file =
      parse("; FBX\nFBXHeaderExtension:  {\nFBXVersion: 7400\n}\nA: *4 {\na: 1,nan,-1.#IND,-nan(ind)\n}\n");
  const auto& numbers = std::get<std::vector<double>>(file.root.find("A")->values.at(0));
  ASSERT_EQ(numbers.size(), 4u);
  EXPECT_EQ(numbers[0], 1);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_TRUE(std::isnan(numbers[i])) << i;
}

TEST(FbxParse, OldVersionsAreRefusedWithARemedy) {
  EXPECT_EQ(codeOf(BinaryWriter{6100}.header() + std::string(13, '\0')), ErrorCode::kUnsupported);
  EXPECT_EQ(codeOf("; FBX 6.1.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\n"),
            ErrorCode::kUnsupported);
  // They are written otherwise: a list goes on in the next line by its comma.
  EXPECT_EQ(codeOf("; FBX 5.8.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 5800\n}\n"
                   "Geometry: \"x\" {\n\tVertices: 0,0,0\n\t,0,1,0\n}\n"),
            ErrorCode::kUnsupported);
  EXPECT_EQ(codeOf("; FBX project file\nObjects:  {\n}\n"), ErrorCode::kBadData);
}

TEST(FbxParse, EveryTruncationIsAnErrorOrTheRecordsBeforeIt) {
  const std::string whole = sample(7400);
  const std::size_t end = whole.find("After") + 5;
  for (std::size_t length = 27; length < end; ++length) {
    const std::string_view cut = std::string_view(whole).substr(0, length);
    try {
      EXPECT_LE(parse(cut).root.children.size(), 1u) << length;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadData) << length;
    }
  }
}

TEST(FbxParse, WrongBytesAreReadOrRefused) {
  for (const std::uint32_t version : {7400u, 7500u}) {
    const std::string whole = sample(version);
    for (std::size_t i = 23; i < whole.size(); ++i) {
      for (const char wrong : {'\0', '\1', '\x7f', '\xff'}) {
        std::string patched = whole;
        patched[i] = wrong;
        try {
          parse(patched);
        } catch (const Error&) {
        }
      }
    }
  }
}

TEST(FbxParse, DepthAndSizesAreBounded) {
  std::string deep = "FBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\n";
  for (int i = 0; i < 100000; ++i) deep += "a: {\n";
  EXPECT_EQ(codeOf(deep), ErrorCode::kBadData);
  // An array that says to be of four billion numbers, in ten bytes.
  const BinaryWriter write{7400};
  const std::string bomb =
      "d" + raw(std::uint32_t{0xffffffff}) + raw(std::uint32_t{1}) + raw(std::uint32_t{10}) + std::string(10, 'x');
  EXPECT_EQ(codeOf(write.header() + write.leaf(27, "Bomb", {bomb}) + write.end()), ErrorCode::kBadData);
  // One of 20 MB in 20 kB, which deflate allows: it is not even tried.
  const std::string dense =
      "d" + raw(std::uint32_t{2500000}) + raw(std::uint32_t{1}) + raw(std::uint32_t{20000}) + std::string(20000, 'x');
  EXPECT_EQ(codeOf(write.header() + write.leaf(27, "Bomb", {dense}) + write.end()), ErrorCode::kLimit);
}

}  // namespace
}  // namespace limber
