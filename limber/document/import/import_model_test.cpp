#include "limber/document/import/import_model.h"

#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/file/read_bounds.h"
#include "limber/core/sanitizers.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/images.h"
#include "limber/document/import/import_dae.h"
#include "limber/document/import/import_obj.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/attribute_values.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/write.h"
#include "temporary_folder.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::warningKinds;

// A folder in memory.
Resolver folder(std::map<std::string, std::string> files) {
  return [files = std::move(files)](std::string_view uri) -> std::optional<Bytes> {
    const auto found = files.find(std::string(uri));
    if (found == files.end()) return std::nullopt;
    return Bytes(found->second.begin(), found->second.end());
  };
}

Asset import(std::string_view text, std::string_view name, const Resolver& resolver = {}) {
  return readAsset(asBytes(text), name, resolver);
}

Error errorOf(std::string_view text, std::string_view name) {
  try {
    import(text, name);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << name << " was read";
  return Error(ErrorCode::kCancelled, "");
}

const gltf::Primitive& primitiveOf(const Asset& asset) {
  return asset.document.meshes.at(0).primitives.at(0);
}

double areaOf(const Geometry& geometry) {
  double area = 0;
  for (const Triangle& t : geometry.triangles) {
    const Vec3 a = geometry.positions[t[0]].cast<double>(), b = geometry.positions[t[1]].cast<double>(),
               c = geometry.positions[t[2]].cast<double>();
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

Vec3 sizeOf(const Geometry& geometry) {
  Box box;
  for (const Vec3f& p : geometry.positions) box.add(p.cast<double>());
  return box.size();
}

constexpr const char* kSquareObj =
    "# a square with texture coordinates\n"
    "mtllib looks.mtl\n"
    "o square\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "vn 0 0 1\n"
    "usemtl red\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

// --- OBJ ---

TEST(ImportObj, AQuadIsTwoTrianglesOverFourVertices) {
  const Asset asset = import(kSquareObj, "square.obj");
  EXPECT_EQ(asset.format, "obj");
  EXPECT_EQ(asset.document.nodes.at(0).name, "square");
  const Geometry geometry = collectGeometry(asset);
  EXPECT_EQ(geometry.positions.size(), 4u);
  EXPECT_EQ(geometry.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(areaOf(geometry), 1);
  const std::vector<float> normals = attributeOf(asset, "NORMAL");
  EXPECT_EQ(std::vector<float>(normals.begin(), normals.begin() + 3), (std::vector<float>{0, 0, 1}));
  // v counts downwards in glTF: the corner at the origin is at the bottom of the picture.
  const std::vector<float> uvs = attributeOf(asset, "TEXCOORD_0");
  for (Index v = 0; v < 4; ++v) {
    EXPECT_EQ(uvs[2 * v], geometry.positions[v].x());
    EXPECT_EQ(uvs[2 * v + 1], 1 - geometry.positions[v].y());
  }
}

TEST(ImportObj, AConcavePolygonKeepsItsArea) {
  const Geometry geometry =
      collectGeometry(import("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n", "arrow.obj"));
  EXPECT_EQ(geometry.triangles.size(), 3u);
  EXPECT_NEAR(areaOf(geometry), 4 - 1.5, 1e-6);
}

TEST(ImportObj, IndicesMayCountBackwards) {
  const Geometry geometry = collectGeometry(import("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n", "t.obj"));
  EXPECT_TRUE(geometry.positions[geometry.triangles[0][1]].isApprox(Vec3f(1, 0, 0)));
}

TEST(ImportObj, NamesMayBeInLatin1) {
  const auto nameOf = [](const char* name) {
    return import(std::string("o ").append(name).append("\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "t.obj")
        .document.nodes.at(0)
        .name;
  };
  EXPECT_EQ(nameOf("M\xfcller"), "M\xc3\xbcller");
  EXPECT_EQ(nameOf("M\xc3\xbcller"), "M\xc3\xbcller");
}

TEST(ImportObj, CornersWithOtherAttributesStayApart) {
  // Two triangles that share an edge, with a normal of their own each.
  const Asset asset = import(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nvn 0 1 0\n"
      "f 1//1 2//1 3//1\nf 2//2 1//2 4//2\n",
      "fold.obj");
  EXPECT_EQ(collectGeometry(asset).positions.size(), 6u);
}

TEST(ImportObj, MaterialsAndTexturesComeThroughTheResolver) {
  const std::string png = std::string("\x89PNG\r\n\x1a\n", 8) + "not a real picture";
  const Asset asset = import(kSquareObj, "square.obj",
                             folder({{"looks.mtl", "newmtl red\nKd 1 0.5 0.25\nd 0.5\nmap_Kd textures\\skin.png\n"},
                                     {"textures/skin.png", png}}));
  const gltf::Document& document = asset.document;
  const gltf::Material& material = document.materials.at(primitiveOf(asset).material.value());
  EXPECT_EQ(material.name, "red");
  EXPECT_EQ(material.pbrMetallicRoughness.value().baseColorFactor, Vec4(1, 0.5, 0.25, 0.5));
  EXPECT_EQ(material.alphaMode, "BLEND");
  EXPECT_EQ(material.pbrMetallicRoughness.value().baseColorTexture.value().index, 0u);
  const gltf::BufferView& view = document.bufferViews.at(document.images.at(0).bufferView.value());
  const auto start = asset.buffers[0].bytes.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  EXPECT_EQ(std::string(start, start + static_cast<std::ptrdiff_t>(view.byteLength)), png);
  EXPECT_TRUE(asset.warnings.empty());
}

TEST(ImportObj, AMissingTextureIsTold) {
  const Asset asset =
      import(kSquareObj, "square.obj", folder({{"looks.mtl", "newmtl red\nKd 1 1 1\nmap_Kd C:/gone/skin.png\n"}}));
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"missing-images"});
  EXPECT_TRUE(asset.document.textures.empty());
}

TEST(ImportModel, ObjTakesNothingFromOutsideItsFolder) {
  const testing::TemporaryFolder disk;
  const auto put = [&](const char* name, std::string_view text) { writeFile(disk.path() / name, asBytes(text)); };
  std::filesystem::create_directory(disk.path() / "model");
  put("secret.png", "\x89PNG\r\n\x1a\nSECRET");
  put("secret.mtl", "newmtl x\nmap_Kd own.png\n");
  put("model/own.png", "\x89PNG\r\n\x1a\nown");
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  put("model/a.obj", "mtllib a.mtl\nusemtl x\n" + triangle);
  put("model/a.mtl", "newmtl x\nmap_Kd ../secret.png\n");
  put("model/b.obj", "mtllib ../secret.mtl\nusemtl x\n" + triangle);
  const auto images = [&](const char* name) { return readAsset(disk.path() / name).document.images.size(); };
  EXPECT_EQ(images("model/a.obj"), 0u);
  EXPECT_EQ(images("model/b.obj"), 0u);
  put("model/a.mtl", "newmtl x\nmap_Kd own.png\n");
  EXPECT_EQ(images("model/a.obj"), 1u);
}

TEST(ImportObj, NothingOutsideTheFolderIsOpened) {
  std::vector<std::string> asked;
  // The importer runs in a process of its own: what it asks for shows in what it gets.
  const Resolver resolver = [](std::string_view uri) -> std::optional<Bytes> {
    if (uri.find("..") != std::string_view::npos || uri.rfind('/', 0) == 0) {
      throw Error(ErrorCode::kBadData, "leaves the folder");
    }
    return std::nullopt;
  };
  const Asset asset = import("mtllib ../../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj", resolver);
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 1u);
}

TEST(ImportObj, APositionThatIsNoNumberIsRefused) {
  for (const char* bad : {"nan", "inf", "-inf"}) {
    const std::string text = std::string("v 0 0 0\nv 1 0 ").append(bad).append("\nv 0 1 0\nf 1 2 3\n");
    const Error error = errorOf(text, "bad.obj");
    EXPECT_EQ(error.code(), ErrorCode::kBadData);
    EXPECT_THAT(error.what(), HasSubstr("bad.obj: cannot be read as OBJ: a vertex has a position that is not"));
  }
}

TEST(ImportObj, AnIndexOutOfRangeIsRefused) {
  EXPECT_THAT(errorOf("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "bad.obj").what(), HasSubstr("cannot be read as OBJ"));
}

TEST(ImportObj, FacesThatNameWhatIsNotThereAreLeftOut) {
  for (const char* face :
       {"f 1 2 9", "f 1 2 -9", "f 1 2 0", "f 1//1 2//1 3//7", "f 1 2 99999999999999999999", "f 1 x 2"}) {
    const std::string text = std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n").append(face);
    const Asset asset = import(text, "t.obj");
    EXPECT_EQ(collectGeometry(asset).triangles.size(), 1u) << face;
    EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"invalid-faces"}) << face;
  }
}

TEST(ImportObj, LinesThatABackslashContinuesAreOne) {
  const Asset asset =
      import("v 0 0 0\nv 1 \\\r\n 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 \\\n 4 \\\n 3\n# C:\\\nf 1 2 3\n", "t.obj");
  EXPECT_TRUE(asset.warnings.empty());
  EXPECT_EQ(collectGeometry(asset).positions.size(), 4u);
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 3u);
}

std::vector<float> colorsOf(std::string_view text, std::string_view name) {
  return attributeOf(import(text, name), "COLOR_0");
}

TEST(ImportObj, ColorsAreSrgb) {
  const std::vector<float> colors = colorsOf("v 0 0 0 0.5 0 1\nv 1 0 0 0.5 0 1\nv 0 1 0 0.5 0 1\nf 1 2 3\n", "t.obj");
  EXPECT_NEAR(colors[0], 0.21404114, 1e-6);
  EXPECT_EQ(std::vector<float>(colors.begin() + 1, colors.begin() + 4), (std::vector<float>{0, 1, 1}));
}

TEST(ImportObj, VerticesWithoutAColorAreWhite) {
  const std::vector<float> colors =
      colorsOf("v 0 0 0\nv 0 0 1 0 0 1\nv 0 2 0 2\nv 1 0 0 1 0 0\nf 1 2 3\nf 1 4 3\n", "t.obj");
  EXPECT_EQ(colors, (std::vector<float>{1, 1, 1, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0, 0, 1}));
}

TEST(ImportObj, AFourthNumberOfAColorIsAlpha) {
  const std::vector<float> colors = colorsOf("v 0 0 0 1 0 0 0.5\nv 1 0 0 1 0 0 1\nv 0 1 0 0 0 1 0\nf 1 2 3\n", "t.obj");
  EXPECT_EQ(colors, (std::vector<float>{1, 0, 0, 0.5f, 1, 0, 0, 1, 0, 0, 1, 0}));
}

TEST(ImportObj, ColorsMayBeBytes) {
  const std::vector<float> colors =
      colorsOf("v 0 0 0 255 0 0\nv 1 0 0 128 128 128\nv 0 1 0 0 0 255\nf 1 2 3\n", "t.obj");
  EXPECT_EQ(colors[0], 1);
  EXPECT_NEAR(colors[4], 0.2158605, 1e-6);
}

TEST(ImportObj, PicturesLieBesideTheMaterials) {
  const std::string png = std::string("\x89PNG\r\n\x1a\n", 8) + "not a real picture";
  const Asset asset =
      import("mtllib looks/t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n", "t.obj",
             folder({{"looks/t.mtl", "newmtl red\nmap_Kd -s 2 2 1 -o 0.5 0 0 skin.png\n"}, {"looks/skin.png", png}}));
  EXPECT_EQ(asset.document.images.size(), 1u);
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"texture-transforms"});
}

TEST(ImportObj, AFileOfMaterialsThatIsNotThereIsNamed) {
  for (const char* name : {"looks.mtl", "../outside.mtl", "model.mtl"}) {
    const std::string text = std::string("mtllib ") + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    const Asset asset = import(text, "t.obj", folder({}));
    ASSERT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"missing-materials"}) << name;
    EXPECT_THAT(asset.warnings.items()[0].where, HasSubstr(std::string(name).substr(0, 5)));
  }
}

TEST(ImportOff, CornersThatNameWhatIsNotThereAreReported) {
  const Asset asset = import("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 9\n", "t.off");
  EXPECT_EQ(testing::countOf(asset.warnings, "invalid-corners"), 1u);
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 2u);
}

TEST(ImportObj, APictureWhereTheObjHasItComesBeforeOneOfThatNameAlone) {
  const std::string magic("\x89PNG\r\n\x1a\n", 8);
  const Asset asset = import("mtllib looks/t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n", "t.obj",
                             folder({{"looks/t.mtl", "newmtl red\nmap_Kd pictures/skin.png\n"},
                                     {"skin.png", magic + "another"},
                                     {"pictures/skin.png", magic + "right"}}));
  ASSERT_EQ(asset.document.images.size(), 1u);
  const Bytes bytes = imageBytes(asset, 0).value();
  EXPECT_EQ(std::string(bytes.begin() + 8, bytes.end()), "right");
}

TEST(ImportObj, FormFeedsAndZerosEndLines) {
  const std::string text("v 0 0 0\fv 1 0 0\0v 0 1 0\nf 1 2 3\0f 3 2 1", 39);
  std::size_t lines = 0;
  forEachObjLine(asBytes(text), [&](std::string_view) { ++lines; });
  EXPECT_EQ(lines, 5u);
  const Asset asset = import(text, "t.obj");
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 2u);
  EXPECT_TRUE(asset.warnings.empty());
}

TEST(ImportObj, VerticesAtInfinityAreRefused) {
  EXPECT_THAT(errorOf("v 0 0 0\nv 1 0 0\nv 0 1 0 0\nf 1 2 3\n", "t.obj").what(),
              HasSubstr("a vertex has a position that is not"));
}

TEST(ImportObj, NumbersOfVerticesAreWhole) {
  const Asset asset = import("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1.5 2 3\nf +1 2 3\n", "t.obj");
  EXPECT_EQ(testing::countOf(asset.warnings, "invalid-faces"), 1u);
}

// Of a word of 4096 letters Assimp takes the rest for the next number.
TEST(ImportObj, VerticesThatAssimpReadsOtherwiseAreRefused) {
  const std::string zero = "0." + std::string(5000, '0');
  const Error error = errorOf("v " + zero + " 0 -0.5 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "t.obj");
  EXPECT_EQ(error.code(), ErrorCode::kBadData);
  EXPECT_THAT(error.what(), HasSubstr("not found again"));
}

TEST(ImportObj, ColorsThatNameNoVertexAreNone) {
  const float none = std::nanf("");
  EXPECT_EQ(objNumber(2, 1, 70000), kObjNumberBase + 2);
  for (const auto& [red, green] : {std::pair{-1.0f, 0.0f}, {0.0f, -1.0f}, {none, 0.0f}, {0.0f, none}, {5.0f, 0.0f}}) {
    EXPECT_FALSE(objNumber(red, green, 5)) << red << " " << green;
  }
}

TEST(ImportObj, TexturesThatAreMovedAreCounted) {
  EXPECT_EQ(countMovedMtlTextures(asBytes("map_Kd -o 1 0 0 a.png\nmap_Kd -s 1 1 1 -o 0 0 0 -bm 2 a.png\nKd 1 1 1\n")),
            1u);
}

TEST(ImportObj, LooseVerticesAreCounted) {
  const auto loose = [](const char* text) { return prepareObj(asBytes(text)).looseVertices; };
  EXPECT_EQ(loose("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 6 6\nf 1/1 2/2 -3\n"), 2u);
  EXPECT_EQ(loose("v 0 0 0\r\nv 1 0 0\r\n  l 1 2\r\nv 3 3 3\r\n"), 1u);
  EXPECT_EQ(loose("v 0 0 0\nv 1 0 0\n"), 0u);  // a cloud of points: nothing is left out
  const Asset asset = import("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n", "t.obj");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"loose-vertices"});
}

TEST(ImportObj, CornersMayCountBackwards) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";
  const std::vector<float> uvs = attributeOf(import(square + "f 1/1/1 2/2/1 3/3/1 4/4/1\n", "t.obj"), "TEXCOORD_0");
  for (const char* face : {"f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n", "f -4/1/1 2/-3/-1 -2/3/1 4/-1/1 # all of it\n",
                           "f 1/1/1 \\\n2/2/1 3/3/1\\\r\n 4/4/1#all of it\n"}) {
    const Asset asset = import(square + face, "t.obj");
    EXPECT_EQ(collectGeometry(asset).triangles.size(), 2u) << face;
    EXPECT_EQ(attributeOf(asset, "TEXCOORD_0"), uvs) << face;
    EXPECT_TRUE(warningKinds(asset.warnings).empty()) << face;
  }
}

TEST(ImportObj, NormalsWithoutADirectionAreMadeAnew) {
  const Asset asset = import("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nf 1//1 2//1 3//1\n", "t.obj");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"invalid-normals"});
  const std::vector<float> normals = attributeOf(asset, "NORMAL");
  EXPECT_EQ(std::vector<float>(normals.begin(), normals.begin() + 3), (std::vector<float>{0, 0, 1}));
}

// --- the formats without a scene ---

constexpr const char* kTrianglePly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n";

TEST(ImportPly, ColoursComeAlong) {
  const Asset asset = import(kTrianglePly, "t.ply");
  EXPECT_EQ(asset.format, "ply");
  const std::vector<float> colors = attributeOf(asset, "COLOR_0");
  ASSERT_EQ(colors.size(), 12u);
  EXPECT_NEAR(colors[0], 1, 1e-3);
  EXPECT_NEAR(colors[1], 0, 1e-3);
  EXPECT_NEAR(colors[10], 1, 1e-3);
}

TEST(ImportPly, VerticesThatNoFaceUsesStay) {
  const Asset asset = import(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n9 9 9\n3 0 1 2\n",
      "t.ply");
  EXPECT_EQ(collectGeometry(asset).positions.size(), 4u);
}

TEST(ImportPly, ACutFileIsNotFilledUp) {
  const std::string_view text = kTrianglePly;
  EXPECT_EQ(std::string(errorOf(text.substr(0, text.find("0 1 0 0 0 255")), "t.ply").what()),
            "t.ply: cannot be read as PLY: it is cut off: it holds less than its header announces");
}

TEST(ImportPly, APointCloudIsReadAndHasNoTriangle) {
  const Asset asset = import(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "0 0 0\n1 0 0\n",
      "t.ply");
  EXPECT_EQ(primitiveOf(asset).mode, 0u);
  EXPECT_THROW(collectGeometry(asset), Error);
}

std::string facet(const char* a, const char* b, const char* c) {
  std::string text = "facet normal 0 0 0\nouter loop\n";
  for (const char* corner : {a, b, c}) text.append("vertex ").append(corner).append("\n");
  return text.append("endloop\nendfacet\n");
}

TEST(ImportStl, FacetsShareTheirCornersAndHaveNoNormals) {
  const std::string text = std::string("solid thing\n")
                               .append(facet("0 0 0", "1 0 0", "0 1 0"))
                               .append(facet("1 0 0", "1 1 0", "0 1 0"))
                               .append("endsolid thing\n");
  const Asset asset = import(text, "t.stl");
  const Geometry geometry = collectGeometry(asset);
  EXPECT_EQ(geometry.positions.size(), 4u);
  EXPECT_DOUBLE_EQ(areaOf(geometry), 1);
  EXPECT_FALSE(primitiveOf(asset).attributes.find("NORMAL"));
}

TEST(ImportStl, BinaryIsToldFromItsLength) {
  std::string bytes(84 + 50, '\0');
  bytes[80] = 1;
  const float corners[] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0};
  std::memcpy(bytes.data() + 84, corners, sizeof corners);
  const Asset asset = import(bytes, "standard input");
  EXPECT_EQ(asset.format, "stl");
  EXPECT_DOUBLE_EQ(areaOf(collectGeometry(asset)), 2);
}

TEST(ImportStl, OneThatIsCutOffIsRefusedInOurWords) {
  std::string bytes(84 + 2 * 50, '\0');
  bytes[80] = 2;
  for (const std::size_t length : {60u, 84u, 100u, 183u}) {
    EXPECT_EQ(std::string(errorOf(bytes.substr(0, length), "cut.stl").what()),
              "cut.stl: cannot be read as STL: its length is not that of the triangles it announces: it is cut off, or "
              "no STL");
  }
  bytes.replace(0, 5, "solid");
  EXPECT_THAT(errorOf(bytes.substr(0, 183), "cut.stl").what(), ::testing::HasSubstr("it is cut off, or no STL"));
  EXPECT_THAT(errorOf("SOLID thing\nendsolid\n", "t.stl").what(),
              ::testing::HasSubstr("it does not begin with 'solid', as STL in text does"));
}

TEST(ImportStl, BytesBehindTheTrianglesAreLeftOut) {
  std::string bytes(84 + 50 + 2, '\0');
  bytes[80] = 1;
  const float corners[] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0};
  std::memcpy(bytes.data() + 84, corners, sizeof corners);
  const Asset asset = import(bytes, "t.stl");
  EXPECT_DOUBLE_EQ(areaOf(collectGeometry(asset)), 2);
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"trailing-bytes"});
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
}

TEST(ImportStl, NamesMayBeInLatin1) {
  for (const char* name : {"M\xfcller", "M\xc3\xbcller"}) {
    const std::string text =
        std::string("solid ").append(name).append("\n") + facet("0 0 0", "1 0 0", "0 1 0") + "endsolid " + name + "\n";
    const Asset asset = import(text, "t.stl");
    ASSERT_EQ(asset.document.meshes.size(), 1u);
    EXPECT_EQ(asset.document.meshes[0].name, "M\xc3\xbcller");
  }
}

TEST(ImportOff, ColorsMayBeBytes) {
  const std::vector<float> colors =
      colorsOf("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 128 0 255\n0 1 0 0 0 255 51\n3 0 1 2\n", "t.off");
  EXPECT_EQ(std::vector<float>(colors.begin(), colors.begin() + 4), (std::vector<float>{1, 0, 0, 1}));
  EXPECT_NEAR(colors[5], 0.2158605, 1e-6);
  EXPECT_NEAR(colors[11], 0.2, 1e-6);
}

TEST(ImportOff, IsRead) {
  const Asset asset = import("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "t.off");
  EXPECT_EQ(collectGeometry(asset).triangles.size(), 1u);
}

TEST(ImportModel, ContentCountsMoreThanTheName) {
  EXPECT_EQ(import(kTrianglePly, "misnamed.obj").format, "ply");
  EXPECT_EQ(import(kSquareObj, "standard input").format, "obj");
  EXPECT_EQ(errorOf("hello there", "notes.txt").code(), ErrorCode::kUnsupported);
}

// --- FBX ---

std::string fbx(int up, int front, int frontSign, double unit) {
  const auto axis = [](const char* name, int value) {
    return std::string("\t\tP: \"")
               .append(name)
               .append("\", \"int\", \"Integer\", \"\",")
               .append(std::to_string(value)) +
           '\n';
  };
  return std::string(
             "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n")
      .append("GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n")
      .append(axis("UpAxis", up) + axis("UpAxisSign", 1) + axis("FrontAxis", front))
      .append(axis("FrontAxisSign", frontSign) + axis("CoordAxis", 0) + axis("CoordAxisSign", 1))
      .append("\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",")
      .append(std::to_string(unit))
      .append("\n\t}\n}\nObjects:  {\n\tGeometry: 100, \"Geometry::Tri\", \"Mesh\" {\n\t\tVertices: *9 {\n")
      .append("\t\t\ta: 0,0,0,100,0,0,0,0,200\n\t\t}\n\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t}\n")
      .append("\tModel: 200, \"Model::Tri\", \"Mesh\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n")
      .append("\t\t\tP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,0,50\n\t\t}\n\t}\n}\n")
      .append("Connections:  {\n\tC: \"OO\",200,0\n\tC: \"OO\",100,200\n}\n");
}

TEST(ImportFbx, CentimetresBecomeMetres) {
  const Asset asset = import(fbx(1, 2, 1, 1), "t.fbx");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"converted-units"});
  const Geometry geometry = collectGeometry(asset);
  EXPECT_TRUE(sizeOf(geometry).isApprox(Vec3(1, 0, 2), 1e-6));
  EXPECT_NEAR(geometry.positions[0].z(), 0.5, 1e-6);  // the node's translation is converted too
  EXPECT_FALSE(asset.document.nodes.at(0).scale);
}

TEST(ImportFbx, ZUpBecomesYUp) {
  const Asset asset = import(fbx(2, 1, -1, 100), "t.fbx");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"converted-axes"});
  const Geometry geometry = collectGeometry(asset);
  EXPECT_TRUE(sizeOf(geometry).isApprox(Vec3(100, 200, 0), 1e-6));
  EXPECT_NEAR(geometry.positions[0].y(), 50, 1e-4);
}

// --- COLLADA: a skinned and moving character of two joints ---

constexpr const char* kCharacterDae = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
 <library_geometries><geometry id="body" name="body"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 0 100 0 0 0 100</float_array>
   <technique_common><accessor source="#pa" count="4" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
   </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
 </mesh></geometry></library_geometries>
 <library_controllers><controller id="skin"><skin source="#body">
  <bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
  <source id="j"><Name_array id="ja" count="2">hip chest</Name_array>
   <technique_common><accessor source="#ja" count="2" stride="1"><param name="JOINT" type="name"/></accessor></technique_common></source>
  <source id="b"><float_array id="ba" count="32">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1  1 0 0 0 0 1 0 -50 0 0 1 0 0 0 0 1</float_array>
   <technique_common><accessor source="#ba" count="2" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
  <source id="w"><float_array id="wa" count="3">1 0.25 0.75</float_array>
   <technique_common><accessor source="#wa" count="3" stride="1"><param name="WEIGHT" type="float"/></accessor></technique_common></source>
  <joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#b"/></joints>
  <vertex_weights count="4"><input semantic="JOINT" source="#j" offset="0"/><input semantic="WEIGHT" source="#w" offset="1"/>
   <vcount>1 1 2 1</vcount><v>0 0 0 0 0 1 1 2 1 0</v></vertex_weights>
 </skin></controller></library_controllers>
 <library_animations><animation id="swing">
  <source id="t"><float_array id="ta" count="2">0 1.5</float_array>
   <technique_common><accessor source="#ta" count="2" stride="1"><param name="TIME" type="float"/></accessor></technique_common></source>
  <source id="o"><float_array id="oa" count="32">1 0 0 0 0 1 0 50 0 0 1 0 0 0 0 1  0 -1 0 0 1 0 0 70 0 0 1 0 0 0 0 1</float_array>
   <technique_common><accessor source="#oa" count="2" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor></technique_common></source>
  <source id="i"><Name_array id="ia" count="2">LINEAR LINEAR</Name_array>
   <technique_common><accessor source="#ia" count="2" stride="1"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>
  <sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/><input semantic="INTERPOLATION" source="#i"/></sampler>
  <channel source="#s" target="chest/m"/>
 </animation></library_animations>
 <library_visual_scenes><visual_scene id="scene">
  <node id="hip" name="hip" sid="hip" type="JOINT"><matrix sid="m">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
   <node id="chest" name="chest" sid="chest" type="JOINT"><matrix sid="m">1 0 0 0 0 1 0 50 0 0 1 0 0 0 0 1</matrix></node></node>
  <node id="actor" name="actor"><instance_controller url="#skin"><skeleton>#hip</skeleton></instance_controller></node>
 </visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>)";

TEST(ImportDae, SkinAndSkeletonComeInMetres) {
  const Asset asset = import(kCharacterDae, "t.dae");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"converted-units"});
  ASSERT_TRUE(hasRig(asset));
  const Geometry geometry = collectGeometry(asset);
  EXPECT_TRUE(sizeOf(geometry).isApprox(Vec3(1, 1, 1), 1e-5));
  const AssetSkeleton skeleton = readSkeleton(asset);
  ASSERT_EQ(skeleton.skeleton.jointCount(), 2u);
  EXPECT_EQ(skeleton.skeleton.joints[1].name, "chest");
  EXPECT_EQ(skeleton.skeleton.joints[1].parent, 0u);
  EXPECT_TRUE(restGlobals(skeleton.skeleton)[1].translation().isApprox(Vec3(0, 0.5, 0), 1e-5));
  const SkinWeights weights = readWeights(asset, geometry, skeleton);
  for (Index v = 0; v < 4; ++v) {
    if (!geometry.positions[v].isApprox(Vec3f(0, 1, 0), 1e-5f)) continue;
    EXPECT_EQ(weights.jointsOf(v)[0], 1u);
    EXPECT_NEAR(weights.weightsOf(v)[0], 0.75, 1e-6);
    EXPECT_NEAR(weights.weightsOf(v)[1], 0.25, 1e-6);
  }
}

TEST(ImportDae, TheSkinnedMeshStandsAtTheRoot) {
  const Asset asset = import(kCharacterDae, "t.dae");
  for (Index n = 0; n < asset.document.nodeCount(); ++n) {
    const gltf::Node& node = asset.document.nodes[n];
    if (!node.skin) continue;
    EXPECT_THAT(asset.document.scenes.at(0).nodes, Contains(n));
    EXPECT_EQ(node.name, "actor");
    EXPECT_FALSE(node.translation);
  }
}

TEST(ImportDae, TheClipMovesTheJointInSecondsAndMetres) {
  const Asset asset = import(kCharacterDae, "t.dae");
  ASSERT_EQ(asset.document.animations.size(), 1u);
  const gltf::Animation& clip = asset.document.animations[0];
  bool sawTranslation = false;
  for (const gltf::AnimationChannel& channel : clip.channels) {
    const gltf::AnimationSampler& sampler = clip.samplers.at(channel.sampler);
    const std::vector<float> times = readFloats(asset, sampler.input);
    EXPECT_FLOAT_EQ(times.back(), 1.5f);
    EXPECT_EQ(asset.document.nodes.at(channel.target.node.value()).name, "chest");
    const std::vector<float> values = readFloats(asset, sampler.output);
    if (channel.target.path == "translation") {
      sawTranslation = true;
      EXPECT_NEAR(values[values.size() - 2], 0.7, 1e-6);
    } else if (channel.target.path == "rotation") {
      EXPECT_NEAR(values[values.size() - 1], std::sqrt(0.5), 1e-5);
    }
  }
  EXPECT_TRUE(sawTranslation);
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(ImportDae, WhiteSpaceAtTheEndsOfTextsDoesNotCount) {
  const Asset plain = import(kCharacterDae, "t.dae");
  const std::pair<const char*, const char*> spaced[] = {
      {"<vcount>1 1 2 1</vcount>", "<vcount>\n  1 1 2 1\n</vcount>"},
      {"<v>0 0 0 0 0 1 1 2 1 0</v>", "<v>\r\n\t0 0 0 0 0 1 1 2 1 0\r\n</v>"},
      {"<p>0 2 1", "<p><!-- > --> \n 0 2 1"},
      {">1 0.25 0.75<", "> 1 0.25 0.75 <"},
  };
  for (const auto& [text, other] : spaced) {
    const Asset asset = import(replaced(kCharacterDae, text, other), "t.dae");
    EXPECT_EQ(testing::documentJson(asset), testing::documentJson(plain)) << text;
    EXPECT_EQ(asset.buffers[0].bytes, plain.buffers[0].bytes) << text;
  }
}

TEST(ImportDae, ColorsMayHaveWhiteSpaceAround) {
  constexpr const char* kEffects =
      "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"c\"><lambert><diffuse><color>\n 0.25 0.5 1 "
      "1\n"
      "</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
      "<library_materials><material id=\"m\" name=\"a > b\"><instance_effect "
      "url=\"#e\"/></material></library_materials>"
      "<library_geometries>";
  const Asset asset = import(replaced(kCharacterDae, "<library_geometries>", kEffects), "t.dae");
  ASSERT_FALSE(asset.document.materials.empty());
}

TEST(PrepareDae, LeavesAttributesCommentsAndSectionsAsTheyAre) {
  constexpr const char* kText = "<a b=\"x >  y\" c='\" > '><!-- > z --><![CDATA[ > ]]></a>";
  EXPECT_EQ(prepareDae(asBytes(kText)).text, kText);
  EXPECT_EQ(prepareDae(asBytes("<a>\n 1 2 \n</a> <b/> \n")).text, "<a>1 2</a><b/>");
  EXPECT_EQ(prepareDae(asBytes("<a> 1")).text, "<a>1");
}

TEST(ImportDae, KeysWithStepsOrCurvesBetweenAreReported) {
  for (const char* names : {"STEP STEP", "LINEAR BEZIER", "\n HERMITE\n HERMITE\n"}) {
    const Asset asset = import(replaced(kCharacterDae, "LINEAR LINEAR", names), "t.dae");
    EXPECT_THAT(warningKinds(asset.warnings), Contains("key-interpolation")) << names;
  }
}

TEST(ImportDae, VerticesWithoutWeightsLeaveTheSkinACommonRoot) {
  const std::string text = replaced(replaced(kCharacterDae, "<vcount>1 1 2 1<", "<vcount>1 1 0 1<"),
                                    "<v>0 0 0 0 0 1 1 2 1 0<", "<v>0 0 0 0 1 0<");
  const Asset asset = import(text, "t.dae");
  const SceneGraph graph = readSceneGraph(asset.document);
  ASSERT_EQ(asset.document.skins.size(), 1u);
  ASSERT_EQ(asset.document.skins[0].joints.size(), 3u);
  std::set<Index> roots;
  for (Index joint : asset.document.skins[0].joints) {
    EXPECT_TRUE(graph.shown[joint]);
    while (graph.parent[joint]) joint = *graph.parent[joint];
    roots.insert(joint);
  }
  EXPECT_EQ(roots.size(), 1u);
}

TEST(ImportDae, Utf16IsRefused) {
  EXPECT_THAT(errorOf(std::string_view("\xff\xfe<\0?\0", 6), "t.dae").what(),
              HasSubstr("is text in UTF-16 (save it as UTF-8)"));
}

// --- hostile files ---

TEST(ImportModel, EveryTruncationIsAnErrorOrAModel) {
  std::string stl(84 + 100, '\0');
  stl[80] = 2;
  const std::pair<const char*, std::string> files[] = {{"t.obj", kSquareObj},
                                                       {"t.ply", kTrianglePly},
                                                       {"t.stl", stl},
                                                       {"t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [name, text] : files) {
    for (std::size_t length = 1; length < text.size(); length += 1 + text.size() / 12) {
      try {
        const Asset asset = import(std::string_view(text).substr(0, length), name);
        checkAsset(asset);
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), Not(HasSubstr("\n"))) << name;
        EXPECT_EQ(std::string(error.what()).rfind(name, 0), 0u) << error.what();
      }
    }
  }
}

TEST(ImportModel, ASmallFileDoesNotGetAllMemory) {
  if (kAddressSanitizer) GTEST_SKIP() << "memory is not limited there";
  const Resolver huge = [](std::string_view) { return Bytes(std::size_t{512} << 20); };
  try {
    import(kSquareObj, "square.obj", huge);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    EXPECT_THAT(error.what(), HasSubstr("asks for more memory than a file of its size may"));
  }
}

TEST(ReadBounds, TheImporterStaysBelowSixteenTimesTheFile) {
  using read_bounds::kMega;
  for (const std::uint64_t size : {std::uint64_t{0}, kMega, 15 * kMega, 16 * kMega, 17 * kMega, 1000 * kMega}) {
    const std::uint64_t program = 16 * kMega, most = ReadBound{256 * kMega, 16}.larger(size);
    EXPECT_LE(program + size + read_bounds::kAssimp.larger(size), most) << size;
  }
}

TEST(ImportObj, NumbersMayBeginWithAPoint) {
  const std::string face = "f 1/1/1 2/1/1 3/1/1\n";
  const Asset asset = import("v .5 0 0\nv 1 -.5 0\nv 0 1 .25\nvt .5 .25\nvn 0 .6 .8\n" + face, "t.obj");
  const Asset same = import("v 0.5 0 0\nv 1 -0.5 0\nv 0 1 0.25\nvt 0.5 0.25\nvn 0 0.6 0.8\n" + face, "t.obj");
  EXPECT_EQ(writeGlb(asset), writeGlb(same));
}

TEST(ImportObj, TooManyChangesOfObjectGroupOrMaterialAreRefused) {
  const auto file = [](const char* kind, bool sameName) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 20'000; ++i) text += fmt::format("{} n{}\nf 1 2 3\n", kind, sameName ? 0 : i);
    return text;
  };
  for (const char* kind : {"o", "g", "usemtl"}) {
    const Error error = errorOf(file(kind, false), "t.obj");
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    EXPECT_THAT(error.what(), HasSubstr(fmt::format("'{}' lines", kind)));
    EXPECT_FALSE(error.remedy().empty());
    EXPECT_EQ(collectGeometry(import(file(kind, true), "t.obj")).triangles.size(), 20'000u);
  }
}

TEST(ImportModel, TooManyMeshesAreRefused) {
  std::string text;
  for (int i = 0; i < 25'000; ++i) {
    text +=
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid\n";
  }
  const Error error = errorOf(text, "t.stl");
  EXPECT_EQ(error.code(), ErrorCode::kLimit) << error.what();
  EXPECT_THAT(error.what(), HasSubstr("has 25000 meshes"));
}

TEST(ImportModel, AnswersOnOneLineWhatAssimpSays) {
  const Error error = errorOf("ply\nformat ascii 1.0\nend_header\n", "t.ply");
  EXPECT_EQ(error.code(), ErrorCode::kBadData);
  EXPECT_THAT(error.what(), HasSubstr("t.ply: cannot be read as PLY: "));
}

TEST(ImportModel, IsTheSameEveryTime) {
  const Asset a = import(kCharacterDae, "t.dae"), b = import(kCharacterDae, "t.dae");
  EXPECT_EQ(testing::documentJson(a), testing::documentJson(b));
  EXPECT_EQ(a.buffers[0].bytes, b.buffers[0].bytes);
}

}  // namespace
}  // namespace limber
