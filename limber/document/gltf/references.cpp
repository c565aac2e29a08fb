#include "limber/document/gltf/references.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/scene/humanoid_nodes.h"

namespace limber {

namespace {

constexpr const char *kLightsName = "KHR_lights_punctual", *kVariantsName = "KHR_materials_variants";

// The lists of a document, as pointers of animations begin with them.
struct PointedList {
  std::string_view start;
  ElementKind kind;
};
constexpr std::array<PointedList, 15> kLists = {
    {{"/accessors/", ElementKind::kAccessor},
     {"/animations/", ElementKind::kAnimation},
     {"/bufferViews/", ElementKind::kBufferView},
     {"/buffers/", ElementKind::kBuffer},
     {"/cameras/", ElementKind::kCamera},
     {"/images/", ElementKind::kImage},
     {"/materials/", ElementKind::kMaterial},
     {"/meshes/", ElementKind::kMesh},
     {"/nodes/", ElementKind::kNode},
     {"/samplers/", ElementKind::kSampler},
     {"/scenes/", ElementKind::kScene},
     {"/skins/", ElementKind::kSkin},
     {"/textures/", ElementKind::kTexture},
     {"/extensions/KHR_lights_punctual/lights/", ElementKind::kLight},
     {"/extensions/KHR_materials_variants/variants/", ElementKind::kVariant}}};

bool hasKeyWithin(const Json& value, const char* key) {
  if (!value.is_structured()) return false;
  if (value.is_object() && value.contains(key)) return true;
  return std::any_of(value.begin(), value.end(), [&](const Json& inner) { return hasKeyWithin(inner, key); });
}

class ReferenceChanger {
 public:
  explicit ReferenceChanger(const std::function<void(ElementKind, Index&)>& change) : change_(change) {}

  void run(gltf::Document& document) {
    for (gltf::BufferView& view : document.bufferViews) bufferView(view);
    for (gltf::Accessor& accessor : document.accessors) {
      one(ElementKind::kBufferView, accessor.bufferView);
      if (!accessor.sparse) continue;
      change_(ElementKind::kBufferView, accessor.sparse->indices.bufferView);
      change_(ElementKind::kBufferView, accessor.sparse->values.bufferView);
    }
    for (gltf::Image& image : document.images) one(ElementKind::kBufferView, image.bufferView);
    for (gltf::Texture& texture : document.textures) {
      one(ElementKind::kSampler, texture.sampler);
      one(ElementKind::kImage, texture.source);
      inEachExtension(texture, [&](Json& other) { one(ElementKind::kImage, other, "source"); });
    }
    for (gltf::Material& material : document.materials) materialOf(material);
    for (gltf::Mesh& mesh : document.meshes) {
      for (gltf::Primitive& primitive : mesh.primitives) primitiveOf(primitive);
    }
    for (gltf::Skin& skin : document.skins) {
      one(ElementKind::kAccessor, skin.inverseBindMatrices);
      one(ElementKind::kNode, skin.skeleton);
      many(ElementKind::kNode, skin.joints);
    }
    for (gltf::Animation& animation : document.animations) animationOf(animation);
    for (gltf::Node& node : document.nodes) nodeOf(node);
    for (gltf::Scene& scene : document.scenes) many(ElementKind::kNode, scene.nodes);
    forEachObject(document,
                  [&](gltf::Object& object) { inEachExtension(object, [&](Json& content) { bufferViews(content); }); });
  }

 private:
  void one(ElementKind kind, std::optional<Index>& number) {
    if (!number) return;
    change_(kind, *number);
    if (*number == kNoIndex) number.reset();
  }
  void many(ElementKind kind, std::vector<Index>& numbers) {
    for (Index& number : numbers) change_(kind, number);
    std::erase(numbers, kNoIndex);
  }
  void attributes(gltf::Attributes& of) {
    for (auto& [name, accessor] : of) change_(ElementKind::kAccessor, accessor);
  }

  // In the JSON of an extension. What is no number there is nothing that limber knows.
  void number(ElementKind kind, Json& value) {
    if (!value.is_number()) return;
    const auto before = value.get<double>();
    if (!(before >= 0 && before < kNoIndex)) return;
    auto after = static_cast<Index>(before);
    change_(kind, after);
    if (after == static_cast<Index>(before)) return;
    value = after;
    isChanged_ = true;
  }
  void one(ElementKind kind, Json& owner, const char* key) {
    if (!owner.is_object() || !owner.contains(key)) return;
    number(kind, owner[key]);
    if (owner[key] == kNoIndex) owner.erase(key);
  }
  void many(ElementKind kind, Json& owner, const char* key) {
    if (!owner.is_object() || !owner.contains(key)) return;
    Json& list = owner[key];
    if (!list.is_structured()) return;
    for (Json& element : list) number(kind, element);
    if (!list.is_array() || !isChanged_) return;
    std::erase_if(list.get_ref<Json::array_t&>(), [](const Json& element) { return element == kNoIndex; });
    if (list.empty()) owner.erase(key);
  }

  // Works on a copy, so that documents that share the JSON keep theirs. An extension that says nothing
  // without what it referred to is set to null, and removed.
  template <typename Act>
  void inExtension(gltf::Object& owner, const char* name, const Act& act) {
    const Json* found = extensionOf(owner, name);
    if (found == nullptr || !found->is_object()) return;
    Json content = *found;
    isChanged_ = false;
    act(content);
    if (!isChanged_) return;
    if (content.is_null()) {
      eraseExtension(owner, name);
    } else {
      changeExtension(owner, name) = std::move(content);
    }
  }
  template <typename Act>
  void inEachExtension(gltf::Object& owner, const Act& act) {
    if (!owner.extensions.exists()) return;
    Json all = *owner.extensions;
    isChanged_ = false;
    for (Json& content : all) act(content);
    if (isChanged_) owner.extensions = gltf::KeptJson(std::move(all));
  }

  void bufferView(gltf::BufferView& view) {
    change_(ElementKind::kBuffer, view.buffer);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      inExtension(view, name, [&](Json& packed) { one(ElementKind::kBuffer, packed, "buffer"); });
    }
  }

  // "bufferView": 3, anywhere in an extension.
  void bufferViews(Json& value) {
    if (!value.is_structured()) return;
    one(ElementKind::kBufferView, value, "bufferView");
    for (Json& inner : value) bufferViews(inner);
  }

  void materialOf(gltf::Material& material) {
    const auto texture = [&](std::optional<gltf::TextureUse>& use) {
      if (use) change_(ElementKind::kTexture, use->index);
    };
    if (auto& pbr = material.pbrMetallicRoughness) {
      texture(pbr->baseColorTexture);
      texture(pbr->metallicRoughnessTexture);
      inEachExtension(*pbr, [&](Json& content) { textures(content); });
    }
    texture(material.normalTexture);
    texture(material.occlusionTexture);
    texture(material.emissiveTexture);
    inEachExtension(material, [&](Json& content) { textures(content); });
  }

  // "clearcoatTexture": {"index": 3}, anywhere in an extension.
  void textures(Json& value) {
    if (!value.is_structured()) return;
    for (auto entry = value.begin(); entry != value.end(); ++entry) {
      if (value.is_object() && entry->is_object() && std::string_view(entry.key()).ends_with("Texture")) {
        one(ElementKind::kTexture, *entry, "index");
      }
      textures(*entry);
    }
  }

  void primitiveOf(gltf::Primitive& primitive) {
    one(ElementKind::kAccessor, primitive.indices);
    one(ElementKind::kMaterial, primitive.material);
    attributes(primitive.attributes);
    for (gltf::Attributes& target : primitive.targets) attributes(target);
    inExtension(primitive, kVariantsName, [&](Json& variants) {
      if (!variants.contains("mappings") || !variants["mappings"].is_array()) return;
      for (Json& mapping : variants["mappings"]) {
        one(ElementKind::kMaterial, mapping, "material");
        many(ElementKind::kVariant, mapping, "variants");
      }
    });
  }

  void animationOf(gltf::Animation& animation) {
    for (gltf::AnimationSampler& sampler : animation.samplers) {
      change_(ElementKind::kAccessor, sampler.input);
      change_(ElementKind::kAccessor, sampler.output);
    }
    for (gltf::AnimationChannel& channel : animation.channels) {
      one(ElementKind::kNode, channel.target.node);
      const std::string* pointer = animationPointer(channel.target);
      if (pointer == nullptr) continue;
      const std::string changed = changedPointer(*pointer);
      if (changed != *pointer) setAnimationPointer(channel.target, changed);
    }
  }

  // "/materials/3/emissiveFactor", "/extensions/KHR_lights_punctual/lights/0/color"
  std::string changedPointer(const std::string& path) {
    const auto* list = std::find_if(kLists.begin(), kLists.end(),
                                    [&](const PointedList& known) { return path.rfind(known.start, 0) == 0; });
    if (list == kLists.end()) return path;
    const std::size_t digits = list->start.size();
    std::size_t end = digits;
    std::uint64_t before = 0;
    for (; end < path.size() && path[end] >= '0' && path[end] <= '9' && before < kNoIndex; ++end) {
      before = 10 * before + static_cast<std::uint64_t>(path[end] - '0');
    }
    if (end == digits || before >= kNoIndex) return path;
    auto after = static_cast<Index>(before);
    change_(list->kind, after);
    if (after == kNoIndex) return path;
    return path.substr(0, digits) + fmt::to_string(after) + path.substr(end);
  }

  void nodeOf(gltf::Node& node) {
    one(ElementKind::kMesh, node.mesh);
    one(ElementKind::kSkin, node.skin);
    one(ElementKind::kCamera, node.camera);
    many(ElementKind::kNode, node.children);
    inExtension(node, kLightsName, [&](Json& light) { one(ElementKind::kLight, light, "light"); });
    inExtension(node, "MSFT_lod", [&](Json& levels) {
      many(ElementKind::kNode, levels, "ids");
      if (!levels.contains("ids")) levels = nullptr;
    });
    inExtension(node, "VRMC_node_constraint", [&](Json& of) {
      if (!of.contains("constraint") || !of["constraint"].is_object()) return;
      bool isWhole = true;
      for (Json& kind : of["constraint"]) {
        one(ElementKind::kNode, kind, "source");
        isWhole = isWhole && kind.is_object() && kind.contains("source");
      }
      if (!isWhole) of = nullptr;
    });
    inExtension(node, kInstancingName, [&](Json& copies) { many(ElementKind::kAccessor, copies, "attributes"); });
  }

  const std::function<void(ElementKind, Index&)>& change_;
  bool isChanged_ = false;  // of the extension that is being walked
};

// The new number of the node that a member names; none where it names none, or one that is gone.
class NewNumbers {
 public:
  explicit NewNumbers(const std::vector<Index>& newNode) : newNode_(newNode) {}

  std::optional<Index> of(const Json& number) const {
    if (!number.is_number()) return std::nullopt;
    const auto before = number.get<double>();
    if (!(before >= 0 && before < static_cast<double>(newNode_.size()))) return std::nullopt;
    const Index renumbered = newNode_[static_cast<std::size_t>(before)];
    return renumbered == kNoIndex ? std::nullopt : std::optional(renumbered);
  }
  std::optional<Index> of(const Json& holder, const char* key) const {
    const Json* node = member(holder, key);
    return node != nullptr ? of(*node) : std::nullopt;
  }

  // Takes the elements, or members, out of a list whose "node" is gone.
  void inEach(Json& list) const {
    if (!list.is_structured()) return;
    for (auto holder = list.begin(); holder != list.end();) {
      if (const auto number = of(*holder, "node")) {
        (*holder)["node"] = *number;
        ++holder;
      } else {
        holder = list.erase(holder);
      }
    }
  }
  // The same with a list that is a member, where there is one.
  void inEach(Json& owner, const char* key) const {
    if (owner.is_object() && owner.contains(key)) inEach(owner[key]);
  }
  // VRM 0.x writes -1 where nothing is meant.
  void orMinusOne(Json& owner, const char* key) const {
    if (!owner.is_object() || !owner.contains(key)) return;
    const auto number = of(owner, key);
    owner[key] = number ? Json(*number) : Json(-1);
  }

 private:
  const std::vector<Index>& newNode_;
};

// Renumbers the nodes of VRMC_springBone's springs: those of deleted joints go, and the extension where none is left.
// False where colliders hang on deleted nodes: these are kept as they are.
bool renumberSprings(gltf::Document& document, const NewNumbers& newNumber) {
  Json& extension = changeExtension(document, kSpringBoneName);
  Json kept = Json::array();
  for (Json& spring : extension["springs"]) {
    if (!spring.is_object()) continue;
    Json& joints = spring["joints"];
    if (!joints.is_array() || !std::all_of(joints.begin(), joints.end(), [&](const Json& joint) {
          return newNumber.of(joint, "node").has_value();
        })) {
      continue;
    }
    for (Json& joint : joints) joint["node"] = *newNumber.of(joint, "node");
    if (const auto center = newNumber.of(spring, "center")) {
      spring["center"] = *center;
    } else {
      spring.erase("center");
    }
    kept.push_back(std::move(spring));
  }
  if (kept.empty()) {
    eraseExtension(document, kSpringBoneName);
    undeclareExtension(document, kSpringBoneName);
    return true;
  }
  extension["springs"] = std::move(kept);
  const auto colliders = extension.find("colliders");
  if (colliders == extension.end() || !colliders->is_array()) return true;
  bool allKept = true;
  for (Json& collider : *colliders) {
    if (const auto node = newNumber.of(collider, "node")) {
      collider["node"] = *node;
    } else {
      allKept = false;
    }
  }
  return allKept;
}

Json* memberToChange(Json& object, const char* key) {
  return object.is_object() && object.contains(key) ? &object[key] : nullptr;
}

// Bones, expressions and annotations of nodes that are gone go; what else a VRM says of itself (who may use it) stays.
void renumberVrm(Json& vrm, const NewNumbers& newNumber) {
  if (Json* humanoid = memberToChange(vrm, "humanoid")) newNumber.inEach(*humanoid, "humanBones");
  if (Json* firstPerson = memberToChange(vrm, "firstPerson")) newNumber.inEach(*firstPerson, "meshAnnotations");
  Json* expressions = memberToChange(vrm, "expressions");
  for (const char* kind : {"preset", "custom"}) {
    Json* named = expressions != nullptr ? memberToChange(*expressions, kind) : nullptr;
    if (named == nullptr || !named->is_object()) continue;
    for (Json& expression : *named) newNumber.inEach(expression, "morphTargetBinds");
  }
}

void renumberVrm0(Json& vrm, const NewNumbers& newNumber) {
  if (Json* humanoid = memberToChange(vrm, "humanoid")) newNumber.inEach(*humanoid, "humanBones");
  if (Json* firstPerson = memberToChange(vrm, "firstPerson")) newNumber.orMinusOne(*firstPerson, "firstPersonBone");
  Json* springs = memberToChange(vrm, "secondaryAnimation");
  if (springs == nullptr) return;
  if (Json* groups = memberToChange(*springs, "boneGroups"); groups != nullptr && groups->is_array()) {
    for (Json& group : *groups) {
      newNumber.orMinusOne(group, "center");
      Json* bones = memberToChange(group, "bones");
      if (bones == nullptr || !bones->is_array()) continue;
      Json kept = Json::array();
      for (const Json& bone : *bones) {
        if (const auto number = newNumber.of(bone)) kept.push_back(*number);
      }
      *bones = std::move(kept);
    }
  }
  if (Json* groups = memberToChange(*springs, "colliderGroups"); groups != nullptr && groups->is_array()) {
    for (Json& group : *groups) newNumber.orMinusOne(group, "node");  // groups are referred to by their indices
  }
}

void renumberVrmAnimation(Json& animation, const NewNumbers& newNumber) {
  if (Json* humanoid = memberToChange(animation, "humanoid")) newNumber.inEach(*humanoid, "humanBones");
  Json* expressions = memberToChange(animation, "expressions");
  for (const char* kind : {"preset", "custom"}) {
    if (expressions != nullptr) newNumber.inEach(*expressions, kind);
  }
  const Json* lookAt = memberToChange(animation, "lookAt");
  if (lookAt == nullptr) return;
  if (const auto number = newNumber.of(*lookAt, "node")) {
    animation["lookAt"]["node"] = *number;
  } else {
    animation.erase("lookAt");
  }
}

struct NodeNamingExtension {
  const char* name;
  void (*renumber)(Json&, const NewNumbers&);
};
constexpr std::array<NodeNamingExtension, 3> kVrmExtensions = {
    {{kVrmName, renumberVrm}, {kVrm0Name, renumberVrm0}, {kVrmAnimationName, renumberVrmAnimation}}};

// Does anything in there look like the number of a node?
bool seemsToNameNodes(const Json& value) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if ((key == "node" || key == "nodes" || key == "bone" || key == "bones") && !inner.is_object()) return true;
      if (seemsToNameNodes(inner)) return true;
    }
  } else if (value.is_array()) {
    return std::any_of(value.begin(), value.end(), seemsToNameNodes);
  }
  return false;
}

// Does an extension of the whole document, other than those that are renumbered here?
bool otherExtensionsNameNodes(const gltf::Document& document) {
  if (!document.extensions.exists()) return false;
  const auto isKnown = [](const std::string& name) {
    return name == kSpringBoneName ||
           std::any_of(kVrmExtensions.begin(), kVrmExtensions.end(), [&](const auto& vrm) { return vrm.name == name; });
  };
  const auto& all = document.extensions->items();
  return std::any_of(all.begin(), all.end(), [&](const auto& extension) {
    return !isKnown(extension.key()) && seemsToNameNodes(extension.value());
  });
}

// The elements of a list that an extension keeps for the document.
Index listedBy(const gltf::Document& document, const char* extension, const char* list) {
  const Json* content = extensionOf(document, extension);
  const Json* elements = content != nullptr ? member(*content, list) : nullptr;
  return elements != nullptr ? static_cast<Index>(elements->size()) : 0;
}

}  // namespace

Index elementCount(const gltf::Document& document, ElementKind kind) {
  const auto count = [](const auto& list) { return static_cast<Index>(list.size()); };
  switch (kind) {
    case ElementKind::kBuffer:
      return count(document.buffers);
    case ElementKind::kBufferView:
      return count(document.bufferViews);
    case ElementKind::kAccessor:
      return count(document.accessors);
    case ElementKind::kImage:
      return count(document.images);
    case ElementKind::kSampler:
      return count(document.samplers);
    case ElementKind::kTexture:
      return count(document.textures);
    case ElementKind::kMaterial:
      return count(document.materials);
    case ElementKind::kMesh:
      return count(document.meshes);
    case ElementKind::kSkin:
      return count(document.skins);
    case ElementKind::kCamera:
      return count(document.cameras);
    case ElementKind::kNode:
      return count(document.nodes);
    case ElementKind::kScene:
      return count(document.scenes);
    case ElementKind::kAnimation:
      return count(document.animations);
    case ElementKind::kLight:
      return listedBy(document, kLightsName, "lights");
    case ElementKind::kVariant:
      return listedBy(document, kVariantsName, "variants");
  }
  return 0;
}

void forEachObject(gltf::Document& document, const std::function<void(gltf::Object&)>& act) {
  const auto each = [&](auto& list) {
    for (auto& element : list) act(element);
  };
  act(document);
  act(document.about);
  each(document.scenes);
  each(document.nodes);
  each(document.cameras);
  each(document.meshes);
  for (gltf::Mesh& mesh : document.meshes) each(mesh.primitives);
  each(document.skins);
  each(document.animations);
  for (gltf::Animation& animation : document.animations) {
    each(animation.samplers);
    each(animation.channels);
    for (gltf::AnimationChannel& channel : animation.channels) act(channel.target);
  }
  each(document.materials);
  for (gltf::Material& material : document.materials) {
    const auto texture = [&](std::optional<gltf::TextureUse>& use) {
      if (use) act(*use);
    };
    if (auto& pbr = material.pbrMetallicRoughness) {
      act(*pbr);
      texture(pbr->baseColorTexture);
      texture(pbr->metallicRoughnessTexture);
    }
    texture(material.normalTexture);
    texture(material.occlusionTexture);
    texture(material.emissiveTexture);
  }
  each(document.textures);
  each(document.images);
  each(document.samplers);
  each(document.accessors);
  for (gltf::Accessor& accessor : document.accessors) {
    if (!accessor.sparse) continue;
    act(*accessor.sparse);
    act(accessor.sparse->indices);
    act(accessor.sparse->values);
  }
  each(document.bufferViews);
  each(document.buffers);
}

void visitReferences(const gltf::Document& document, const std::function<void(ElementKind, Index)>& visit) {
  const std::function<void(ElementKind, Index&)> look = [&](ElementKind kind, Index& number) { visit(kind, number); };
  // Where no number changes, nothing of the document does.
  ReferenceChanger(look).run(const_cast<gltf::Document&>(document));
}

void changeReferences(gltf::Document& document, const std::function<void(ElementKind, Index&)>& change) {
  ReferenceChanger(change).run(document);
}

bool renumberDocumentExtensions(gltf::Document& document, const std::vector<Index>& newNode) {
  const NewNumbers newNumber(newNode);
  for (const NodeNamingExtension& vrm : kVrmExtensions) {
    if (extensionOf(document, vrm.name) != nullptr) vrm.renumber(changeExtension(document, vrm.name), newNumber);
  }
  const Json* springs = extensionOf(document, kSpringBoneName);
  const bool springsKept = springs == nullptr || !springs->is_object() || renumberSprings(document, newNumber);
  return springsKept && !otherExtensionsNameNodes(document);
}

void moveVrmMesh(gltf::Document& document, Index from, Index to) {
  if (extensionOf(document, kVrmName) == nullptr) return;
  Json& vrm = changeExtension(document, kVrmName);
  const auto move = [&](Json* list) {
    if (list == nullptr || !list->is_array()) return;
    for (Json& holder : *list) {
      if (holder.is_object() && holder.contains("node") && holder["node"] == from) holder["node"] = to;
    }
  };
  if (Json* firstPerson = memberToChange(vrm, "firstPerson")) move(memberToChange(*firstPerson, "meshAnnotations"));
  Json* expressions = memberToChange(vrm, "expressions");
  for (const char* kind : {"preset", "custom"}) {
    Json* named = expressions != nullptr ? memberToChange(*expressions, kind) : nullptr;
    if (named == nullptr || !named->is_object()) continue;
    for (Json& expression : *named) move(memberToChange(expression, "morphTargetBinds"));
  }
}

}  // namespace limber
