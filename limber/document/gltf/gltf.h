// A glTF 2.0 document as types. What limber has no type for is kept beside them as it was read, and written back.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "limber/core/types.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

using Json = nlohmann::ordered_json;  // keeps the order of keys as read

namespace gltf {

// A piece of JSON that is kept as it was read; may be none. Copies share it until one of them is changed.
class KeptJson {
 public:
  KeptJson() = default;
  explicit KeptJson(Json value);

  bool exists() const { return value_ != nullptr; }
  const Json& operator*() const { return *value_; }  // only where exists()
  const Json* operator->() const { return value_.get(); }
  Json& change();  // an empty object where nothing is
  void reset() { value_.reset(); }

 private:
  std::shared_ptr<Json> value_;
};

// What every object of a document may have besides its own members.
struct Object {
  KeptJson extensions;  // "extensions", an object by the names of the extensions
  KeptJson extras;      // "extras", the application's own, of any kind
  KeptJson asRead;  // the object as it was read, its own elements left out: what writing begins with, so that unknown
                    // members, the order of keys and the numbers' form stay
};

// An object that can be referred to by its index in one of the document's lists.
struct Element : Object {
  std::string name;  // empty: none
};

struct Buffer : Element {
  std::size_t byteLength = 0;
  std::string uri;  // as Asset::Buffer::uri has it
};

// What a buffer view holds ("target").
inline constexpr Index kVertexTarget = 34962, kIndexTarget = 34963;

struct BufferView : Element {
  Index buffer = 0;
  std::size_t byteOffset = 0, byteLength = 0;
  std::size_t byteStride = 0;  // 0: the elements lie one behind the other
  Index target = 0;            // kVertexTarget, kIndexTarget; 0: not said
};

enum class ComponentType { kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126 };
enum class ElementType { kScalar, kVec2, kVec3, kVec4, kMat2, kMat3, kMat4 };

// Elements of an accessor that stand in for those of its buffer view, or for zeros.
struct Sparse : Object {
  struct Indices : Object {
    Index bufferView = 0;
    std::size_t byteOffset = 0;
    ComponentType componentType = ComponentType::kU32;
  };
  struct Values : Object {
    Index bufferView = 0;
    std::size_t byteOffset = 0;
  };
  std::size_t count = 0;
  Indices indices;
  Values values;
};

struct Accessor : Element {
  std::optional<Index> bufferView;  // none: zeros
  std::size_t byteOffset = 0;
  ComponentType componentType = ComponentType::kF32;
  bool normalized = false;
  std::size_t count = 0;
  ElementType type = ElementType::kScalar;
  std::vector<double> max, min;  // empty: not said. Raw values, before normalisation
  std::optional<Sparse> sparse;
};

// "POSITION", "JOINTS_0", ... -> accessor, in the order of the file.
class Attributes {
 public:
  Attributes() = default;
  explicit Attributes(std::vector<std::pair<std::string, Index>> list) : list_(std::move(list)) {}  // names differ

  std::optional<Index> find(std::string_view name) const;
  void set(std::string_view name, Index accessor);  // replaces the attribute, or appends it
  bool erase(std::string_view name);                // true if it was there

  bool empty() const { return list_.empty(); }
  auto begin() const { return list_.begin(); }  // pairs of name and accessor
  auto end() const { return list_.end(); }
  auto begin() { return list_.begin(); }
  auto end() { return list_.end(); }
  bool operator==(const Attributes&) const = default;

 private:
  std::vector<std::pair<std::string, Index>> list_;
};

// Kinds of primitives ("mode").
inline constexpr Index kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6;

struct Primitive : Object {
  Attributes attributes;
  std::optional<Index> indices, material;
  Index mode = kTriangles;
  std::vector<Attributes> targets;  // of blend shapes
};

struct Mesh : Element {
  std::vector<Primitive> primitives;
  std::vector<double> weights;  // of blend shapes; empty: zeros
};

struct Skin : Element {
  std::optional<Index> inverseBindMatrices;  // accessor
  std::optional<Index> skeleton;             // node
  std::vector<Index> joints;                 // nodes
};

struct Node : Element {
  std::optional<Index> camera, skin, mesh;
  std::vector<Index> children;
  // Of its own transform: a matrix, or parts.
  std::optional<Mat4> matrix;
  std::optional<Vec3> translation;
  std::optional<Vec4> rotation;  // quaternion x, y, z, w
  std::optional<Vec3> scale;
  std::vector<double> weights;  // of its mesh's blend shapes, overriding the mesh's own; empty: none

  bool hasTransform() const { return matrix || translation || rotation || scale; }
  void clearTransform();
};

struct Scene : Element {
  std::vector<Index> nodes;  // roots
};

struct AnimationSampler : Object {
  Index input = 0, output = 0;  // accessors: seconds, values
  Interpolation interpolation = Interpolation::kLinear;
};

struct AnimationChannel : Object {
  struct Target : Object {
    std::optional<Index> node;
    std::string path;  // "translation", "rotation", "scale", "weights"
  };
  Index sampler = 0;  // of the same animation
  Target target;
};

struct Animation : Element {
  std::vector<AnimationChannel> channels;
  std::vector<AnimationSampler> samplers;
};

struct Image : Element {
  std::string uri;
  std::string mimeType;
  std::optional<Index> bufferView;
};

// What a texture shows beyond its edges ("wrapS", "wrapT").
inline constexpr Index kClampToEdge = 33071, kMirroredRepeat = 33648, kRepeat = 10497;

struct Sampler : Element {  // of textures
  Index wrapS = kRepeat, wrapT = kRepeat;
};

struct Camera : Element {};

struct Texture : Element {
  std::optional<Index> sampler, source;  // source: image
};

// A material's use of a texture.
struct TextureUse : Object {
  Index index = 0;     // texture
  Index texCoord = 0;  // TEXCOORD_0, ...
};

struct MetallicRoughness : Object {
  std::optional<Vec4> baseColorFactor;  // none: white
  std::optional<TextureUse> baseColorTexture;
  double metallicFactor = 1, roughnessFactor = 1;
  std::optional<TextureUse> metallicRoughnessTexture;
};

struct Material : Element {
  std::optional<MetallicRoughness> pbrMetallicRoughness;
  std::optional<TextureUse> normalTexture, occlusionTexture, emissiveTexture;
  Vec3 emissiveFactor = Vec3::Zero();
  std::string alphaMode = "OPAQUE";  // "MASK", "BLEND"
  double alphaCutoff = 0.5;
  bool doubleSided = false;
};

// "asset": what wrote the document.
struct About : Object {
  std::string version = "2.0", generator;
};

struct Document : Object {
  About about;
  std::vector<std::string> extensionsUsed, extensionsRequired;
  std::optional<Index> scene;  // the one to show at first
  std::vector<Scene> scenes;
  std::vector<Node> nodes;
  std::vector<Camera> cameras;
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<Image> images;
  std::vector<Sampler> samplers;
  std::vector<Accessor> accessors;
  std::vector<BufferView> bufferViews;
  std::vector<Buffer> buffers;

  Index nodeCount() const { return static_cast<Index>(nodes.size()); }
};

}  // namespace gltf

// Appends an element to a list of a document; returns its number.
template <typename Element>
Index addElement(std::vector<Element>& list, Element element) {
  list.push_back(std::move(element));
  return static_cast<Index>(list.size() - 1);
}

}  // namespace limber
