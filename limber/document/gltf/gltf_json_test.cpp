#include "limber/document/gltf/gltf_json.h"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/file/file.h"
#include "limber/core/text/names.h"
#include "limber/document/asset.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/testing/gltf_builder.h"
#include "shared_data.h"

namespace limber::gltf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Json parsed(std::string_view text) {
  Warnings warnings;
  return parseJson(text, warnings);
}

std::string textOf(const Json& json) {
  return dumpJson(json, 1);
}

// As read and written without a change.
std::string again(const Json& json) {
  return textOf(jsonOf(documentOf(json)));
}

// One of everything, with numbers, orders of keys, unknown members and defaults as files may have them.
constexpr const char* kEverything = R"({
  "nodes": [
    {"children": [1, 2.0], "name": "root", "translation": [0, 1.5, -0.0], "unknown": {"b": 1, "a": [null, 1e-3]}},
    {"scale": [1, 1, 1], "rotation": [0, 0, 0.0, 1], "name": "", "extras": null},
    {"skin": 0.0, "mesh": 0, "extras": {"big": 9007199254740993, "node": 0}, "weights": [0, 1.0, 2.5e-1], "camera": 0},
    {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e2, 0.1, 3, 1.0], "extensions": {"EXT_a": {"z": 1, "y": []}}},
    {"children": [], "extensions": {}, "extras": {}}
  ],
  "scene": 0,
  "asset": {"minVersion": "2.0", "copyright": "\u00a9 nobody", "version": "2.0", "generator": "by hand", "extras": [1]},
  "extensionsRequired": [],
  "extensionsUsed": ["EXT_a", "EXT_b"],
  "meshes": [
    {"primitives": [
      {"mode": 4, "targets": [{"POSITION": 1.0, "NORMAL": 1}, {}], "material": 0, "indices": 2,
       "attributes": {"_OWN": 1, "POSITION": 0, "JOINTS_0": 3}, "extensions": {"EXT_b": null}},
      {"attributes": {}, "mode": 1}
     ], "weights": [0, 0.5], "extras": {"targetNames": ["a", "b"]}}
  ],
  "skins": [{"joints": [0, 1.0], "inverseBindMatrices": 4, "skeleton": 0, "unknown": false}],
  "animations": [
    {"samplers": [{"output": 1, "input": 0, "interpolation": "LINEAR"}, {"input": 0, "output": 1, "interpolation": "STEP"},
                  {"input": 0, "output": 1, "interpolation": "CUBICSPLINE"},
                  {"input": 0, "output": 1, "interpolation": "SPLINE"}],
     "channels": [{"target": {"path": "rotation", "node": 1.0, "extras": 3}, "sampler": 0},
                  {"sampler": 1, "target": {"extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/scale"}},
                                            "path": "pointer"}, "unknown": "x"}], "name": "turn"},
    {"channels": [], "samplers": []}
  ],
  "materials": [
    {"doubleSided": false, "alphaCutoff": 0.5, "alphaMode": "OPAQUE", "emissiveFactor": [0, 0, 0], "name": "red",
     "emissiveTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 1]}}},
     "occlusionTexture": {"strength": 1, "index": 0.0}, "normalTexture": {"scale": 2, "index": 0, "texCoord": 1},
     "pbrMetallicRoughness": {"roughnessFactor": 1, "metallicFactor": 1.0, "baseColorFactor": [1, 1, 1, 1],
                              "metallicRoughnessTexture": {"index": 0}, "baseColorTexture": {"index": 0},
                              "unknown": {}}},
    {"pbrMetallicRoughness": {}}, {}
  ],
  "textures": [{"source": 0, "sampler": 0.0, "extensions": {"EXT_texture_webp": {"source": 1}}}, {}],
  "images": [{"mimeType": "image/png", "bufferView": 0}, {"uri": "a%20b.png", "name": "b"},
             {"uri": "data:image/png;base64,AAAA"}, {"uri": ""}],
  "samplers": [{"wrapS": 10497, "magFilter": 9729, "name": "s"}, {}],
  "cameras": [{"perspective": {"znear": 0.1, "yfov": 1}, "type": "perspective"}],
  "accessors": [
    {"type": "VEC3", "byteOffset": 0, "normalized": false, "bufferView": 0, "max": [1, 2, 3.0], "min": [-1, 0, 1e-3],
     "count": 4, "componentType": 5126},
    {"componentType": 5121.0, "count": 4.0, "type": "SCALAR", "normalized": true, "min": [0], "max": [255], "name": "n"},
    {"componentType": 5125, "count": 6, "type": "MAT4", "min": [],
     "sparse": {"values": {"byteOffset": 0, "bufferView": 0, "extras": 1}, "count": 2, "unknown": 1,
                "indices": {"componentType": 5123, "byteOffset": 4, "bufferView": 1, "extensions": {"EXT_a": {}}}}},
    {"componentType": 5120, "count": 1, "type": "VEC2"}, {"componentType": 5122, "count": 1, "type": "VEC4"},
    {"componentType": 5123, "count": 1, "type": "MAT2"}, {"componentType": 5126, "count": 1, "type": "MAT3"}
  ],
  "bufferViews": [{"byteStride": 12, "target": 34962, "byteLength": 48, "byteOffset": 0, "buffer": 0},
                  {"buffer": 0.0, "byteLength": 4, "byteOffset": 48.0, "name": ""}],
  "buffers": [{"uri": "data:;base64,", "byteLength": 52}, {"byteLength": 0, "uri": "a.bin", "extras": "x"}],
  "scenes": [{"nodes": [0], "name": "first", "extensions": {"EXT_a": {"nodes": [1]}}}, {"nodes": []}, {}],
  "extensions": {"EXT_b": {"list": [1, {"x": 1.0}]}, "EXT_a": {}},
  "unknown": [{"nodes": [0]}],
  "extras": "all"
})";

// Lets edit(Json&) change each object of a document that may have members of any name.
void forEachObject(Json& json, const std::function<void(Json&)>& edit, const std::string& key = {}) {
  if (key == "extensions" || key == "extras" || key == "unknown" || key == "targets") return;
  for (const auto& [name, inner] : json.items()) {
    if (inner.is_structured() && name != "attributes") forEachObject(inner, edit, json.is_object() ? name : key);
  }
  if (json.is_object()) edit(json);
}

void forEachNumber(Json& json, const std::function<void(Json&)>& edit) {
  if (json.is_number()) edit(json);
  if (!json.is_structured()) return;
  for (Json& inner : json) forEachNumber(inner, edit);
}

TEST(GltfJson, ADocumentThatWasNotChangedComesBackToTheByte) {
  const Json json = parsed(kEverything);
  EXPECT_EQ(again(json), textOf(json));
  const Json made = testing::everythingModel().json;
  EXPECT_EQ(again(made), textOf(made));
  EXPECT_EQ(again(parsed(R"({"asset":{"version":"2.0"}})")), textOf(parsed(R"({"asset":{"version":"2.0"}})")));
}

TEST(GltfJson, WhatIsWrittenIsReadTheSame) {
  const Json once = jsonOf(documentOf(parsed(kEverything)));
  EXPECT_EQ(again(once), textOf(once));
}

TEST(GltfJson, TheOrderOfKeysStays) {
  Json json = parsed(kEverything);
  forEachObject(json, [](Json& object) {
    Json turned = Json::object();
    for (auto member = object.rbegin(); member != object.rend(); ++member) turned[member.key()] = member.value();
    object = std::move(turned);
  });
  EXPECT_EQ(again(json), textOf(json));
}

TEST(GltfJson, WhatLimberDoesNotKnowStaysAtEveryLevel) {
  Json json = parsed(kEverything);
  std::size_t objects = 0;
  forEachObject(json, [&](Json& object) {
    object["neverHeardOf"] = {{"number", 1e-3}, {"list", {1, 2.0, nullptr}}};
    object["extensions"] = {{"EXT_never_heard_of", {{"index", 77.0}}}};
    object["extras"] = {nullptr, "x", {{"y", -0.0}}};
    ++objects;
  });
  EXPECT_GT(objects, 50u);
  EXPECT_EQ(again(json), textOf(json));
  forEachObject(json, [](Json& object) { object["extras"] = nullptr; });
  EXPECT_EQ(again(json), textOf(json));
}

TEST(GltfJson, TheFormOfNumbersStays) {
  Json json = parsed(kEverything);
  forEachNumber(json, [](Json& number) { number = number.get<double>(); });
  EXPECT_EQ(again(json), textOf(json));
  forEachNumber(json, [](Json& number) {
    const auto whole = static_cast<std::int64_t>(number.get<double>());
    if (static_cast<double>(whole) == number.get<double>()) number = whole;
  });
  EXPECT_EQ(again(json), textOf(json));
}

TEST(GltfJson, MembersHaveTheirValues) {
  const Document document = documentOf(parsed(kEverything));
  EXPECT_EQ(document.about.generator, "by hand");
  EXPECT_EQ(document.scene, 0u);
  EXPECT_THAT(document.extensionsUsed, ElementsAre("EXT_a", "EXT_b"));
  const Node& root = document.nodes[0];
  EXPECT_EQ(root.name, "root");
  EXPECT_THAT(root.children, ElementsAre(1, 2));
  EXPECT_EQ(root.translation, Vec3(0, 1.5, 0));
  EXPECT_FALSE(root.mesh || root.skin || root.camera || root.matrix || root.rotation || root.scale);
  EXPECT_EQ(document.nodes[1].rotation, Vec4(0, 0, 0, 1));
  EXPECT_EQ(document.nodes[2].skin, 0u);
  EXPECT_THAT(document.nodes[2].weights, ElementsAre(0, 1, 0.25));
  EXPECT_EQ(document.nodes[2].extras->at("big").get<std::uint64_t>(), 9007199254740993u);
  EXPECT_EQ(document.nodes[3].matrix.value()(0, 3), 100);  // column by column
  EXPECT_TRUE(document.nodes[1].extras.exists());
  EXPECT_FALSE(document.nodes[0].extras.exists());

  const Primitive& primitive = document.meshes[0].primitives[0];
  EXPECT_EQ(primitive.mode, kTriangles);
  EXPECT_EQ(primitive.attributes.begin()->first, "_OWN");
  EXPECT_EQ(primitive.attributes.find("JOINTS_0"), 3u);
  ASSERT_EQ(primitive.targets.size(), 2u);
  EXPECT_EQ(primitive.targets[0].find("POSITION"), 1u);
  EXPECT_EQ(document.meshes[0].primitives[1].mode, 1u);
  EXPECT_FALSE(document.meshes[0].primitives[1].indices);

  const Animation& turn = document.animations[0];
  EXPECT_EQ(turn.samplers[1].interpolation, Interpolation::kStep);
  EXPECT_EQ(turn.samplers[2].interpolation, Interpolation::kCubic);
  EXPECT_EQ(turn.samplers[3].interpolation, Interpolation::kLinear);  // of a name that does not exist
  EXPECT_EQ(turn.channels[0].target.node, 1u);
  EXPECT_EQ(turn.channels[1].target.path, "pointer");

  const Material& red = document.materials[0];
  EXPECT_EQ(red.normalTexture.value().texCoord, 1u);
  EXPECT_EQ(red.pbrMetallicRoughness.value().baseColorTexture.value().index, 0u);
  EXPECT_TRUE(document.materials[1].pbrMetallicRoughness);
  EXPECT_FALSE(document.materials[2].pbrMetallicRoughness);

  const Accessor& sparse = document.accessors[2];
  EXPECT_EQ(sparse.type, ElementType::kMat4);
  EXPECT_FALSE(sparse.bufferView);
  EXPECT_EQ(sparse.sparse.value().indices.byteOffset, 4u);
  EXPECT_EQ(sparse.sparse.value().indices.componentType, ComponentType::kU16);
  EXPECT_TRUE(document.accessors[1].normalized);
  EXPECT_THAT(document.accessors[0].min, ElementsAre(-1, 0, 0.001));
  EXPECT_EQ(document.bufferViews[0].target, kVertexTarget);
  EXPECT_EQ(document.images[2].uri, "data:image/png;base64,AAAA");
  EXPECT_EQ(document.buffers[0].byteLength, 52u);
}

struct Change {
  const char* location;  // of the only member that is another one then
  const char* value;     // empty: it leaves
  void (*edit)(Document& document);
};

void expectOnly(const Json& before, const Change& change) {
  Document document = documentOf(before);
  change.edit(document);
  Json expected = before;
  const Json::json_pointer location(change.location);
  if (*change.value != '\0') {
    expected[location] = parsed(change.value);
  } else {
    expected[location.parent_pointer()].erase(location.back());
  }
  EXPECT_EQ(textOf(jsonOf(document)), textOf(expected)) << change.location;
}

TEST(GltfJson, AChangedMemberChangesNothingElse) {
  const Change kChanges[] = {
      {"/scene", "1", [](Document& d) { d.scene = 1; }},
      {"/asset/generator", "\"limber\"", [](Document& d) { d.about.generator = "limber"; }},
      {"/extensionsUsed", R"(["EXT_b"])", [](Document& d) { d.extensionsUsed.erase(d.extensionsUsed.begin()); }},
      {"/nodes/0/name", "\"top\"", [](Document& d) { d.nodes[0].name = "top"; }},
      {"/nodes/0/children", "[1,2,3]", [](Document& d) { d.nodes[0].children.push_back(3); }},
      {"/nodes/0/translation", "[0.0,2.5,0.0]", [](Document& d) { d.nodes[0].translation = Vec3(0, 2.5, 0); }},
      {"/nodes/1/name", "\"tip\"", [](Document& d) { d.nodes[1].name = "tip"; }},
      {"/nodes/1/extras", R"({"a":1})",
       [](Document& d) {
         d.nodes[1].extras = KeptJson(Json({{"a", 1}}));
       }},
      {"/nodes/3/extensions/EXT_a/z", "2", [](Document& d) { d.nodes[3].extensions.change()["EXT_a"]["z"] = 2; }},
      {"/meshes/0/primitives/0/attributes", R"({"_OWN":1,"POSITION":5,"JOINTS_0":3})",
       [](Document& d) { d.meshes[0].primitives[0].attributes.set("POSITION", 5); }},
      {"/meshes/0/primitives/0/indices", "3", [](Document& d) { d.meshes[0].primitives[0].indices = 3; }},
      {"/meshes/0/primitives/0/mode", "5", [](Document& d) { d.meshes[0].primitives[0].mode = kTriangleStrip; }},
      {"/skins/0/joints", "[1,0]",
       [](Document& d) {
         d.skins[0].joints = {1, 0};
       }},
      {"/animations/0/samplers/3/interpolation", "\"STEP\"",
       [](Document& d) { d.animations[0].samplers[3].interpolation = Interpolation::kStep; }},
      {"/animations/0/channels/0/target/node", "2", [](Document& d) { d.animations[0].channels[0].target.node = 2; }},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1.0,0.5,0.0,1.0]",
       [](Document& d) { d.materials[0].pbrMetallicRoughness->baseColorFactor = Vec4(1, 0.5, 0, 1); }},
      {"/materials/0/alphaMode", "\"BLEND\"", [](Document& d) { d.materials[0].alphaMode = "BLEND"; }},
      {"/materials/0/doubleSided", "true", [](Document& d) { d.materials[0].doubleSided = true; }},
      {"/materials/0/emissiveTexture/index", "1", [](Document& d) { d.materials[0].emissiveTexture->index = 1; }},
      {"/accessors/0/max", "[1.0,2.0,4.5]",
       [](Document& d) {
         d.accessors[0].max = {1, 2, 4.5};
       }},
      {"/accessors/1/max", "[254]", [](Document& d) { d.accessors[1].max = {254}; }},
      {"/accessors/1/componentType", "5123", [](Document& d) { d.accessors[1].componentType = ComponentType::kU16; }},
      {"/accessors/2/type", "\"VEC2\"", [](Document& d) { d.accessors[2].type = ElementType::kVec2; }},
      {"/accessors/2/sparse/values/byteOffset", "8", [](Document& d) { d.accessors[2].sparse->values.byteOffset = 8; }},
      {"/bufferViews/0/byteOffset", "4", [](Document& d) { d.bufferViews[0].byteOffset = 4; }},
      {"/buffers/0/byteLength", "60", [](Document& d) { d.buffers[0].byteLength = 60; }},
      {"/buffers/1/uri", "\"b.bin\"", [](Document& d) { d.buffers[1].uri = "b.bin"; }},
      {"/scenes/2/nodes", "[0]", [](Document& d) { d.scenes[2].nodes = {0}; }}};
  for (const Change& change : kChanges) expectOnly(parsed(kEverything), change);
}

// So that a document that was saved and opened in between is written like one that was not.
TEST(GltfJson, ANewMemberStandsWhereANewObjectHasIt) {
  Document made;
  Node& node = made.nodes.emplace_back();
  node.name = "a";
  node.children = {0};
  node.extras = KeptJson(Json(1));
  Document read = documentOf(jsonOf(made));
  for (Document* document : {&made, &read}) {
    document->nodes[0].mesh = 3;
    document->nodes[0].rotation = Vec4(0, 0, 0, 1);
    document->scene = 0;
    document->extensionsUsed = {"A"};
  }
  EXPECT_EQ(jsonOf(read).dump(), jsonOf(made).dump());
}

TEST(GltfJson, WhatBecameTheDefaultOrEmptyLeaves) {
  const Change kChanges[] = {
      {"/scene", "", [](Document& d) { d.scene.reset(); }},
      {"/extensionsUsed", "", [](Document& d) { d.extensionsUsed.clear(); }},
      {"/skins", "", [](Document& d) { d.skins.clear(); }},
      {"/extensions", "", [](Document& d) { d.extensions.reset(); }},
      {"/extras", "", [](Document& d) { d.extras.reset(); }},
      {"/nodes/0/name", "", [](Document& d) { d.nodes[0].name.clear(); }},
      {"/nodes/0/children", "", [](Document& d) { d.nodes[0].children.clear(); }},
      {"/nodes/3/matrix", "", [](Document& d) { d.nodes[3].clearTransform(); }},
      {"/nodes/2/weights", "", [](Document& d) { d.nodes[2].weights.clear(); }},
      {"/nodes/2/mesh", "", [](Document& d) { d.nodes[2].mesh.reset(); }},
      {"/meshes/0/primitives/0/targets", "", [](Document& d) { d.meshes[0].primitives[0].targets.clear(); }},
      {"/meshes/0/primitives/1/mode", "", [](Document& d) { d.meshes[0].primitives[1].mode = kTriangles; }},
      {"/animations/0/samplers/1/interpolation", "",
       [](Document& d) { d.animations[0].samplers[1].interpolation = Interpolation::kLinear; }},
      {"/materials/0/emissiveTexture", "", [](Document& d) { d.materials[0].emissiveTexture.reset(); }},
      {"/materials/0/pbrMetallicRoughness", "", [](Document& d) { d.materials[0].pbrMetallicRoughness.reset(); }},
      {"/materials/0/normalTexture/texCoord", "", [](Document& d) { d.materials[0].normalTexture->texCoord = 0; }},
      {"/accessors/0/bufferView", "", [](Document& d) { d.accessors[0].bufferView.reset(); }},
      {"/accessors/0/min", "", [](Document& d) { d.accessors[0].min.clear(); }},
      {"/accessors/1/normalized", "", [](Document& d) { d.accessors[1].normalized = false; }},
      {"/accessors/2/sparse", "", [](Document& d) { d.accessors[2].sparse.reset(); }},
      {"/bufferViews/0/byteStride", "", [](Document& d) { d.bufferViews[0].byteStride = 0; }},
      {"/bufferViews/0/target", "", [](Document& d) { d.bufferViews[0].target = 0; }},
      {"/bufferViews/1/byteOffset", "", [](Document& d) { d.bufferViews[1].byteOffset = 0; }},
      {"/buffers/1/uri", "", [](Document& d) { d.buffers[1].uri.clear(); }},
      {"/scenes/0/nodes", "", [](Document& d) { d.scenes[0].nodes.clear(); }}};
  for (const Change& change : kChanges) expectOnly(parsed(kEverything), change);
}

TEST(GltfJson, ElementsMoveWithAllThatTheyHave) {
  const Json json = parsed(kEverything);
  Document document = documentOf(json);
  std::swap(document.nodes[0], document.nodes[3]);
  document.nodes.erase(document.nodes.begin() + 1);
  document.materials.push_back(document.materials[0]);
  document.materials.back().name = "blue";
  document.materials.back().extras.change()["x"] = 1;
  Json expected = json;
  Json& nodes = expected["nodes"];
  nodes = Json::array({nodes[3], nodes[2], nodes[0], nodes[4]});
  Json blue = expected["materials"][0];
  blue["name"] = "blue";
  blue["extras"] = {{"x", 1}};
  expected["materials"].push_back(blue);
  EXPECT_EQ(textOf(jsonOf(document)), textOf(expected));
}

TEST(GltfJson, CopiesShareNothingThatChanges) {
  const Document before = documentOf(parsed(kEverything));
  Document copy = before;
  copy.nodes[3].extensions.change()["EXT_a"]["z"] = 5;
  copy.extras.change() = "other";
  copy.nodes[0].name = "other";
  EXPECT_EQ(textOf(jsonOf(before)), textOf(parsed(kEverything)));
}

TEST(GltfJson, ANewDocumentHasWhatGltfAsksForAndNoDefaults) {
  Document document;
  EXPECT_EQ(jsonOf(document).dump(), R"({"asset":{"version":"2.0"}})");
  Node node;
  node.name = "a";
  node.mesh = 0;
  addElement(document.nodes, node);
  addElement(document.nodes, Node());
  Accessor accessor;
  accessor.componentType = ComponentType::kU8;
  accessor.count = 2;
  accessor.min = {0};
  addElement(document.accessors, accessor);
  addElement(document.bufferViews, BufferView());
  Material material;
  material.pbrMetallicRoughness.emplace().metallicFactor = 0;
  addElement(document.materials, material);
  Mesh mesh;
  mesh.primitives.emplace_back().attributes.set("POSITION", 0);
  addElement(document.meshes, mesh);
  EXPECT_EQ(jsonOf(document), parsed(R"({
    "asset": {"version": "2.0"},
    "nodes": [{"name": "a", "mesh": 0}, {}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0}}],
    "accessors": [{"componentType": 5121, "count": 2, "type": "SCALAR", "min": [0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 0}]
  })"));
  EXPECT_EQ(jsonOf(document)["accessors"][0]["min"].dump(), "[0]");
  EXPECT_EQ(jsonOf(document)["accessors"][0]["count"].dump(), "2");
}

// What only drawing needs.
TEST(GltfJson, WrongTypesInToleratedMembersStayUntouched) {
  const std::pair<const char*, const char*> kMembers[] = {{"/asset/generator", "5"},
                                                          {"/bufferViews/0/target", "-1"},
                                                          {"/accessors/0/min", "5"},
                                                          {"/accessors/0/max", "[1,\"x\",3]"},
                                                          {"/accessors/0/max", "[1e300]"},
                                                          {"/meshes/0/weights", "\"x\""},
                                                          {"/nodes/2/weights", "[[]]"},
                                                          {"/materials/0/normalTexture/texCoord", "0.5"},
                                                          {"/materials/0/alphaMode", "2"},
                                                          {"/materials/0/emissiveFactor", "[1,2]"},
                                                          {"/materials/0/alphaCutoff", "\"x\""},
                                                          {"/materials/0/doubleSided", "1"},
                                                          {"/materials/0/pbrMetallicRoughness/metallicFactor", "{}"},
                                                          {"/materials/0/pbrMetallicRoughness/roughnessFactor", "[1]"}};
  for (const auto& [location, wrong] : kMembers) {
    for (const char* value : {wrong, "null", "{\"a\":[1]}", "[null]"}) {
      Json json = parsed(kEverything);
      json[Json::json_pointer(location)] = parsed(value);
      EXPECT_EQ(again(json), textOf(json)) << location << " " << value;
    }
  }
}

TEST(GltfJson, AnyValueAnywhereIsAnErrorOrComesBackToTheByte) {
  const Json json = parsed(kEverything);
  const Json values = parsed(R"([-1, 0, 2.0, 0.5, 5126, 4294967295, 18446744073709551615, 1e300, "", "x", null, true,
                                 [], {}, [0], [[[]]], {"a": null}])");
  std::size_t errors = 0, documents = 0;
  const Json flat = json.flatten();
  for (const auto& [leaf, ignored] : flat.items()) {
    for (Json::json_pointer location(leaf); !location.empty(); location.pop_back()) {
      for (const Json& value : values) {
        Json changed = json;
        changed[location] = value;
        try {
          const Document document = documentOf(changed);
          ++documents;
          EXPECT_EQ(textOf(jsonOf(document)), textOf(changed)) << location << " " << value;
        } catch (const Error& error) {
          ++errors;
          EXPECT_NE(error.where() + error.message(), "");
        }
      }
      if (location.back() != "0") break;  // what it lies in once, by its first element
    }
  }
  EXPECT_GT(errors, 1000u);
  EXPECT_GT(documents, 1000u);
}

TEST(GltfJson, WrongTypesInToleratedMembersGiveWayToNewValues) {
  Json json = parsed(kEverything);
  json["accessors"][0]["min"] = "x";
  json["materials"][0]["alphaMode"] = nullptr;
  Document document = documentOf(json);
  document.accessors[0].min = {1, 2, 3};
  document.materials[0].alphaMode = "MASK";
  json["accessors"][0]["min"] = {1.0, 2.0, 3.0};
  json["materials"][0]["alphaMode"] = "MASK";
  EXPECT_EQ(textOf(jsonOf(document)), textOf(json));
}

Error errorOf(const Json& json) {
  try {
    documentOf(json);
  } catch (const Error& error) {
    return error;
  }
  return Error(ErrorCode::kCancelled, "no error");
}

TEST(GltfJson, ErrorsSayWhere) {
  struct Case {
    const char* location;
    const char* value;  // empty: taken out
    const char* message;
  };
  const Case kCases[] = {
      {"/asset", "5", "must be an object"},
      {"/nodes", "{}", "must be an array"},
      {"/nodes/0", "5", "must be an object"},
      {"/nodes/0/name", "5", "must be a string"},
      {"/nodes/0/name", "null", "must be a string"},
      {"/nodes/0/mesh", "-1", "must be a whole number that is not negative, and is -1"},
      {"/nodes/0/mesh", "0.5", "must be a whole number that is not negative, and is 0.5"},
      {"/nodes/0/mesh", "4294967295", "is 4294967295, but there is no such element"},
      {"/nodes/0/mesh", "[0]", "must be a number"},
      {"/nodes/0/mesh", "null", "must be a number"},
      {"/nodes/0/children", "0", "must be an array"},
      {"/nodes/0/children/1", "\"x\"", "must be a number"},
      {"/nodes/0/translation", "[1,2]", "must have 3 numbers and has 2"},
      {"/nodes/0/translation/1", "1e300", "is too large for a float"},
      {"/nodes/3/matrix", "{}", "must be an array"},
      {"/nodes/0/extensions", "[]", "must be an object"},
      {"/scenes/0/nodes/0", "-1", "must be a whole number that is not negative, and is -1"},
      {"/meshes/0/primitives", "", "is missing"},
      {"/meshes/0/primitives/0/attributes", "", "is missing"},
      {"/meshes/0/primitives/0/attributes", "[]", "must be an object"},
      {"/meshes/0/primitives/0/attributes/POSITION", "true", "must be a number"},
      {"/meshes/0/primitives/0/indices", "\"0\"", "must be a number"},
      {"/meshes/0/primitives/0/targets/0/POSITION", "{}", "must be a number"},
      {"/skins/0/joints", "", "is missing"},
      {"/skins/0/joints/0", "null", "must be a number"},
      {"/animations/0/samplers/0/input", "", "is missing"},
      {"/animations/0/channels/0/sampler", "", "is missing"},
      {"/animations/0/channels/0/target", "", "is missing"},
      {"/animations/0/channels/0/target/node", "-1", "must be a whole number that is not negative, and is -1"},
      {"/animations/0/channels/0/target/path", "1", "must be a string"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "", "is missing"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1,1,1]", "must have 4 numbers and has 3"},
      {"/textures/0/source", "-1", "must be a whole number that is not negative, and is -1"},
      {"/accessors/0/componentType", "5124", "is 5124, which is no component type"},
      {"/accessors/0/componentType", "", "is missing"},
      {"/accessors/0/type", "\"VEC5\"", "is missing or no element type"},
      {"/accessors/0/count", "", "is missing"},
      {"/accessors/0/normalized", "1", "must be true or false"},
      {"/accessors/2/sparse/indices/componentType", "1", "is 1, which is no component type"},
      {"/accessors/2/sparse/values", "", "is missing"},
      {"/bufferViews/0/buffer", "", "is missing"},
      {"/bufferViews/0/byteStride", "-4", "must be a whole number that is not negative, and is -4"},
      {"/buffers/0/byteLength", "1e300", "must be a whole number that is not negative, and is 1e+300"},
      {"/extensionsUsed/0", "5", "must be a string"}};
  for (const Case& wrong : kCases) {
    Json json = parsed(kEverything);
    const Json::json_pointer location(wrong.location);
    if (*wrong.value != '\0') {
      json[location] = parsed(wrong.value);
    } else {
      json[location.parent_pointer()].erase(location.back());
    }
    // "/nodes/0/mesh" -> "nodes[0].mesh".
    std::string path;
    for (Json::json_pointer rest = location; !rest.empty(); rest.pop_back()) {
      const bool isNumber = rest.back().find_first_not_of("0123456789") == std::string::npos;
      path = (isNumber ? "[" + rest.back() + "]" : "." + rest.back()) + path;
    }
    const Error error = errorOf(json);
    EXPECT_EQ(error.code(), ErrorCode::kBadData) << wrong.location;
    EXPECT_EQ(error.where(), path.substr(1));
    EXPECT_EQ(error.message(), wrong.message) << wrong.location;
  }
}

TEST(GltfJson, ObjectsAreBoundedByTheLengthOfTheText) {
  const auto codeOf = [](std::size_t materials, std::size_t scenes, std::size_t textSize) {
    Json json = parsed(R"({"asset": {"version": "2.0"}})");
    json["materials"] = std::vector<Json>(materials, Json::object());
    json["scenes"] = std::vector<Json>(scenes, Json::object());
    try {
      documentOf(std::move(json), textSize);
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), materials > 0 ? "materials" : "scenes");  // which is read first
      return error.code();
    }
    return ErrorCode::kCancelled;
  };
  EXPECT_EQ(codeOf(0, 65536, 0), ErrorCode::kCancelled);
  EXPECT_EQ(codeOf(0, 65537, 0), ErrorCode::kLimit);
  EXPECT_EQ(codeOf(0, 65537, 16), ErrorCode::kCancelled);
  EXPECT_EQ(codeOf(2, 65537, 16), ErrorCode::kLimit);
}

TEST(GltfJson, OtherVersionsAreRefused) {
  for (const char* text : {R"({"asset":{"version":"1.0"}})", R"({"asset":{"version":"2.1","minVersion":"2.1"}})"}) {
    EXPECT_EQ(errorOf(parsed(text)).code(), ErrorCode::kUnsupported) << text;
  }
  EXPECT_EQ(errorOf(parsed(R"({"asset":{}})")).where(), "asset.version");
  EXPECT_THAT(errorOf(parsed("{}")).what(), HasSubstr("is no glTF"));
  EXPECT_THAT(errorOf(parsed("[]")).what(), HasSubstr("must be an object"));
}

TEST(GltfJson, SharedModelsComeBackToTheByte) {
  const std::optional<std::filesystem::path> data = testing::sharedDataFolder();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  std::size_t documents = 0;
  for (const std::filesystem::path& path : testing::modelFiles(*data)) {
    const std::string extension = lowerExtension(path);
    if (extension != ".glb" && extension != ".gltf") continue;
    const Bytes bytes = readFile(path);
    Warnings warnings;
    Json json;
    Document document;
    try {
      const ByteSpan text = extension == ".glb" ? splitGlb(bytes, warnings).json : ByteSpan(bytes);
      json = parseJson({reinterpret_cast<const char*>(text.data()), text.size()}, warnings);
      document = documentOf(json);
    } catch (const Error& error) {
      EXPECT_THAT(path.string(), HasSubstr("broken")) << error.what();
      continue;
    }
    ++documents;
    EXPECT_TRUE(textOf(jsonOf(document)) == textOf(json)) << path;
  }
  EXPECT_GT(documents, 0u);
}

}  // namespace
}  // namespace limber::gltf
