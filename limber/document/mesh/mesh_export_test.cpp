#include "limber/document/mesh/mesh_export.h"

#include <cstring>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/accessor.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"

namespace limber {
namespace {

// Two triangles of a bent strip (0 1 2, 2 1 3), textured, below a node that moves them by (10, 0, 0).
Asset strip() {
  Asset asset;
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1};
  const std::vector<float> uvs = {0, 0, 1, 0, 0, 1, 1, 0.25f};
  const Index position = addFloatAccessor(asset, positions, 3, kVertexTarget, true);
  const Index uv = addFloatAccessor(asset, uvs, 2, kVertexTarget);
  const std::vector<std::uint16_t> indices = {0, 1, 2, 2, 1, 3};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(indices.data());
  const Index index = addAccessor(asset, {6, 1, ComponentType::kU16, false}, {bytes, 12}, kIndexTarget);
  testing::editDocument(asset, [&](Json& json) {
    json["meshes"] =
        Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}},
                                                   {"indices", index},
                                                   {"material", 0}}})}}});
    json["nodes"] = Json::array({{{"name", "bent strip"}, {"mesh", 0}, {"translation", {10, 0, 0}}}});
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["materials"] = Json::array(
        {{{"name", "blue cloth"},
          {"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 1}}, {"baseColorTexture", {{"index", 0}}}}}}});
    json["textures"] = Json::array({{{"source", 0}}});
    json["images"] = Json::array({{{"uri", "cloth.png"}}});
  });
  asset.sideFiles.push_back({"cloth.png", testing::pngBytes()});
  return asset;
}

ExportMesh stripMesh() {
  const Asset asset = strip();
  return exportMesh(asset, collectGeometry(asset));
}

std::string textOf(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

template <typename T>
T at(const Bytes& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(MeshExport, PartsAreInTheWorldWithMaterialAndTexture) {
  const ExportMesh mesh = stripMesh();
  EXPECT_EQ(mesh.positions[1], Vec3f(11, 0, 0));
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].name, "bent_strip_0");
  EXPECT_EQ(mesh.parts[0].triangleCount, 2u);
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_EQ(mesh.materials[0].color[0], 0.25f);
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].bytes, testing::pngBytes());
  EXPECT_EQ(mesh.uvs[3], Vec2f(1, 0.75f));
}

TEST(MeshExport, NormalsAreWeightedByArea) {
  const ExportMesh mesh = stripMesh();
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 1));
  const Vec3f second = Vec3f(1, -1, 0).cross(Vec3f(1, 0, 1));
  EXPECT_LT((mesh.normals[1] - (Vec3f(0, 0, 1) + second).normalized()).norm(), 1e-6f);
  EXPECT_LT((mesh.normals[3] - second.normalized()).norm(), 1e-6f);
}

TEST(MeshExport, ObjReadsBackEqual) {
  const ExportMesh mesh = stripMesh();
  std::istringstream lines(textOf(encodeObj(mesh, "strip.mtl")));
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<Triangle> triangles;
  std::string key, material, library;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    words >> key;
    float x = 0, y = 0, z = 0;
    if (key == "v" && words >> x >> y >> z) positions.emplace_back(x, y, z);
    if (key == "vn" && words >> x >> y >> z) normals.emplace_back(x, y, z);
    if (key == "vt" && words >> x >> y) uvs.emplace_back(x, y);
    if (key == "usemtl") words >> material;
    if (key == "mtllib") words >> library;
    if (key != "f") continue;
    Triangle t;
    for (Index& v : t) {
      std::string corner;
      words >> corner;
      v = static_cast<Index>(std::stoul(corner)) - 1;
      EXPECT_EQ(corner, std::to_string(v + 1) + "/" + std::to_string(v + 1) + "/" + std::to_string(v + 1));
    }
    triangles.push_back(t);
  }
  EXPECT_EQ(positions, mesh.positions);
  EXPECT_EQ(normals, mesh.normals);
  EXPECT_EQ(uvs, mesh.uvs);
  EXPECT_EQ(triangles, mesh.triangles);
  EXPECT_EQ(material, mesh.materials[0].name);
  EXPECT_EQ(library, "strip.mtl");
  EXPECT_NE(textOf(encodeMtl(mesh)).find("newmtl " + material + "\nKd 0.25 0.5 1\n"), std::string::npos);
}

TEST(MeshExport, StlHoldsEachTriangleWithItsNormal) {
  const Bytes stl = encodeStl(stripMesh());
  ASSERT_EQ(stl.size(), 84u + 2 * 50);
  EXPECT_EQ(at<std::uint32_t>(stl, 80), 2u);
  EXPECT_EQ(at<float>(stl, 84 + 8), 1.0f);         // normal z of the first triangle
  EXPECT_EQ(at<float>(stl, 84 + 12 + 12), 11.0f);  // x of its second corner
}

TEST(MeshExport, PlyHoldsWhatItsHeaderSays) {
  const ExportMesh mesh = stripMesh();
  const Bytes ply = encodePly(mesh);
  const std::string text = textOf(ply);
  const std::size_t body = text.find("end_header\n") + 11;
  EXPECT_NE(text.find("element vertex 4\n"), std::string::npos);
  EXPECT_NE(text.find("property float s\n"), std::string::npos);
  EXPECT_EQ(ply.size(), body + 4 * 8 * sizeof(float) + 2 * 13);
  EXPECT_EQ(at<float>(ply, body + 32), 11.0f);
}

TEST(MeshExport, ObjComesWithItsFilesOrNotAtAll) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "limber_mesh_export_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  writeMesh(stripMesh(), folder / "Strip.OBJ");
  EXPECT_TRUE(fs::exists(folder / "Strip.mtl"));
  EXPECT_TRUE(fs::exists(folder / "Strip_texture_0.png"));
  EXPECT_NE(textOf(readFile(folder / "Strip.mtl")).find("map_Kd Strip_texture_0.png"), std::string::npos);
  EXPECT_THROW(writeMesh(stripMesh(), folder / "strip.fbx"), Error);
  EXPECT_FALSE(fs::exists(folder / "strip.fbx"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace limber
