#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/testing/gltf_builder.h"

namespace limber {
namespace {

using testing::everythingModel;
using testing::GltfBuilder;
using ::testing::HasSubstr;

// Where checkAsset finds something wrong once the JSON pointer's value is replaced; empty if nowhere.
std::string faultLocation(const GltfBuilder& model) {
  try {
    readAsset(model.glb(), "m");
  } catch (const Error& error) {
    EXPECT_EQ(error.where().substr(0, 1), "m");
    return error.where().size() > 3 ? error.where().substr(3) : "document";
  }
  return "";
}

std::string faultWith(const char* pointer, const Json& value) {
  GltfBuilder model = everythingModel();
  model.json[Json::json_pointer(pointer)] = value;
  return faultLocation(model);
}

TEST(CheckAsset, AcceptsAGoodModel) {
  EXPECT_EQ(faultLocation(everythingModel()), "");
}

// Each index of the document, set to one beyond the last element.
TEST(CheckAsset, EveryIndexMustBeInRange) {
  const std::pair<const char*, const char*> kIndices[] = {
      {"/scene", "scene"},
      {"/scenes/0/nodes/1", "scenes[0].nodes[1]"},
      {"/nodes/0/children/1", "nodes[0].children[1]"},
      {"/nodes/2/mesh", "nodes[2].mesh"},
      {"/nodes/2/skin", "nodes[2].skin"},
      {"/nodes/3/camera", "nodes[3].camera"},
      {"/meshes/0/primitives/0/attributes/NORMAL", "meshes[0].primitives[0].attributes.NORMAL"},
      {"/meshes/0/primitives/0/indices", "meshes[0].primitives[0].indices"},
      {"/meshes/0/primitives/0/material", "meshes[0].primitives[0].material"},
      {"/meshes/0/primitives/0/mode", "meshes[0].primitives[0].mode"},
      {"/meshes/0/primitives/0/targets/0/POSITION", "meshes[0].primitives[0].targets[0].POSITION"},
      {"/skins/0/joints/1", "skins[0].joints[1]"},
      {"/skins/0/skeleton", "skins[0].skeleton"},
      {"/skins/0/inverseBindMatrices", "skins[0].inverseBindMatrices"},
      {"/animations/0/samplers/0/input", "animations[0].samplers[0].input"},
      {"/animations/0/samplers/0/output", "animations[0].samplers[0].output"},
      {"/animations/0/channels/0/sampler", "animations[0].channels[0].sampler"},
      {"/animations/0/channels/0/target/node", "animations[0].channels[0].target.node"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index",
       "materials[0].pbrMetallicRoughness.baseColorTexture.index"},
      {"/textures/0/source", "textures[0].source"},
      {"/textures/0/sampler", "textures[0].sampler"},
      {"/images/0/bufferView", "images[0].bufferView"},
      {"/accessors/0/bufferView", "accessors[0].bufferView"},
      {"/accessors/8/sparse/indices/bufferView", "accessors[8].sparse.indices.bufferView"},
      {"/bufferViews/0/buffer", "bufferViews[0].buffer"}};
  for (const auto& [pointer, location] : kIndices) {
    EXPECT_EQ(faultWith(pointer, 100), location);
    EXPECT_EQ(faultWith(pointer, -1), location);
    EXPECT_EQ(faultWith(pointer, 1.5), location);
    EXPECT_EQ(faultWith(pointer, "0"), location);
    EXPECT_EQ(faultWith(pointer, nullptr), location);
    EXPECT_EQ(faultWith(pointer, 18446744073709551615u), location);
  }
}

TEST(CheckAsset, SectionsMustBeArraysOfObjects) {
  for (const char* section : {"accessors", "animations", "bufferViews", "cameras", "images", "materials", "meshes",
                              "nodes", "samplers", "scenes", "skins", "textures"}) {
    const std::string pointer = std::string("/") + section;
    EXPECT_EQ(faultWith(pointer.c_str(), 3), section);
    EXPECT_EQ(faultWith(pointer.c_str(), Json::object()), section);
    EXPECT_EQ(faultWith((pointer + "/0").c_str(), 3), section + std::string("[0]"));
  }
}

TEST(CheckAsset, AccessorsMustLieInTheirViews) {
  EXPECT_EQ(faultWith("/accessors/0/count", 5), "accessors[0]");
  EXPECT_EQ(faultWith("/accessors/0/count", 4294967295u), "accessors[0]");
  EXPECT_EQ(faultWith("/accessors/0/count", 9007199254740991), "accessors[0]");
  EXPECT_EQ(faultWith("/accessors/1/byteOffset", 16), "accessors[1]");
  EXPECT_EQ(faultWith("/accessors/1/byteOffset", 2), "accessors[1]");  // not a multiple of a float's size
  EXPECT_EQ(faultWith("/accessors/0/componentType", 5124), "accessors[0].componentType");
  EXPECT_EQ(faultWith("/accessors/0/type", "VEC5"), "accessors[0].type");
  EXPECT_EQ(faultWith("/accessors/0/normalized", 1), "accessors[0].normalized");
  EXPECT_EQ(faultWith("/bufferViews/0/byteLength", 100000), "bufferViews[0]");
  EXPECT_EQ(faultWith("/bufferViews/0/byteOffset", 9007199254740991), "bufferViews[0]");
  EXPECT_EQ(faultWith("/bufferViews/0/byteStride", 8), "accessors[0]");
  EXPECT_EQ(faultWith("/bufferViews/0/byteStride", 4000000000u), "accessors[0]");
}

TEST(CheckAsset, SparseSubstitutionsMustFit) {
  EXPECT_EQ(faultWith("/accessors/8/sparse/count", 5), "accessors[8].sparse");
  EXPECT_EQ(faultWith("/accessors/8/sparse/count", 3), "accessors[8].sparse.indices");
  EXPECT_EQ(faultWith("/accessors/8/sparse/indices/componentType", 5126), "accessors[8].sparse.indices");
  EXPECT_EQ(faultWith("/accessors/8/count", 3), "accessors[8].sparse.indices");  // index 3 is beyond
  GltfBuilder descending = everythingModel();
  const Index view = descending.view<std::uint8_t>({3, 1});
  descending.json["accessors"][8]["sparse"]["indices"]["bufferView"] = view;
  EXPECT_EQ(faultLocation(descending), "accessors[8].sparse.indices");
}

TEST(CheckAsset, ZerosWithoutDataAreBoundedByTheFile) {
  GltfBuilder model = everythingModel();
  const Index index = model.push("accessors", {{"componentType", 5126}, {"count", 4000000000u}, {"type", "MAT4"}});
  EXPECT_EQ(faultLocation(model), "accessors[" + std::to_string(index) + "]");
  model.json["accessors"][index]["count"] = 4096;
  EXPECT_EQ(faultLocation(model), "");
}

TEST(CheckAsset, NodesFormATree) {
  EXPECT_EQ(faultWith("/nodes/1/children", {0}), "nodes[0]");
  EXPECT_EQ(faultWith("/nodes/0/children", {0}), "nodes[0]");
  EXPECT_EQ(faultWith("/nodes/2/children", {1}), "nodes[2].children[0]");
  EXPECT_EQ(faultWith("/nodes/0/children", {1, 1}), "nodes[0].children[1]");
  EXPECT_EQ(faultWith("/scenes/0/nodes", {0, 1}), "scenes[0].nodes[1]");
  EXPECT_EQ(faultWith("/scenes/0/nodes", {0, 0}), "scenes[0].nodes[1]");
}

TEST(CheckAsset, ALongChainOfNodesIsNoProblem) {
  GltfBuilder model;
  for (int i = 1; i < 20000; ++i) model.push("nodes", {{"children", {i}}});
  model.push("nodes", Json::object());
  EXPECT_EQ(faultLocation(model), "");
}

TEST(CheckAsset, TransformsAreFiniteAndWellFormed) {
  EXPECT_EQ(faultWith("/nodes/0/translation", {0, 1}), "nodes[0].translation");
  EXPECT_EQ(faultWith("/nodes/0/translation/1", "x"), "nodes[0].translation[1]");
  EXPECT_EQ(faultWith("/nodes/0/translation/1", 1e300), "nodes[0].translation[1]");
  EXPECT_EQ(faultWith("/nodes/1/rotation", {0, 0, 0, 0}), "");  // it is repaired
  Asset asset = readAsset(everythingModel().glb(), "m");
  asset.document.nodes[1].rotation = Vec4::Zero();
  EXPECT_THROW(checkAsset(asset), Error);
  EXPECT_EQ(faultWith("/nodes/1/scale", {0, 0, 0}), "");  // flat, but a transform
  EXPECT_EQ(faultWith("/nodes/1/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), "nodes[1]");
  EXPECT_EQ(faultWith("/nodes/3/matrix", {1, 2, 3}), "nodes[3].matrix");
}

TEST(CheckAsset, PrimitivesAreConsistent) {
  EXPECT_EQ(faultWith("/accessors/1/count", 3), "meshes[0].primitives[0].attributes.NORMAL");
  EXPECT_EQ(faultWith("/accessors/8/count", 5), "meshes[0].primitives[0].targets[0].POSITION");
  EXPECT_EQ(faultWith("/meshes/0/primitives/0/attributes/POSITION", 4), "meshes[0].primitives[0].attributes.POSITION");
  EXPECT_EQ(faultWith("/meshes/0/primitives/0/attributes/JOINTS_0", 4), "meshes[0].primitives[0].attributes.JOINTS_0");
  EXPECT_EQ(faultWith("/meshes/0/primitives/0/attributes/WEIGHTS_0", 3),
            "meshes[0].primitives[0].attributes.WEIGHTS_0");
  EXPECT_EQ(faultWith("/meshes/0/primitives/0/indices", 4), "meshes[0].primitives[0].indices");
  EXPECT_EQ(faultWith("/meshes/0/primitives/0/attributes", nullptr), "meshes[0].primitives[0].attributes");
  GltfBuilder beyond = everythingModel();
  beyond.json["meshes"][0]["primitives"][0]["indices"] = beyond.accessor<std::uint16_t>({0, 1, 4}, 5123, "SCALAR", 3);
  EXPECT_EQ(faultLocation(beyond), "meshes[0].primitives[0].indices");
}

// Whether a primitive with this attribute, of four elements, is refused with the attribute's path.
void expectShape(const std::string& name, const char* type, int componentType, bool good, bool target = false) {
  GltfBuilder model = everythingModel();
  const Index accessor = model.accessor(std::vector<float>(16), componentType, type, 4);
  Json& primitive = model.json["meshes"][0]["primitives"][0];
  (target ? primitive["targets"][0] : primitive["attributes"])[name] = accessor;
  const std::string location = target ? "targets[0]." : "attributes.";
  EXPECT_EQ(faultLocation(model), good ? "" : "meshes[0].primitives[0]." + location + name)
      << type << " " << componentType;
}

TEST(CheckAsset, AttributesHaveTheirShapes) {
  for (const char* type : {"SCALAR", "VEC2", "VEC3", "VEC4"}) {
    const std::string shape = type;
    expectShape("NORMAL", type, 5126, shape == "VEC3");
    expectShape("TANGENT", type, 5126, shape == "VEC4");
    expectShape("TEXCOORD_0", type, 5126, shape == "VEC2");
    expectShape("TEXCOORD_1", type, 5126, shape == "VEC2");
    expectShape("COLOR_0", type, 5126, shape == "VEC3" || shape == "VEC4");
    expectShape("_OWN", type, 5126, true);
    for (const char* name : {"POSITION", "NORMAL", "TANGENT"}) expectShape(name, type, 5126, shape == "VEC3", true);
    expectShape("TEXCOORD_0", type, 5126, shape == "VEC2", true);
  }
  expectShape("TEXCOORD_0", "VEC2", 5123, true);  // quantised
  expectShape("TANGENT", "VEC4", 5120, true);
  expectShape("TEXCOORD_0", "VEC2", 5125, false);
}

TEST(CheckAsset, BaseColoursAreFourNumbers) {
  const char* const kPointer = "/materials/0/pbrMetallicRoughness/baseColorFactor";
  const std::string location = "materials[0].pbrMetallicRoughness.baseColorFactor";
  EXPECT_EQ(faultWith(kPointer, {1, 0.5, 0, 1}), "");
  EXPECT_EQ(faultWith(kPointer, {1, 0.5, 0}), location);
  EXPECT_EQ(faultWith(kPointer, {1, 0.5, 0, 1, 1}), location);
  EXPECT_EQ(faultWith(kPointer, "red"), location);
  EXPECT_EQ(faultWith(kPointer, {1, 0.5, 0, "x"}), location + "[3]");
  EXPECT_EQ(faultWith(kPointer, {1, 0.5, 1e300, 1}), location + "[2]");
}

TEST(CheckAsset, GpuInstancesHaveTheirShapes) {
  GltfBuilder good = everythingModel();
  const auto add = [&](const char* type, std::size_t count) {
    return good.accessor(std::vector<float>(4 * count, 1.0f), 5126, type, count);
  };
  const Index vec3 = add("VEC3", 2), vec4 = add("VEC4", 2), longer = add("VEC3", 3);
  Json& attributes = good.json["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", vec3}, {"ROTATION", vec4}, {"SCALE", vec3}, {"_ID", longer}};
  EXPECT_EQ(faultLocation(good), "");

  const std::string instancing = "nodes[3].extensions.EXT_mesh_gpu_instancing.attributes";
  const auto faultOf = [&](const char* name, const Json& value) {
    GltfBuilder changed = good;
    changed.json["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"][name] = value;
    return faultLocation(changed);
  };
  EXPECT_EQ(faultOf("TRANSLATION", vec4), instancing + ".TRANSLATION");
  EXPECT_EQ(faultOf("ROTATION", vec3), instancing + ".ROTATION");
  EXPECT_EQ(faultOf("SCALE", vec4), instancing + ".SCALE");
  EXPECT_EQ(faultOf("_ID", 1000), instancing + "._ID");
  EXPECT_EQ(faultOf("SCALE", "x"), instancing + ".SCALE");
  EXPECT_NE(faultOf("SCALE", longer), "");  // which of the two is named follows from the members' order
  attributes = Json::array({vec3});
  EXPECT_EQ(faultLocation(good), instancing);
}

void setFloat(GltfBuilder& model, Index accessor, std::size_t byte, float value) {
  const std::size_t view = model.json["accessors"][accessor]["bufferView"].get<std::size_t>();
  const std::size_t offset = model.json["bufferViews"][view]["byteOffset"].get<std::size_t>();
  std::memcpy(model.binary.data() + offset + byte, &value, sizeof(value));
}

TEST(CheckAsset, PositionsAndBindMatricesAreFinite) {
  for (const float bad :
       {std::nanf(""), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    GltfBuilder position = everythingModel(), normal = everythingModel(), bind = everythingModel(),
                weight = everythingModel();
    setFloat(position, 0, 3 * 24 + 8, bad);
    EXPECT_EQ(faultLocation(position), "meshes[0].primitives[0].attributes.POSITION");
    setFloat(normal, 0, 3 * 24 + 12, bad);
    EXPECT_EQ(faultLocation(normal), "");
    setFloat(bind, 5, 127 - 3, bad);
    EXPECT_EQ(faultLocation(bind), "skins[0].inverseBindMatrices");
    setFloat(weight, 4, 0, bad);
    EXPECT_EQ(faultLocation(weight), "");  // repaired where weights are used
  }
}

TEST(CheckAsset, SkinsFitTheirMeshes) {
  EXPECT_EQ(faultWith("/skins/0/joints", Json::array()), "skins[0].joints");
  EXPECT_EQ(faultWith("/skins/0/joints", {0, 0}), "skins[0].joints");
  EXPECT_EQ(faultWith("/skins/0/joints", {0, 1, 3}), "skins[0].inverseBindMatrices");
  EXPECT_EQ(faultWith("/skins/0/inverseBindMatrices", 6), "skins[0].inverseBindMatrices");
  EXPECT_EQ(faultWith("/skins/0/joints", {0}), "nodes[2].mesh");  // vertices use joint 1
  GltfBuilder unused = everythingModel();
  unused.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = unused.accessor<std::uint8_t>(
      {0, 0, 99, 0, 0, 1, 0, 0, 0, 1, 0, 77, 1, 0, 0, 0}, 5121, "VEC4", 4);  // 99 and 77 have weight 0
  EXPECT_EQ(faultLocation(unused), "");
}

TEST(CheckAsset, BuffersInMemoryMustMatchTheDocument) {
  Asset asset = readAsset(everythingModel().glb(), "m");
  asset.buffers[0].bytes.pop_back();
  EXPECT_THROW(checkAsset(asset), Error);
  asset.buffers.clear();
  EXPECT_THROW(checkAsset(asset), Error);
}

// What the limit that refuses the file says; empty where it is read.
std::string limitOf(const GltfBuilder& model) {
  try {
    readAsset(model.glb(), "m");
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    return error.what();
  }
}

// Of all its attributes and targets one accessor each, so that the file stays small.
std::string refusalOfShared(std::size_t vertices, std::size_t sets, std::size_t targets) {
  GltfBuilder model;
  const std::vector<float> positions(3 * vertices);
  const std::vector<std::uint8_t> joints(4 * vertices);
  const Index location = model.accessor(positions, 5126, "VEC3", vertices);
  model.json["accessors"][location].update({{"min", Json::array({0, 0, 0})}, {"max", Json::array({0, 0, 0})}});
  const Index joint = model.accessor(joints, 5121, "VEC4", vertices);
  const Index weight = model.accessor(std::vector<float>(4 * vertices), 5126, "VEC4", vertices);
  Json primitive = {{"attributes", {{"POSITION", location}}}};
  for (std::size_t n = 0; n < sets; ++n) {
    primitive["attributes"][fmt::format("JOINTS_{}", n)] = joint;
    primitive["attributes"][fmt::format("WEIGHTS_{}", n)] = weight;
  }
  for (std::size_t t = 0; t < targets; ++t) primitive["targets"].push_back({{"POSITION", location}});
  model.push("meshes", {{"primitives", Json::array({primitive})}});
  model.push("nodes", {{"mesh", 0}});
  return limitOf(model);
}

TEST(CheckAsset, MemoryIsBoundedByWhatTheFileStores) {
  EXPECT_EQ(refusalOfShared(100, 16, 100), "");
  EXPECT_THAT(refusalOfShared(100, 17, 0), HasSubstr("17 sets of weights, more than 16"));
  EXPECT_EQ(refusalOfShared(10000, 0, 1600), "");
  EXPECT_THAT(refusalOfShared(10000, 0, 2000), HasSubstr("MB of vertices, indices and blend shapes"));
}

TEST(CheckAsset, IndicesCountAsOftenAsTheyAreNamed) {
  const auto refusalOf = [](int primitives) -> std::string {
    GltfBuilder model;
    const Index location = model.accessor(std::vector<float>(9), 5126, "VEC3", 3);
    model.json["accessors"][location].update({{"min", Json::array({0, 0, 0})}, {"max", Json::array({0, 0, 0})}});
    const Index indices = model.accessor(std::vector<std::uint8_t>(300'000), 5121, "SCALAR", 300'000);
    const Json primitive = {{"attributes", {{"POSITION", location}}}, {"indices", indices}};
    model.push("meshes", {{"primitives", std::vector<Json>(static_cast<std::size_t>(primitives), primitive)}});
    model.push("nodes", {{"mesh", 0}});
    return limitOf(model);
  };
  EXPECT_EQ(refusalOf(160), "");
  EXPECT_THAT(refusalOf(200), HasSubstr("MB of vertices, indices and blend shapes"));
}

TEST(CheckAsset, EmptyDocumentsAreFine) {
  EXPECT_EQ(faultLocation(GltfBuilder()), "");
  GltfBuilder empty;
  for (const char* section : {"nodes", "meshes", "accessors", "buffers", "scenes"}) empty.json[section] = Json::array();
  EXPECT_EQ(faultLocation(empty), "");
}

}  // namespace
}  // namespace limber
