// The encoders of the same libraries are the oracle; the broken data are made here.
#ifdef LIMBER_CODECS

#include "limber/document/gltf/codecs/codecs.h"

#include <cmath>
#include <numeric>

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/codecs/codecs_detail.h"
#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"

namespace limber {
namespace {

using testing::documentJson;
using ::testing::ElementsAre;
using testing::GltfBuilder;

constexpr const char* kMeshoptName = "EXT_meshopt_compression";
constexpr const char* kDracoName = "KHR_draco_mesh_compression";

// A model under construction whose views decode into a buffer of their own without bytes.
struct MeshoptModel {
  GltfBuilder model;
  std::size_t decodedSize = 0;

  Index addView(const Bytes& encoded, std::size_t count, std::size_t stride, const char* mode,
                const char* filter = "NONE") {
    model.binary.resize((model.binary.size() + 3) / 4 * 4);
    const Json extension = {{"buffer", 0},
                            {"byteOffset", model.binary.size()},
                            {"byteLength", encoded.size()},
                            {"byteStride", stride},
                            {"count", count},
                            {"mode", mode},
                            {"filter", filter}};
    model.binary.insert(model.binary.end(), encoded.begin(), encoded.end());
    decodedSize = (decodedSize + 3) / 4 * 4;
    const Index view = model.push("bufferViews", {{"buffer", 1},
                                                  {"byteOffset", decodedSize},
                                                  {"byteLength", count * stride},
                                                  {"extensions", {{kMeshoptName, extension}}}});
    decodedSize += count * stride;
    return view;
  }

  Bytes glb(const std::string& extension = kMeshoptName) {
    Json json = model.json;
    json["buffers"] = {{{"byteLength", model.binary.size()}},
                       {{"byteLength", decodedSize}, {"extensions", {{extension, {{"fallback", true}}}}}}};
    json["extensionsUsed"] = json["extensionsRequired"] = {extension};
    std::string text = json.dump();
    for (std::size_t at = 0; extension != kMeshoptName && (at = text.find(kMeshoptName, at)) != std::string::npos;) {
      text.replace(at, std::string(kMeshoptName).size(), extension);
    }
    return GltfBuilder::glbOf(text, model.binary);
  }
};

template <typename T>
Bytes encodeVertices(const std::vector<T>& values, std::size_t stride) {
  const std::size_t count = values.size() * sizeof(T) / stride;
  Bytes out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return out;
}

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(std::sin(0.1 * static_cast<double>(i)));
  return values;
}

TEST(Meshopt, DecodesVerticesAndBothKindsOfIndices) {
  const std::vector<float> positions = ramp(300);
  const std::vector<std::uint32_t> indices = {0, 1, 2, 2, 1, 3, 3, 1, 4, 4, 1, 99};
  Bytes triangles(meshopt_encodeIndexBufferBound(indices.size(), 100));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
  Bytes sequence(meshopt_encodeIndexSequenceBound(indices.size(), 100));
  sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(), indices.size()));

  for (const char* extension : {kMeshoptName, "KHR_meshopt_compression"}) {
    MeshoptModel file;
    const Index vertexView = file.addView(encodeVertices(positions, 12), 100, 12, "ATTRIBUTES");
    const Index triangleView = file.addView(triangles, indices.size(), 2, "TRIANGLES");
    const Index sequenceView = file.addView(sequence, indices.size(), 4, "INDICES");
    file.model.push("accessors",
                    {{"bufferView", vertexView}, {"componentType", 5126}, {"count", 100}, {"type", "VEC3"}});
    file.model.push("accessors",
                    {{"bufferView", triangleView}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}});
    file.model.push("accessors",
                    {{"bufferView", sequenceView}, {"componentType", 5125}, {"count", 12}, {"type", "SCALAR"}});
    const Asset asset = readAsset(file.glb(extension), "m.glb");
    EXPECT_EQ(readFloats(asset, 0), positions);
    EXPECT_EQ(readIndices(asset, 1), indices);
    EXPECT_EQ(readIndices(asset, 2), indices);
    // Nothing of the compression is left, and no compressed byte.
    EXPECT_EQ(documentJson(asset).dump().find("meshopt"), std::string::npos);
    EXPECT_TRUE(asset.document.extensionsUsed.empty());
    ASSERT_EQ(asset.buffers.size(), 1u);
    EXPECT_EQ(asset.buffers[0].bytes.size(), 1200u + 24 + 48);
    ASSERT_EQ(asset.warnings.items().size(), 1u);
    EXPECT_EQ(asset.warnings.items()[0].kind, "decompressed");
    EXPECT_EQ(asset.warnings.items()[0].count, 3u);
    EXPECT_EQ(readFloats(readAsset(writeGlb(asset), "again.glb"), 0), positions);
  }
}

TEST(Meshopt, DecodesFilters) {
  const std::size_t count = 16;
  std::vector<float> normals, quaternions, numbers;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 0.3 * static_cast<double>(i);
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    normals.insert(normals.end(), {c * 0.6f, s * 0.6f, 0.8f, 0});
    quaternions.insert(quaternions.end(), {s * 0.6f, 0, s * 0.8f, c});
    numbers.insert(numbers.end(), {100 * c, s / 1000, static_cast<float>(i)});
  }
  std::vector<std::uint8_t> oct8(count * 4), oct16(count * 8), quat(count * 8), exponential(count * 12);
  meshopt_encodeFilterOct(oct8.data(), count, 4, 8, normals.data());
  meshopt_encodeFilterOct(oct16.data(), count, 8, 16, normals.data());
  meshopt_encodeFilterQuat(quat.data(), count, 8, 16, quaternions.data());
  meshopt_encodeFilterExp(exponential.data(), count, 12, 24, numbers.data());

  MeshoptModel file;
  const auto add = [&](const std::vector<std::uint8_t>& data, std::size_t stride, const char* filter, int type,
                       const char* shape) {
    const Index view = file.addView(encodeVertices(data, stride), count, stride, "ATTRIBUTES", filter);
    file.model.json["bufferViews"][view]["byteStride"] = stride;
    file.model.push("accessors", {{"bufferView", view},
                                  {"componentType", type},
                                  {"count", count},
                                  {"type", shape},
                                  {"normalized", type != 5126}});
  };
  add(oct8, 4, "OCTAHEDRAL", 5120, "VEC3");
  add(oct16, 8, "OCTAHEDRAL", 5122, "VEC3");
  add(quat, 8, "QUATERNION", 5122, "VEC4");
  add(exponential, 12, "EXPONENTIAL", 5126, "VEC3");
  const Asset asset = readAsset(file.glb(), "m.glb");
  for (const auto& [accessor, tolerance] : {std::pair<Index, float>{0, 0.02f}, {1, 1e-4f}}) {
    const std::vector<float> read = readFloats(asset, accessor);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(read[3 * i + c], normals[4 * i + c], tolerance);
    }
  }
  const std::vector<float> turned = readFloats(asset, 2), scaled = readFloats(asset, 3);
  for (std::size_t i = 0; i < count; ++i) {
    float dot = 0;
    for (std::size_t c = 0; c < 4; ++c) dot += turned[4 * i + c] * quaternions[4 * i + c];
    EXPECT_NEAR(std::abs(dot), 1, 1e-4);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(scaled[i], numbers[i], 1e-4 * 128);
}

TEST(Meshopt, PlainFallbackIsTakenAsItIs) {
  GltfBuilder model;
  const Index plain = model.view<float>({1, 2, 3});
  model.push("accessors", {{"bufferView", plain}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
  const std::size_t offset = model.binary.size();
  model.binary.resize(offset + 40, 0xee);  // a substitute for compressed bytes; never decoded
  model.json["bufferViews"][plain]["extensions"][kMeshoptName] = {{"buffer", 0},      {"byteOffset", offset},
                                                                  {"byteLength", 40}, {"byteStride", 4},
                                                                  {"count", 3},       {"mode", "ATTRIBUTES"}};
  model.json["extensionsUsed"] = {kMeshoptName, "KHR_other"};
  const Asset asset = readAsset(model.glb(), "m.glb");
  EXPECT_THAT(readFloats(asset, 0), ElementsAre(1, 2, 3));
  EXPECT_THAT(asset.document.extensionsUsed, ElementsAre("KHR_other"));
  EXPECT_EQ(asset.buffers[0].bytes.size(), 12u);
}

TEST(Meshopt, OtherBytesOfTheBufferStay) {
  MeshoptModel file;
  const Index before = file.model.view(testing::pngBytes());
  const Index decoded = file.addView(encodeVertices(ramp(30), 12), 10, 12, "ATTRIBUTES");
  const Index after = file.model.view<float>({7, 8, 9});
  file.model.push("accessors", {{"bufferView", decoded}, {"componentType", 5126}, {"count", 10}, {"type", "VEC3"}});
  file.model.push("accessors", {{"bufferView", after}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
  file.model.push("images", {{"bufferView", before}, {"mimeType", "image/png"}});
  const Asset asset = readAsset(file.glb(), "m.glb");
  EXPECT_EQ(readFloats(asset, 0), ramp(30));
  EXPECT_THAT(readFloats(asset, 1), ElementsAre(7, 8, 9));
  ASSERT_EQ(asset.buffers.size(), 2u);
  EXPECT_EQ(asset.buffers[0].bytes.size(), 12u + 12);  // image (padded) and floats
  EXPECT_TRUE(
      std::equal(asset.buffers[0].bytes.begin(), asset.buffers[0].bytes.begin() + 11, testing::pngBytes().begin()));
}

TEST(Meshopt, BrokenDataAreErrors) {
  const Bytes good = encodeVertices(ramp(300), 12);
  const auto codeOf = [](MeshoptModel& file) {
    try {
      readAsset(file.glb(), "m.glb");
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::kCancelled;
  };
  for (std::size_t length = 1; length < good.size(); length += 7) {
    MeshoptModel file;
    file.addView({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}, 100, 12, "ATTRIBUTES");
    EXPECT_EQ(codeOf(file), ErrorCode::kBadData);
  }
  const std::tuple<std::size_t, std::size_t, const char*, const char*, ErrorCode> kShapes[] = {
      {100, 10, "ATTRIBUTES", "NONE", ErrorCode::kBadData},
      {100, 12, "TRIANGLES", "NONE", ErrorCode::kBadData},
      {100, 12, "ATTRIBUTES", "QUATERNION", ErrorCode::kBadData},
      {100, 12, "ATTRIBUTES", "OCTAHEDRAL", ErrorCode::kBadData},
      {100, 2, "TRIANGLES", "NONE", ErrorCode::kBadData},
      {99, 2, "TRIANGLES", "EXPONENTIAL", ErrorCode::kBadData},
      {100, 512, "ATTRIBUTES", "NONE", ErrorCode::kBadData},
      {100, 12, "VERTICES", "NONE", ErrorCode::kBadData},
      {100, 12, "ATTRIBUTES", "COLOR", ErrorCode::kUnsupported},
      {400000000, 256, "ATTRIBUTES", "NONE", ErrorCode::kLimit}};
  for (const auto& [count, stride, mode, filter, code] : kShapes) {
    MeshoptModel file;
    file.addView(good, count, stride, mode, filter);
    EXPECT_EQ(codeOf(file), code) << count << " " << stride << " " << mode << " " << filter;
  }
}

TEST(Meshopt, UnpacksToABoundOfItsFile) {
  const Bytes data = encodeVertices(ramp(300), 12);
  // Views of so many bytes each that say more than their data; broken ones are those that are decoded.
  const auto codeOf = [&](std::size_t views, std::size_t bytes) {
    MeshoptModel file;
    for (std::size_t i = 0; i < views; ++i) file.addView(data, bytes / 4, 4, "ATTRIBUTES");
    try {
      readAsset(file.glb(), "m.glb");
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::kCancelled;
  };
  EXPECT_EQ(codeOf(1, 32 << 20), ErrorCode::kBadData);
  EXPECT_EQ(codeOf(1, (32 << 20) + 4), ErrorCode::kLimit);
  EXPECT_EQ(codeOf(5, 7 << 20), ErrorCode::kLimit);
}

TEST(DecodeBudget, ThrowsWhenItIsSpent) {
  const std::size_t size = 1500;
  DecodeBudget budget(size);
  EXPECT_EQ(budget.left(), size);
  budget.take(size, "m");
  EXPECT_THROW(budget.take(1, "m"), Error);
}

// A grid of points in a plane with weights on two joints, as Draco data and as a model that refers to them.
struct DracoModel {
  GltfBuilder model;
  draco::Mesh mesh;
  std::vector<float> positions, weights;
  std::vector<std::uint8_t> joints;
  static constexpr int kSide = 12;

  explicit DracoModel(int method) {
    const int points = kSide * kSide;
    for (int i = 0; i < points; ++i) {
      const float fraction = static_cast<float>(i % kSide) / 11;
      positions.insert(positions.end(),
                       {static_cast<float>(i % kSide), static_cast<float>(i / kSide), fraction * fraction});
      weights.insert(weights.end(), {fraction, 1 - fraction, 0, 0});
      joints.insert(joints.end(), {1, 0, 0, 0});
    }
    mesh.set_num_points(points);
    const int p = add(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, positions.data());
    const int j = add(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, joints.data());
    const int w = add(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32, weights.data());
    for (int y = 0; y + 1 < kSide; ++y) {
      for (int x = 0; x + 1 < kSide; ++x) {
        const auto at = [](int i) { return draco::PointIndex(static_cast<std::uint32_t>(i)); };
        const int a = y * kSide + x;
        mesh.AddFace({at(a), at(a + 1), at(a + kSide)});
        mesh.AddFace({at(a + 1), at(a + kSide + 1), at(a + kSide)});
      }
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method);
    encoder.SetAttributeQuantization(p, 14);
    encoder.SetAttributeQuantization(w, 8);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
    refer(Bytes(buffer.data(), buffer.data() + buffer.size()), p, j, w);
  }

  int add(draco::GeometryAttribute::Type kind, std::int8_t components, draco::DataType type, const void* values) {
    const int size = draco::DataTypeLength(type) * components;
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, components, type, false, size, 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
      mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), static_cast<const std::uint8_t*>(values) +
                                                                               i * static_cast<std::uint32_t>(size));
    }
    return id;
  }

  void refer(const Bytes& encoded, int p, int j, int w) {
    model.view<float>({1, 2, 3});
    const Index view = model.view(encoded);
    const int points = kSide * kSide;
    model.push("accessors", {{"componentType", 5123}, {"count", 6 * 11 * 11}, {"type", "SCALAR"}});
    model.push(
        "accessors",
        {{"componentType", 5126}, {"count", points}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {11.5, 11.5, 1}}});
    model.push("accessors", {{"componentType", 5121}, {"count", points}, {"type", "VEC4"}});
    model.push("accessors", {{"componentType", 5126}, {"count", points}, {"type", "VEC4"}});
    model.push("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "SCALAR"}});
    const Json extension = {{"bufferView", view}, {"attributes", {{"POSITION", p}, {"JOINTS_0", j}, {"WEIGHTS_0", w}}}};
    const Json primitive = {{"attributes", {{"POSITION", 1}, {"JOINTS_0", 2}, {"WEIGHTS_0", 3}}},
                            {"indices", 0},
                            {"extensions", {{kDracoName, extension}}}};
    model.push("meshes", {{"primitives", Json::array({primitive})}});
    model.json["extensionsUsed"] = model.json["extensionsRequired"] = {kDracoName};
  }
};

// Draco puts points in an order of its own: compare triangles, each from its lowest corner on.
std::vector<std::array<std::array<long, 2>, 3>> trianglesOf(const std::vector<float>& positions,
                                                            const std::vector<Index>& indices) {
  std::vector<std::array<std::array<long, 2>, 3>> result;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    std::array<std::array<long, 2>, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const float* at = &positions[3 * indices[i + c]];
      triangle[c] = {std::lround(at[0]), std::lround(at[1])};
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    result.push_back(triangle);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<Index> gridIndices(const draco::Mesh& mesh) {
  std::vector<Index> indices;
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) indices.push_back(point.value());
  }
  return indices;
}

TEST(Draco, DecodesBothMethods) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const DracoModel file(method);
    const Asset asset = readAsset(file.model.glb(), "m.glb");
    const std::vector<float> positions = readFloats(asset, 1), weights = readFloats(asset, 3);
    const std::vector<Index> joints = readIndices(asset, 2);
    EXPECT_EQ(trianglesOf(positions, readIndices(asset, 0)), trianglesOf(file.positions, gridIndices(file.mesh)));
    for (std::size_t v = 0; v < positions.size() / 3; ++v) {
      const float fraction = positions[3 * v] / 11;
      EXPECT_NEAR(positions[3 * v + 2], fraction * fraction, 2e-3);
      EXPECT_EQ(joints[4 * v], 1u);
      EXPECT_NEAR(weights[4 * v], fraction, 1e-2);
      EXPECT_NEAR(weights[4 * v] + weights[4 * v + 1], 1, 1e-6);  // rounded apart by Draco, made whole again
    }
    EXPECT_THAT(readFloats(asset, 4), ElementsAre(1, 2, 3));
    EXPECT_EQ(documentJson(asset).dump().find("draco"), std::string::npos);
    EXPECT_EQ(asset.document.bufferViews.size(), 2u + 3);  // the compressed one's number is reused
    EXPECT_EQ(asset.buffers[0].bytes.size(), 12u + 144 * (12 + 4 + 16) + 726 * 2);
    const std::vector<double>& highest = asset.document.accessors[1].max;
    EXPECT_EQ(static_cast<float>(highest.at(0)), *std::max_element(positions.begin(), positions.end()));  // told anew
    EXPECT_EQ(asset.warnings.items()[0].kind, "decompressed");
  }
}

TEST(Draco, SharedDataAreDecodedOnce) {
  DracoModel file(draco::MESH_EDGEBREAKER_ENCODING);
  Json& primitives = file.model.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  const Asset asset = readAsset(file.model.glb(), "m.glb");
  EXPECT_EQ(asset.document.bufferViews.size(), 5u);
  const Json written = documentJson(asset)["meshes"][0]["primitives"];
  EXPECT_EQ(written[0], written[1]);
}

TEST(Draco, PlainFallbackIsTakenAsItIs) {
  GltfBuilder model = testing::everythingModel();
  const Index view = model.view<std::uint8_t>({1, 2, 3});
  model.json["meshes"][0]["primitives"][0]["extensions"][kDracoName] = {{"bufferView", view},
                                                                        {"attributes", {{"POSITION", 0}}}};
  model.json["extensionsUsed"] = {kDracoName};
  const Asset asset = readAsset(model.glb(), "m.glb");
  EXPECT_EQ(readFloats(asset, 0).size(), 12u);
  EXPECT_FALSE(asset.document.meshes[0].primitives[0].extensions.exists());
}

TEST(Draco, WhatTheAccessorsDoNotPromiseIsAnError) {
  const auto codeOf = [](const DracoModel& file) {
    try {
      readAsset(file.model.glb(), "m.glb");
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::kCancelled;
  };
  const std::pair<const char*, Json> kChanges[] = {
      {"/accessors/0/count", 3},
      {"/accessors/1/count", 143},
      {"/accessors/1/count", 4000000000u},
      {"/accessors/0/count", 3000000000u},
      {"/accessors/3/count", 100},
      {"/accessors/1/type", "VEC2"},
      {"/accessors/0/type", "VEC2"},
      {"/accessors/0/componentType", 5126},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", 9},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", -1},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 7},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 0}};
  for (const auto& [pointer, value] : kChanges) {
    DracoModel file(draco::MESH_EDGEBREAKER_ENCODING);
    file.model.json[Json::json_pointer(pointer)] = value;
    EXPECT_EQ(codeOf(file), ErrorCode::kBadData) << pointer << " " << value;
  }
}

TEST(Draco, BrokenDataAreErrorsOrMeshes) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const DracoModel file(method);
    const std::size_t begin = file.model.json["bufferViews"][1]["byteOffset"].get<std::size_t>();
    int errors = 0;
    for (std::size_t at = begin; at < file.model.binary.size(); ++at) {
      GltfBuilder broken = file.model;
      broken.binary[at] ^= 0x55;
      try {
        checkAsset(readAsset(broken.glb(), "m.glb"));
      } catch (const Error& error) {
        EXPECT_NE(error.code(), ErrorCode::kFile);
        ++errors;
      }
    }
    EXPECT_GT(errors, 0);
  }
}

}  // namespace
}  // namespace limber

#endif
