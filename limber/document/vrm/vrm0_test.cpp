#include "limber/document/vrm/vrm0.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/vrm/t_pose.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/vrm/vrm_write.h"
#include "limber/skeleton/humanoid_bones.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

// A person as VRM 0.x has them: facing -Z, nodes without rotations; a braid of two joints with a side strand, by the
// letter of the specification.
struct OldAvatar {
  Asset asset;
  Json vrm;
  Index braid = 0, strand = 0;
};

OldAvatar oldAvatar() {
  testing::MadeBody body = testing::personWith(testing::NameHabit::kVrm);
  for (Joint& joint : body.skeleton.joints) {
    joint.rest.translation.x() *= -1;
    joint.rest.translation.z() *= -1;
  }
  OldAvatar old;
  old.asset = testing::avatarOf(body.skeleton);
  gltf::Document& document = old.asset.document;
  const auto add = [&](const char* name, Index parent, const Vec3& at) {
    gltf::Node node;
    node.name = name;
    node.translation = at;
    const Index number = addElement(document.nodes, std::move(node));
    document.nodes[parent].children.push_back(number);
    return number;
  };
  const auto nodeOf = [&](const std::string& name) {
    for (Index n = 0; n < document.nodeCount(); ++n) {
      if (document.nodes[n].name == name) return n;
    }
    return kNoIndex;
  };
  const Index head = nodeOf("head");
  old.braid = add("braid", head, {0, 0, 0.1});
  add("braid_2", old.braid, {0, -0.1, 0});
  old.strand = add("strand", old.braid, {0.1, 0, 0});
  document.materials.resize(2);
  document.materials[0].name = "skin";
  document.materials[1].name = "glass";
  testing::nameShapes(old.asset, 0, {"a", "b"});

  Json bones = Json::array();
  for (const std::string_view bone : humanoidBones()) {
    const std::string name(bone);
    if (const Index node = nodeOf(name); node != kNoIndex) bones.push_back({{"bone", name}, {"node", node}});
  }
  // Numbers of nodes will do for thumbs.
  bones.push_back({{"bone", "leftThumbProximal"}, {"node", old.braid}});
  bones.push_back({{"bone", "leftThumbIntermediate"}, {"node", old.strand}});
  const auto vector = [](double x, double y, double z) { return Json{{"x", x}, {"y", y}, {"z", z}}; };
  const Json line = {0, 0, 0, 1, 1, 1, 1, 0};
  old.vrm = {
      {"specVersion", "0.0"},
      {"meta", {{"title", "Old"}, {"author", "Somebody"}, {"texture", -1}}},
      {"humanoid", {{"humanBones", bones}}},
      {"firstPerson",
       {{"firstPersonBone", head},
        {"firstPersonBoneOffset", vector(0.01, 0.06, 0.02)},
        {"meshAnnotations", {{{"mesh", 0}, {"firstPersonFlag", "ThirdPersonOnly"}}}},
        {"lookAtTypeName", "Bone"},
        {"lookAtHorizontalInner", {{"curve", line}, {"xRange", 80}, {"yRange", 8}}},
        {"lookAtVerticalUp", {{"curve", {0, 0, 0, 2, 1, 1, 1, 0}}, {"xRange", 70}, {"yRange", 7}}}}},
      {"blendShapeMaster",
       {{"blendShapeGroups",
         {{{"name", "Joy"},
           {"presetName", "joy"},
           {"isBinary", true},
           {"binds", {{{"mesh", 0}, {"index", 1}, {"weight", 50}}, {{"mesh", 7}, {"index", 0}, {"weight", 1}}}},
           {"materialValues",
            {{{"materialName", "skin"}, {"propertyName", "_Color"}, {"targetValue", {1, 0.5, 0, 1}}},
             {{"materialName", "skin"}, {"propertyName", "_Gloss"}, {"targetValue", {1, 0, 0, 1}}}}}},
          {{"name", "Wink"}, {"presetName", "unknown"}, {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}}}}}},
      {"secondaryAnimation",
       {{"boneGroups",
         {{{"comment", "hair"},
           {"stiffiness", 0.7},
           {"gravityPower", 0.2},
           {"gravityDir", vector(0.6, -0.8, 0)},
           {"dragForce", 0.4},
           {"center", -1},
           {"hitRadius", 0.02},
           {"bones", {old.braid}},
           {"colliderGroups", {1}}}}},
        {"colliderGroups",
         {{{"node", -1}, {"colliders", Json::array()}},
          {{"node", head}, {"colliders", {{{"offset", vector(0.1, 0.2, 0.3)}, {"radius", 0.09}}}}}}}}},
      {"materialProperties",
       {{{"name", "skin"},
         {"shader", "VRM/MToon"},
         {"floatProperties",
          {{"_ShadeShift", 0.5},
           {"_ShadeToony", 0.8},
           {"_OutlineWidth", 0.5},
           {"_OutlineWidthMode", 1},
           {"_CullMode", 0}}},
         {"vectorProperties", {{"_Color", {1, 0, 0, 0.5}}}}},
        {{"name", "glass"}, {"shader", "Standard"}}}}};
  return old;
}

Asset upgraded(OldAvatar old) {
  changeExtension(old.asset.document, "VRM") = std::move(old.vrm);
  declareExtension(old.asset.document, "VRM");
  upgradeVrm0(old.asset);
  checkAsset(old.asset);
  return std::move(old.asset);
}

TEST(Vrm0, FacesTheOtherWayAndNamesItsBonesAnew) {
  const OldAvatar old = oldAvatar();
  const Asset asset = upgraded(oldAvatar());
  EXPECT_THAT(asset.document.extensionsUsed,
              ElementsAre("VRMC_springBone", "VRMC_materials_mtoon", "KHR_materials_unlit", "VRMC_vrm"));
  EXPECT_EQ(extensionOf(asset.document, "VRM"), nullptr);
  EXPECT_GT(testing::bonePosition(asset, "leftHand").x(), 0.5);
  EXPECT_GT(testing::bonePosition(asset, "leftToes").z(), testing::bonePosition(asset, "leftFoot").z());
  const Json& bones = extensionOf(asset.document, "VRMC_vrm")->at("humanoid").at("humanBones");
  EXPECT_EQ(bones.size(), 24u);
  EXPECT_EQ(bones["leftThumbMetacarpal"]["node"], old.braid);
  EXPECT_EQ(bones["leftThumbProximal"]["node"], old.strand);
}

TEST(Vrm0, RestsInTPoseTheOtherWayRound) {
  OldAvatar old = oldAvatar();
  changeExtension(old.asset.document, "VRM") = old.vrm;
  EXPECT_TRUE(restsInTPose(old.asset, "VRM"));
  changeExtension(old.asset.document, "VRMC_vrm") = old.vrm;
  EXPECT_FALSE(restsInTPose(old.asset, "VRMC_vrm"));
}

TEST(Vrm0, ExpressionsGazeAndWhatTheWearerSees) {
  const Asset asset = upgraded(oldAvatar());
  const Json& vrm = *extensionOf(asset.document, "VRMC_vrm");
  const Json& happy = vrm["expressions"]["preset"]["happy"];
  EXPECT_EQ(happy["isBinary"], true);
  ASSERT_EQ(happy["morphTargetBinds"].size(), 1u);  // the other names no mesh
  EXPECT_EQ(happy["morphTargetBinds"][0]["index"], 1);
  EXPECT_EQ(happy["morphTargetBinds"][0]["weight"], 0.5);
  EXPECT_EQ(happy["materialColorBinds"].size(), 1u);
  EXPECT_EQ(happy["materialColorBinds"][0]["type"], "color");
  EXPECT_TRUE(vrm["expressions"]["custom"].contains("Wink"));
  EXPECT_EQ(vrm["firstPerson"]["meshAnnotations"][0]["type"], "thirdPersonOnly");
  EXPECT_EQ(vrm["lookAt"]["type"], "bone");
  EXPECT_EQ(vrm["lookAt"]["rangeMapHorizontalInner"], (Json{{"inputMaxValue", 80}, {"outputScale", 8}}));
  EXPECT_EQ(vrm["lookAt"]["rangeMapVerticalDown"]["inputMaxValue"], 90);
  EXPECT_EQ(vrm["lookAt"]["offsetFromHeadBone"], (Json{0.01, 0.06, -0.02}));
  EXPECT_THAT(testing::warningKinds(asset.warnings), ElementsAre("vrm0-curves", "vrm0-expressions", "vrm0-materials"));
}

TEST(Vrm0, GroupsThatNameNoPresetGoByTheirNames) {
  OldAvatar old = oldAvatar();
  Json groups = Json::array();
  for (const auto& [name, preset] : {std::pair("Surprised", "unknown"), std::pair("Blink_L", ""),
                                     std::pair("Joy", "unknown"), std::pair("Smile", "Joy"), std::pair("Grin", "joy"),
                                     std::pair("Wink", "unknown"), std::pair("", "Fun"), std::pair("", "fun")}) {
    groups.push_back({{"name", name}, {"presetName", preset}});
  }
  old.vrm["blendShapeMaster"]["blendShapeGroups"] = groups;
  const Asset asset = upgraded(std::move(old));
  const Json& expressions = extensionOf(asset.document, "VRMC_vrm")->at("expressions");
  const auto names = [](const Json& group) {
    std::vector<std::string> all;
    for (const auto& [name, expression] : group.items()) all.push_back(name);
    return all;
  };
  EXPECT_THAT(names(expressions["preset"]), UnorderedElementsAre("surprised", "blinkLeft", "happy", "relaxed"));
  EXPECT_THAT(names(expressions["custom"]), UnorderedElementsAre("Joy", "Grin", "Wink", "relaxed_2"));
}

TEST(Vrm0, ChainsSwingToSevenCentimetresBeyondTheirEnds) {
  const Asset asset = upgraded(oldAvatar());
  const Json& springs = extensionOf(asset.document, "VRMC_springBone")->at("springs");
  ASSERT_EQ(springs.size(), 2u);
  const auto names = [&](const Json& spring) {
    std::vector<std::string> all;
    for (const Json& joint : spring["joints"]) all.push_back(asset.document.nodes[joint["node"].get<Index>()].name);
    return all;
  };
  EXPECT_THAT(names(springs[0]), ElementsAre("braid", "braid_2", "braid_2_end"));
  EXPECT_THAT(names(springs[1]), ElementsAre("strand", "strand_end"));
  const Json& joint = springs[0]["joints"][0];
  EXPECT_EQ(joint["stiffness"], 0.7);
  EXPECT_EQ(joint["dragForce"], 0.4);
  EXPECT_EQ(joint["hitRadius"], 0.02);
  EXPECT_EQ(joint["gravityDir"], (Json{-0.6, -0.8, 0}));  // of the world, which the model was turned in
  EXPECT_FALSE(springs[0].contains("center"));
  EXPECT_EQ(springs[0]["colliderGroups"], Json::array({0}));  // the only one with a collider
  const gltf::Node& end = asset.document.nodes[springs[0]["joints"][2]["node"].get<Index>()];
  EXPECT_NEAR(end.translation->y(), -0.07, 1e-7);
  const Json& collider = extensionOf(asset.document, "VRMC_springBone")->at("colliders")[0];
  EXPECT_EQ(collider["shape"]["sphere"]["offset"], (Json{0.1, 0.2, -0.3}));
}

TEST(Vrm0, MToonGoesOn) {
  const Asset asset = upgraded(oldAvatar());
  const gltf::Material& skin = asset.document.materials[0];
  const Json& mtoon = *extensionOf(skin, "VRMC_materials_mtoon");
  EXPECT_NEAR(mtoon["shadingToonyFactor"].get<double>(), 0.95, 1e-6);  // 0.8 moved three quarters of the distance to 1
  EXPECT_NEAR(mtoon["shadingShiftFactor"].get<double>(), -0.55, 1e-6);
  EXPECT_NEAR(mtoon["outlineWidthFactor"].get<double>(), 0.005, 1e-9);  // half a centimetre
  EXPECT_EQ(mtoon["outlineWidthMode"], "worldCoordinates");
  EXPECT_TRUE(skin.doubleSided);
  EXPECT_EQ(skin.pbrMetallicRoughness->baseColorFactor->x(), 1);
  EXPECT_EQ(skin.pbrMetallicRoughness->baseColorFactor->w(), 0.5);
  EXPECT_EQ(extensionOf(asset.document.materials[1], "VRMC_materials_mtoon"), nullptr);
}

TEST(Vrm0, MToonKeepsTheDepthOfNormalsAndOutlinesOfTheScreen) {
  OldAvatar old = oldAvatar();
  old.asset.document.textures.emplace_back();
  Json& skin = old.vrm["materialProperties"][0];
  skin["floatProperties"]["_BumpScale"] = 0.25;
  skin["floatProperties"]["_OutlineWidthMode"] = 2;
  skin["textureProperties"]["_BumpMap"] = 0;
  const Asset asset = upgraded(std::move(old));
  const gltf::Material& material = asset.document.materials[0];
  const Json& mtoon = *extensionOf(material, "VRMC_materials_mtoon");
  EXPECT_EQ(mtoon["outlineWidthMode"], "screenCoordinates");
  EXPECT_NEAR(mtoon["outlineWidthFactor"].get<double>(), 0.0025, 1e-9);  // of 0.5 hundredths of half the screen
  EXPECT_EQ(material.normalTexture->asRead->at("scale"), 0.25);
}

TEST(Vrm0, AnOldAvatarIsWrittenAsANewOne) {
  OldAvatar old = oldAvatar();
  changeExtension(old.asset.document, "VRM") = std::move(old.vrm);
  makeVrm(old.asset);
  EXPECT_EQ(extensionOf(old.asset.document, "VRM"), nullptr);
  EXPECT_EQ(extensionOf(old.asset.document, "VRMC_vrm")->at("meta").at("name"), "Old");
}

// Whatever replaces a member, the result is an answer or an error of limber's.
TEST(Vrm0, OddMembersBreakNothing) {
  const OldAvatar old = oldAvatar();
  const std::vector<Json> odd = {Json(), Json(1e30), Json("text"), Json::array({Json::array(), 3})};
  std::vector<Json::json_pointer> locations;
  const std::function<void(const Json&, const Json::json_pointer&)> walk = [&](const Json& value,
                                                                               const Json::json_pointer& at) {
    locations.push_back(at);
    if (value.is_object()) {
      for (const auto& [key, inner] : value.items()) walk(inner, at / key);
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < std::min<std::size_t>(value.size(), 2); ++i) walk(value[i], at / i);
    }
  };
  walk(old.vrm, Json::json_pointer());
  for (const Json::json_pointer& location : locations) {
    for (const Json& value : odd) {
      Asset asset = old.asset.clone();
      Json vrm = old.vrm;
      vrm[location] = value;
      changeExtension(asset.document, "VRM") = std::move(vrm);
      try {
        upgradeVrm0(asset);
        checkAsset(asset);
      } catch (const Error&) {
      }
    }
  }
}

}  // namespace
}  // namespace limber
