#include "limber/document/vrm/vrm0.h"

#include <string>
#include <utility>

#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/turn_scene.h"
#include "limber/document/vrm/loose_json.h"
#include "limber/document/vrm/vrm0_expressions.h"
#include "limber/document/vrm/vrm0_materials.h"
#include "limber/document/vrm/vrm0_springs.h"
#include "limber/document/vrm/vrm_meta.h"

namespace limber {

namespace {

const Json& partOf(const Json& vrm, const char* key) {
  static const Json kNone = Json::object();
  const Json* part = member(vrm, key);
  return part != nullptr ? *part : kNone;
}

// 0.x names a texture, 1.0 its image.
std::optional<Index> thumbnailOf(const gltf::Document& document, const Json& meta) {
  const std::optional<Index> texture = indexIn(meta, "texture", document.textures.size());
  return texture ? document.textures[*texture].source : std::nullopt;
}

Json humanoidOf(const gltf::Document& document) {
  Json bones = Json::object();
  for (const HumanoidNode& node : humanoidNodes(document, kVrm0Name))
    bones[std::string(node.bone)] = {{"node", node.node}};
  return {{"humanBones", std::move(bones)}};
}

// 0.x annotates meshes, 1.0 the nodes that show them.
Json firstPersonOf(const gltf::Document& document, const Json& old) {
  std::vector<std::string> typeOfMesh(document.meshes.size());
  for (const Json& annotation : listIn(old, "meshAnnotations")) {
    const std::optional<Index> mesh = indexIn(annotation, "mesh", document.meshes.size());
    const std::string flag = textIn(annotation, "firstPersonFlag");
    if (!mesh || !typeOfMesh[*mesh].empty()) continue;
    typeOfMesh[*mesh] = flag == "FirstPersonOnly"   ? "firstPersonOnly"
                        : flag == "ThirdPersonOnly" ? "thirdPersonOnly"
                        : flag == "Both"            ? "both"
                                                    : "auto";
  }
  Json annotations = Json::array();
  for (Index n = 0; n < document.nodeCount(); ++n) {
    const std::optional<Index> mesh = document.nodes[n].mesh;
    if (mesh && !typeOfMesh[*mesh].empty()) annotations.push_back({{"node", n}, {"type", typeOfMesh[*mesh]}});
  }
  if (annotations.empty()) return nullptr;
  return {{"meshAnnotations", std::move(annotations)}};
}

// The eyes' turn in 1.0 grows evenly up to a largest one; 0.x may have bent that by a curve.
Json lookAtOf(const Json& old, Warnings& warnings) {
  const bool byExpression = textIn(old, "lookAtTypeName") == "BlendShape";
  const Json& offset = partOf(old, "firstPersonBoneOffset");
  Json lookAt = {{"type", byExpression ? "expression" : "bone"}};
  lookAt["offsetFromHeadBone"] = {numberIn(offset, "x", 0), numberIn(offset, "y", 0.06),
                                  0.0 - numberIn(offset, "z", 0)};  // Unity's Z points in the opposite direction
  std::size_t curves = 0;
  const std::pair<const char*, const char*> kMaps[] = {{"rangeMapHorizontalInner", "lookAtHorizontalInner"},
                                                       {"rangeMapHorizontalOuter", "lookAtHorizontalOuter"},
                                                       {"rangeMapVerticalDown", "lookAtVerticalDown"},
                                                       {"rangeMapVerticalUp", "lookAtVerticalUp"}};
  for (const auto& [name, oldName] : kMaps) {
    const Json& map = partOf(old, oldName);
    lookAt[name] = {{"inputMaxValue", numberIn(map, "xRange", 90)},
                    {"outputScale", numberIn(map, "yRange", byExpression ? 1 : 10)}};
    const Json& curve = listIn(map, "curve");
    curves += !curve.empty() && curve != Json{0, 0, 0, 1, 1, 1, 1, 0} ? 1 : 0;
  }
  warnings.add("vrm0-curves", "curves of the eyes' turn have no place in VRM 1.0: it grows evenly", {}, curves);
  return lookAt;
}

}  // namespace

void upgradeVrm0(Asset& asset) {
  gltf::Document& document = asset.document;
  const Json* found = extensionOf(document, kVrm0Name);
  if (found == nullptr) return;
  const Json old = *found;
  Json vrm = {{"specVersion", "1.0"}};
  const Json& meta = partOf(old, "meta");
  vrm["meta"] = vrmMetaOfVrm0(meta, thumbnailOf(document, meta));
  vrm["humanoid"] = humanoidOf(document);
  if (member(old, "firstPerson") != nullptr) {
    const Json& firstPerson = partOf(old, "firstPerson");
    if (Json annotations = firstPersonOf(document, firstPerson); !annotations.is_null()) {
      vrm["firstPerson"] = std::move(annotations);
    }
    vrm["lookAt"] = lookAtOf(firstPerson, asset.warnings);
  }
  if (Json expressions = expressionsOfVrm0(asset, partOf(old, "blendShapeMaster")); !expressions.is_null()) {
    vrm["expressions"] = std::move(expressions);
  }
  if (Json springs = springsOfVrm0(asset, partOf(old, "secondaryAnimation")); !springs.is_null()) {
    changeExtension(document, kSpringBoneName) = std::move(springs);
    declareExtension(document, kSpringBoneName);
  }
  convertVrm0Materials(asset, listIn(old, "materialProperties"));
  eraseExtension(document, kVrm0Name);
  undeclareExtension(document, kVrm0Name);
  changeExtension(document, kVrmName) = std::move(vrm);
  declareExtension(document, kVrmName);
  turnScene(asset, Quat(0, 0, 1, 0), "facing_front");
}

}  // namespace limber
