#include "limber/document/gltf/references.h"

#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/gltf_json.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

// Every kind of reference that limber knows; all numbers differ, so that none is mistaken for another.
const char* const kEverything = R"({
  "asset": {"version": "2.0"},
  "extensions": {"KHR_lights_punctual": {"lights": [{}, {}]}},
  "scenes": [{"nodes": [1, 2]}],
  "nodes": [{"mesh": 3, "skin": 4, "camera": 5, "children": [6],
             "extensions": {"KHR_lights_punctual": {"light": 7},
                            "MSFT_lod": {"ids": [8, 9]},
                            "VRMC_node_constraint": {"constraint": {"roll": {"source": 10, "weight": 99}}},
                            "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 11}}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 12}, "indices": 13, "material": 14,
                              "targets": [{"NORMAL": 15}],
                              "extensions": {"KHR_draco_mesh_compression": {"bufferView": 16,
                                                                            "attributes": {"POSITION": 99}},
                                             "KHR_materials_variants": {"mappings": [{"material": 17,
                                                                                      "variants": [18]}]}}}]}],
  "skins": [{"joints": [19], "skeleton": 20, "inverseBindMatrices": 21}],
  "animations": [{"samplers": [{"input": 22, "output": 23}],
                  "channels": [{"sampler": 0, "target": {"node": 24}},
                               {"sampler": 0, "target": {"extensions": {
                                   "KHR_animation_pointer": {"pointer": "/materials/25/emissiveFactor"}}}}]}],
  "materials": [{"normalTexture": {"index": 26}, "occlusionTexture": {"index": 27}, "emissiveTexture": {"index": 28},
                 "pbrMetallicRoughness": {"baseColorTexture": {"index": 29}, "metallicRoughnessTexture": {"index": 30}},
                 "extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 31}, "factor": 99}}}],
  "textures": [{"sampler": 32, "source": 33, "extensions": {"EXT_texture_webp": {"source": 34}}}],
  "images": [{"bufferView": 35}],
  "accessors": [{"bufferView": 36, "componentType": 5126, "count": 1, "type": "SCALAR",
                 "sparse": {"count": 1, "indices": {"bufferView": 37, "componentType": 5121},
                            "values": {"bufferView": 38}}}],
  "bufferViews": [{"buffer": 39, "byteLength": 1,
                   "extensions": {"EXT_meshopt_compression": {"buffer": 40, "byteLength": 99},
                                  "ACME_table": {"columns": [{"bufferView": 41}]}}}]})";

gltf::Document everyReference() {
  return gltf::documentOf(Json::parse(kEverything));
}

std::map<ElementKind, std::multiset<Index>> referencesOf(const gltf::Document& document) {
  std::map<ElementKind, std::multiset<Index>> found;
  visitReferences(document, [&](ElementKind kind, Index number) { found[kind].insert(number); });
  return found;
}

TEST(References, AllAreFoundOnceUnderTheirKind) {
  const auto found = referencesOf(everyReference());
  EXPECT_THAT(found.at(ElementKind::kNode), UnorderedElementsAre(1, 2, 6, 8, 9, 10, 19, 20, 24));
  EXPECT_THAT(found.at(ElementKind::kMesh), ElementsAre(3));
  EXPECT_THAT(found.at(ElementKind::kSkin), ElementsAre(4));
  EXPECT_THAT(found.at(ElementKind::kCamera), ElementsAre(5));
  EXPECT_THAT(found.at(ElementKind::kLight), ElementsAre(7));
  EXPECT_THAT(found.at(ElementKind::kAccessor), UnorderedElementsAre(11, 12, 13, 15, 21, 22, 23));
  EXPECT_THAT(found.at(ElementKind::kMaterial), UnorderedElementsAre(14, 17, 25));
  EXPECT_THAT(found.at(ElementKind::kVariant), ElementsAre(18));
  EXPECT_THAT(found.at(ElementKind::kTexture), UnorderedElementsAre(26, 27, 28, 29, 30, 31));
  EXPECT_THAT(found.at(ElementKind::kSampler), ElementsAre(32));
  EXPECT_THAT(found.at(ElementKind::kImage), UnorderedElementsAre(33, 34));
  EXPECT_THAT(found.at(ElementKind::kBufferView), UnorderedElementsAre(16, 35, 36, 37, 38, 41));
  EXPECT_THAT(found.at(ElementKind::kBuffer), UnorderedElementsAre(39, 40));
}

TEST(References, VisitingChangesNothing) {
  const gltf::Document document = everyReference();
  referencesOf(document);
  EXPECT_EQ(gltf::jsonOf(document).dump(), Json::parse(kEverything).dump());
}

TEST(References, AllAreChangedWhereTheyStand) {
  gltf::Document document = everyReference();
  const gltf::Document copy = document;
  changeReferences(document, [](ElementKind, Index& number) { number += 100; });
  const auto before = referencesOf(copy);
  for (const auto& [kind, numbers] : referencesOf(document)) {
    std::multiset<Index> back;
    for (const Index number : numbers) back.insert(number - 100);
    EXPECT_EQ(back, before.at(kind));
  }
  // What is no reference stays: 99 everywhere, counts and lengths.
  std::string text = gltf::jsonOf(document).dump();
  EXPECT_NE(text.find("\"weight\":99"), std::string::npos);
  EXPECT_NE(text.find("\"POSITION\":99"), std::string::npos);
  EXPECT_NE(text.find("\"pointer\":\"/materials/125/emissiveFactor\""), std::string::npos);
  EXPECT_EQ(gltf::jsonOf(copy).dump(), Json::parse(kEverything).dump());  // which shares the extensions' JSON
}

TEST(References, NumbersTakenOutLeaveListsAndMembers) {
  gltf::Document document = everyReference();
  changeReferences(document, [](ElementKind kind, Index& number) {
    if (kind == ElementKind::kNode && number != 2 && number != 24) number = kNoIndex;
  });
  EXPECT_THAT(document.scenes[0].nodes, ElementsAre(2));
  EXPECT_TRUE(document.nodes[0].children.empty());
  EXPECT_FALSE(document.skins[0].skeleton);
  EXPECT_FALSE(document.nodes[0].extensions->contains("MSFT_lod"));  // which would say nothing
  EXPECT_FALSE(document.nodes[0].extensions->contains("VRMC_node_constraint"));
}

TEST(References, PointersIntoListsOfTheDocumentAlone) {
  gltf::Document document;
  gltf::AnimationChannel& channel = document.animations.emplace_back().channels.emplace_back();
  const auto changed = [&](const char* pointer) {
    setAnimationPointer(channel.target, pointer);
    changeReferences(document, [](ElementKind, Index& number) { number += 10; });
    return *animationPointer(channel.target);
  };
  EXPECT_EQ(changed("/nodes/3/scale"), "/nodes/13/scale");
  EXPECT_EQ(changed("/extensions/KHR_lights_punctual/lights/0/color"),
            "/extensions/KHR_lights_punctual/lights/10/color");
  for (const char* other : {"/extensions/ACME_graph/nodes/3/value", "/nodes/", "/nodes/x", "/nodes/4294967295",
                            "nodes/3", "/nodes/99999999999999999999/scale", ""}) {
    EXPECT_EQ(changed(other), other);
  }
}

TEST(References, OfWhatIsNoNumberNothingIsMade) {
  for (const char* content : {"3", "[]", "null", R"({"ids": 3})", R"({"ids": [1, "x", -1, 1e300]})"}) {
    gltf::Document document;
    changeExtension(document.nodes.emplace_back(), "MSFT_lod") = Json::parse(content);
    EXPECT_NO_THROW(changeReferences(document, [](ElementKind, Index& number) { number = 0; })) << content;
  }
}

TEST(References, ListsOfADocumentAreCounted) {
  const gltf::Document document = everyReference();
  EXPECT_EQ(elementCount(document, ElementKind::kNode), 1u);
  EXPECT_EQ(elementCount(document, ElementKind::kLight), 2u);
  EXPECT_EQ(elementCount(document, ElementKind::kVariant), 0u);
}

TEST(References, EveryObjectIsSeen) {
  gltf::Document document = everyReference();
  std::size_t objects = 0;
  forEachObject(document, [&](gltf::Object& object) {
    ++objects;
    object.extensions.reset();
  });
  EXPECT_EQ(gltf::jsonOf(document).dump().find("extensions"), std::string::npos);
  EXPECT_EQ(objects, 27u);
}

// Nodes 0 to 3 become none, 5, none, 7.
TEST(References, VrmsKeepTheirNodesAndLoseWhatIsGone) {
  gltf::Document document;
  document.extensions.change() = Json::parse(R"({
    "VRMC_vrm": {"meta": {"name": "a"}, "humanoid": {"humanBones": {"hips": {"node": 1}, "head": {"node": 0}}},
                 "firstPerson": {"meshAnnotations": [{"node": 2, "type": "both"}, {"node": 3, "type": "auto"}]},
                 "expressions": {"preset": {"happy": {"morphTargetBinds": [{"node": 1, "index": 2, "weight": 1}, {"node": 0}]}},
                                 "custom": {"wink": {"morphTargetBinds": [{"node": 3}]}}}},
    "VRM": {"meta": {"texture": 1}, "humanoid": {"humanBones": [{"bone": "hips", "node": 1}, {"bone": "head", "node": 2}]},
            "firstPerson": {"firstPersonBone": 0},
            "secondaryAnimation": {"boneGroups": [{"bones": [0, 1, 3], "center": -1}],
                                   "colliderGroups": [{"node": 0}, {"node": 3}]}},
    "VRMC_vrm_animation": {"humanoid": {"humanBones": {"hips": {"node": 3}, "head": {"node": 0}}},
                           "expressions": {"preset": {"aa": {"node": 1}, "oh": {"node": 2}}}, "lookAt": {"node": 0}}
  })");
  EXPECT_TRUE(renumberDocumentExtensions(document, {kNoIndex, 5, kNoIndex, 7}));
  const Json expected = Json::parse(R"({
    "VRMC_vrm": {"meta": {"name": "a"}, "humanoid": {"humanBones": {"hips": {"node": 5}}},
                 "firstPerson": {"meshAnnotations": [{"node": 7, "type": "auto"}]},
                 "expressions": {"preset": {"happy": {"morphTargetBinds": [{"node": 5, "index": 2, "weight": 1}]}},
                                 "custom": {"wink": {"morphTargetBinds": [{"node": 7}]}}}},
    "VRM": {"meta": {"texture": 1}, "humanoid": {"humanBones": [{"bone": "hips", "node": 5}]},
            "firstPerson": {"firstPersonBone": -1},
            "secondaryAnimation": {"boneGroups": [{"bones": [5, 7], "center": -1}],
                                   "colliderGroups": [{"node": -1}, {"node": 7}]}},
    "VRMC_vrm_animation": {"humanoid": {"humanBones": {"hips": {"node": 7}}},
                           "expressions": {"preset": {"aa": {"node": 5}}}}
  })");
  EXPECT_EQ(document.extensions->dump(), expected.dump());

  moveVrmMesh(document, 7, 9);
  const Json& vrm = document.extensions->at("VRMC_vrm");
  EXPECT_EQ(vrm["firstPerson"]["meshAnnotations"][0]["node"], 9);
  EXPECT_EQ(vrm["expressions"]["custom"]["wink"]["morphTargetBinds"][0]["node"], 9);
  EXPECT_EQ(vrm["humanoid"]["humanBones"]["hips"]["node"], 5);
}

}  // namespace
}  // namespace limber
