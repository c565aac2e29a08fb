// Each type's members are listed once, in describe(): reading and writing both go through that list. Writing begins
// with the object as it was read and touches only members whose value there is another one.
#include "limber/document/gltf/gltf_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/file/read_bounds.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/json_access.h"

namespace limber::gltf {

namespace {

template <typename T>
struct Word {
  std::string_view text;
  T value;
};
constexpr std::array<Word<ElementType>, 7> kElementTypes = {{{"SCALAR", ElementType::kScalar},
                                                             {"VEC2", ElementType::kVec2},
                                                             {"VEC3", ElementType::kVec3},
                                                             {"VEC4", ElementType::kVec4},
                                                             {"MAT2", ElementType::kMat2},
                                                             {"MAT3", ElementType::kMat3},
                                                             {"MAT4", ElementType::kMat4}}};
constexpr std::array<Word<Interpolation>, 3> kInterpolations = {
    {{"STEP", Interpolation::kStep}, {"LINEAR", Interpolation::kLinear}, {"CUBICSPLINE", Interpolation::kCubic}}};

template <typename T, std::size_t n>
const Word<T>* wordOf(const std::array<Word<T>, n>& words, std::string_view text) {
  const auto found = std::find_if(words.begin(), words.end(), [&](const Word<T>& word) { return word.text == text; });
  return found == words.end() ? nullptr : &*found;
}

template <typename T, std::size_t n>
std::string textOf(const std::array<Word<T>, n>& words, T value) {
  return std::string(
      std::find_if(words.begin(), words.end(), [&](const Word<T>& w) { return w.value == value; })->text);
}

// One value out of JSON. What the rest of limber computes in float must fit it.
double readValue(const JsonView& json, double) {
  const double number = json.asNumber();
  if (std::abs(number) > std::numeric_limits<float>::max()) json.fail("is too large for a float");
  return number;
}
std::size_t readValue(const JsonView& json, std::size_t) {
  return json.asCount();
}
Index readValue(const JsonView& json, Index) {
  const std::size_t number = json.asCount();
  if (number >= kNoIndex) json.fail(fmt::format("is {}, but there is no such element", number));
  return static_cast<Index>(number);
}
bool readValue(const JsonView& json, bool) {
  if (!json.json().is_boolean()) json.fail("must be true or false");
  return json.json().get<bool>();
}
std::string readValue(const JsonView& json, const std::string&) {
  if (!json.json().is_string()) json.fail("must be a string");
  return json.json().get<std::string>();
}
ComponentType readValue(const JsonView& json, ComponentType) {
  const std::size_t code = json.asCount();
  constexpr std::array<std::size_t, 6> kCodes = {5120, 5121, 5122, 5123, 5125, 5126};
  if (std::find(kCodes.begin(), kCodes.end(), code) == kCodes.end()) {
    json.fail(fmt::format("is {}, which is no component type", code));
  }
  return static_cast<ComponentType>(code);
}
ElementType readValue(const JsonView& json, ElementType) {
  const auto* word =
      json.json().is_string() ? wordOf(kElementTypes, json.json().get_ref<const std::string&>()) : nullptr;
  if (word == nullptr) json.fail("is missing or no element type");
  return word->value;
}
Interpolation readValue(const JsonView& json, Interpolation byDefault) {
  const auto* word = wordOf(kInterpolations, readValue(json, std::string()));
  return word == nullptr ? byDefault : word->value;
}
template <int rows, int columns>
Eigen::Matrix<double, rows, columns> readValue(const JsonView& json, const Eigen::Matrix<double, rows, columns>&) {
  constexpr std::size_t kCount = rows * columns;
  if (!json.json().is_array()) json.fail("must be an array");
  if (json.size() != kCount) json.fail(fmt::format("must have {} numbers and has {}", kCount, json.size()));
  Eigen::Matrix<double, rows, columns> result;
  for (std::size_t i = 0; i < kCount; ++i) result.data()[i] = readValue(json[i], double());  // column by column
  return result;
}
Attributes readValue(const JsonView& json, const Attributes&) {
  json.requireObject();
  std::vector<std::pair<std::string, Index>> list;
  json.forEachMember(
      [&](std::string_view name, const JsonView& accessor) { list.emplace_back(name, readValue(accessor, Index())); });
  return Attributes(std::move(list));
}
template <typename T>
std::vector<T> readValue(const JsonView& json, const std::vector<T>&) {
  if (!json.json().is_array()) json.fail("must be an array");
  std::vector<T> result;
  result.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) result.push_back(readValue(json[i], T()));
  return result;
}
template <typename T>
std::optional<T> readValue(const JsonView& json, const std::optional<T>&) {
  return readValue(json, T());
}

// And back. Numbers that are whole are written as such where they mean counts.
Json valueJson(double value) {
  return value;
}
Json valueJson(std::size_t value) {
  return value;
}
Json valueJson(Index value) {
  return value;
}
Json valueJson(bool value) {
  return value;
}
Json valueJson(const std::string& value) {
  return value;
}
Json valueJson(ComponentType value) {
  return static_cast<int>(value);
}
Json valueJson(ElementType value) {
  return textOf(kElementTypes, value);
}
Json valueJson(Interpolation value) {
  return textOf(kInterpolations, value);
}
template <int rows, int columns>
Json valueJson(const Eigen::Matrix<double, rows, columns>& value) {
  return std::vector<double>(value.data(), value.data() + rows * columns);
}
Json valueJson(const Attributes& value) {
  Json result = Json::object();
  // The vector below an ordered_map: its own emplace would search for the key each time.
  Json::object_t::Container& members = result.get_ref<Json::object_t&>();
  for (const auto& [name, accessor] : value) members.emplace_back(name, accessor);
  return result;
}
template <typename T>
Json valueJson(const std::vector<T>& value) {
  Json result = Json::array();
  for (const T& element : value) result.push_back(valueJson(element));
  return result;
}
template <typename T>
Json valueJson(const std::optional<T>& value) {
  return valueJson(*value);
}

template <typename T>
bool same(const T& a, const T& b) {
  return a == b;
}
// Number by number: comparing the optionals, g++ 12 warns of what is in an empty one.
template <int rows, int columns>
bool same(const std::optional<Eigen::Matrix<double, rows, columns>>& a,
          const std::optional<Eigen::Matrix<double, rows, columns>>& b) {
  return a.has_value() == b.has_value() && (!a || std::equal(a->data(), a->data() + a->size(), b->data()));
}

enum class Need {
  kRequired,   // missing or wrong: an error
  kOptional,   // missing: the default; wrong: an error
  kTolerated,  // missing or wrong: the default
};

// Takes an object's members out of its JSON. Objects below it are moved out; what is left is kept.
class Reader {
 public:
  // objectsLeft  that lists may still hold
  Reader(Json& json, const JsonView& view, std::size_t& objectsLeft)
      : json_(json), view_(view), objectsLeft_(objectsLeft) {
    view_.requireObject();
  }

  template <typename T>
  void value(const char* key, T& member, const T& byDefault = T(), Need need = Need::kOptional) {
    const JsonView found = view_.member(key);
    member = byDefault;
    if (!found.exists()) {
      if (need == Need::kRequired) found.fail("is missing");
      return;
    }
    if (need != Need::kTolerated) {
      member = readValue(found, byDefault);
      if constexpr (std::is_same_v<T, std::string>) {
        if (!member.empty()) *find(key) = nullptr;  // may be a data URI of megabytes
      }
      return;
    }
    try {
      member = readValue(found, byDefault);
    } catch (const Error&) {
      // stays where it is, unread
    }
  }
  template <typename T>
  void required(const char* key, T& member) {
    value(key, member, T(), Need::kRequired);
  }
  template <typename T>
  void tolerated(const char* key, T& member, const T& byDefault = T()) {
    value(key, member, byDefault, Need::kTolerated);
  }

  void bounds(const char* key, std::vector<double>& member, ComponentType) { tolerated(key, member); }

  template <typename T>
  void object(const char* key, T& member, Need need = Need::kOptional);
  template <typename T>
  void object(const char* key, std::optional<T>& member) {
    if (view_.object(key).exists()) object(key, member.emplace());
  }
  template <typename T>
  void list(const char* key, std::vector<T>& members, Need need = Need::kOptional);

  template <typename T>
  void rest(T& object) {
    if constexpr (std::is_base_of_v<Element, T>) view_.object("extensions");
    // In smaller objects another type than an object's is left where it is.
    if (Json* all = find("extensions"); all != nullptr && all->is_object()) {
      object.extensions = KeptJson(std::exchange(*all, nullptr));
    }
    if (Json* all = find("extras")) object.extras = KeptJson(std::exchange(*all, nullptr));
    object.asRead = KeptJson(std::move(json_));
  }

 private:
  Json* find(const char* key) {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }

  Json& json_;
  JsonView view_;  // of json_
  std::size_t& objectsLeft_;
};

// Brings an object's JSON to what its members are now.
class Writer {
 public:
  explicit Writer(const Object& object) {
    if (!object.asRead.exists()) return;
    for (const auto& [key, value] : object.asRead->get_ref<const Json::object_t&>()) members_.emplace_back(key, value);
  }

  // True where the JSON had another value.
  template <typename T>
  bool value(const char* key, const T& member, const T& byDefault = T(), Need need = Need::kOptional) {
    const Json* found = find(key);
    if constexpr (std::is_same_v<T, std::string>) {
      if (need != Need::kTolerated && found != nullptr && found->is_null()) {  // reading took the text out
        member.empty() ? erase(key) : set(key, member);
        return false;
      }
    }
    if (same(member, found != nullptr ? valueIn(*found, byDefault) : byDefault)) {
      if (found == nullptr && need == Need::kRequired) set(key, valueJson(member));
      return false;
    }
    if (member == byDefault && need != Need::kRequired) {
      erase(key);
    } else {
      set(key, valueJson(member));
    }
    return true;
  }
  template <typename T>
  void required(const char* key, const T& member) {
    value(key, member, T(), Need::kRequired);
  }
  template <typename T>
  void tolerated(const char* key, const T& member, const T& byDefault = T()) {
    value(key, member, byDefault, Need::kTolerated);
  }

  // Whole numbers stay so in the text.
  void bounds(const char* key, const std::vector<double>& member, ComponentType type) {
    if (!value(key, member) || type == ComponentType::kF32 || member.empty()) return;
    set(key, std::vector<std::int64_t>(member.begin(), member.end()));
  }

  template <typename T>
  void object(const char* key, const T& member, Need need = Need::kOptional);
  template <typename T>
  void object(const char* key, const std::optional<T>& member) {
    if (member) {
      object(key, *member, Need::kRequired);
    } else {
      erase(key);
    }
  }
  template <typename T>
  void list(const char* key, const std::vector<T>& members, Need need = Need::kOptional);

  void rest(const Object& object) {
    kept("extensions", object.extensions);
    kept("extras", object.extras);
  }

  Json take() {
    Json result = Json::object();
    // The vector below an ordered_map: its own emplace would search for the key each time.
    Json::object_t::Container& target = result.get_ref<Json::object_t&>();
    target.reserve(members_.size());
    for (auto& [key, value] : members_) target.emplace_back(std::move(key), std::move(value));
    return result;
  }

 private:
  // What reading made of a member.
  template <typename T>
  static T valueIn(const Json& json, const T& byDefault) {
    try {
      return readValue(JsonView(json), byDefault);
    } catch (const Error&) {
      return byDefault;
    }
  }

  // Members are looked for in their usual order, so a new one goes behind the last that was met.
  Json* find(const char* key) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (members_[i].first != key) continue;
      next_ = i + 1;
      return &members_[i].second;
    }
    return nullptr;
  }
  void set(const char* key, Json value) {
    if (Json* found = find(key)) {
      *found = std::move(value);
    } else {
      members_.emplace(members_.begin() + static_cast<std::ptrdiff_t>(next_++), key, std::move(value));
    }
  }
  void erase(const char* key) {
    if (find(key) != nullptr) members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(--next_));
  }
  void kept(const char* key, const KeptJson& value) {
    const Json* found = find(key);
    if (found == nullptr) next_ = members_.size();
    if (value.exists()) {
      set(key, *value);
    } else if (found != nullptr && found->is_null()) {  // reading took it out
      erase(key);
    }
  }

  std::vector<std::pair<std::string, Json>> members_;
  std::size_t next_ = 0;  // where a new member goes
};

// The members of each type, in the order in which a new object has them.
template <typename Visit>
void describe(Visit& visit, About& about) {
  visit.required("version", about.version);
  visit.tolerated("generator", about.generator);
}

template <typename Visit>
void describe(Visit& visit, Buffer& buffer) {
  visit.value("name", buffer.name);
  visit.value("uri", buffer.uri);
  visit.required("byteLength", buffer.byteLength);
}

template <typename Visit>
void describe(Visit& visit, BufferView& view) {
  visit.value("name", view.name);
  visit.required("buffer", view.buffer);
  visit.value("byteOffset", view.byteOffset);
  visit.required("byteLength", view.byteLength);
  visit.value("byteStride", view.byteStride);
  visit.tolerated("target", view.target);
}

template <typename Visit>
void describe(Visit& visit, Sparse::Indices& indices) {
  visit.required("bufferView", indices.bufferView);
  visit.value("byteOffset", indices.byteOffset);
  visit.required("componentType", indices.componentType);
}

template <typename Visit>
void describe(Visit& visit, Sparse::Values& values) {
  visit.required("bufferView", values.bufferView);
  visit.value("byteOffset", values.byteOffset);
}

template <typename Visit>
void describe(Visit& visit, Sparse& sparse) {
  visit.required("count", sparse.count);
  visit.object("indices", sparse.indices, Need::kRequired);
  visit.object("values", sparse.values, Need::kRequired);
}

template <typename Visit>
void describe(Visit& visit, Accessor& accessor) {
  visit.value("name", accessor.name);
  visit.value("bufferView", accessor.bufferView);
  visit.value("byteOffset", accessor.byteOffset);
  visit.required("componentType", accessor.componentType);
  visit.required("count", accessor.count);
  visit.required("type", accessor.type);
  visit.value("normalized", accessor.normalized);
  visit.bounds("min", accessor.min, accessor.componentType);
  visit.bounds("max", accessor.max, accessor.componentType);
  visit.object("sparse", accessor.sparse);
}

template <typename Visit>
void describe(Visit& visit, Primitive& primitive) {
  visit.required("attributes", primitive.attributes);
  visit.value("indices", primitive.indices);
  visit.value("material", primitive.material);
  visit.value("mode", primitive.mode, kTriangles);
  visit.value("targets", primitive.targets);
}

template <typename Visit>
void describe(Visit& visit, Mesh& mesh) {
  visit.value("name", mesh.name);
  visit.list("primitives", mesh.primitives, Need::kRequired);
  visit.tolerated("weights", mesh.weights);
}

template <typename Visit>
void describe(Visit& visit, Skin& skin) {
  visit.value("name", skin.name);
  visit.value("inverseBindMatrices", skin.inverseBindMatrices);
  visit.value("skeleton", skin.skeleton);
  visit.required("joints", skin.joints);
}

template <typename Visit>
void describe(Visit& visit, Node& node) {
  visit.value("name", node.name);
  visit.value("camera", node.camera);
  visit.value("mesh", node.mesh);
  visit.value("skin", node.skin);
  visit.value("matrix", node.matrix);
  visit.value("translation", node.translation);
  visit.value("rotation", node.rotation);
  visit.value("scale", node.scale);
  visit.tolerated("weights", node.weights);
  visit.value("children", node.children);
}

template <typename Visit>
void describe(Visit& visit, Scene& scene) {
  visit.value("name", scene.name);
  visit.value("nodes", scene.nodes);
}

template <typename Visit>
void describe(Visit& visit, AnimationSampler& sampler) {
  visit.required("input", sampler.input);
  visit.tolerated("interpolation", sampler.interpolation, Interpolation::kLinear);
  visit.required("output", sampler.output);
}

template <typename Visit>
void describe(Visit& visit, AnimationChannel::Target& target) {
  visit.value("node", target.node);
  visit.value("path", target.path);
}

template <typename Visit>
void describe(Visit& visit, AnimationChannel& channel) {
  visit.required("sampler", channel.sampler);
  visit.object("target", channel.target, Need::kRequired);
}

template <typename Visit>
void describe(Visit& visit, Animation& animation) {
  visit.value("name", animation.name);
  visit.list("channels", animation.channels);
  visit.list("samplers", animation.samplers);
}

template <typename Visit>
void describe(Visit& visit, Image& image) {
  visit.value("name", image.name);
  visit.value("uri", image.uri);
  visit.value("bufferView", image.bufferView);
  visit.value("mimeType", image.mimeType);
}

template <typename Visit>
void describe(Visit& visit, Sampler& sampler) {
  visit.value("name", sampler.name);
  visit.tolerated("wrapS", sampler.wrapS, kRepeat);
  visit.tolerated("wrapT", sampler.wrapT, kRepeat);
}

template <typename Visit>
void describe(Visit& visit, Camera& camera) {
  visit.value("name", camera.name);
}

template <typename Visit>
void describe(Visit& visit, Texture& texture) {
  visit.value("name", texture.name);
  visit.value("sampler", texture.sampler);
  visit.value("source", texture.source);
}

template <typename Visit>
void describe(Visit& visit, TextureUse& use) {
  visit.required("index", use.index);
  visit.tolerated("texCoord", use.texCoord);
}

template <typename Visit>
void describe(Visit& visit, MetallicRoughness& material) {
  visit.value("baseColorFactor", material.baseColorFactor, MetallicRoughness().baseColorFactor);
  visit.object("baseColorTexture", material.baseColorTexture);
  visit.tolerated("metallicFactor", material.metallicFactor, 1.0);
  visit.tolerated("roughnessFactor", material.roughnessFactor, 1.0);
  visit.object("metallicRoughnessTexture", material.metallicRoughnessTexture);
}

template <typename Visit>
void describe(Visit& visit, Material& material) {
  visit.value("name", material.name);
  visit.object("pbrMetallicRoughness", material.pbrMetallicRoughness);
  visit.object("normalTexture", material.normalTexture);
  visit.object("occlusionTexture", material.occlusionTexture);
  visit.object("emissiveTexture", material.emissiveTexture);
  visit.tolerated("emissiveFactor", material.emissiveFactor, Material().emissiveFactor);
  visit.tolerated("alphaMode", material.alphaMode, Material().alphaMode);
  visit.tolerated("alphaCutoff", material.alphaCutoff, Material().alphaCutoff);
  visit.tolerated("doubleSided", material.doubleSided);
}

template <typename Visit>
void describe(Visit& visit, Document& document) {
  visit.object("asset", document.about, Need::kRequired);
  visit.value("extensionsUsed", document.extensionsUsed);
  visit.value("extensionsRequired", document.extensionsRequired);
  visit.value("scene", document.scene);
  visit.list("scenes", document.scenes);
  visit.list("nodes", document.nodes);
  visit.list("cameras", document.cameras);
  visit.list("meshes", document.meshes);
  visit.list("skins", document.skins);
  visit.list("animations", document.animations);
  visit.list("materials", document.materials);
  visit.list("textures", document.textures);
  visit.list("images", document.images);
  visit.list("samplers", document.samplers);
  visit.list("accessors", document.accessors);
  visit.list("bufferViews", document.bufferViews);
  visit.list("buffers", document.buffers);
}

template <typename T>
void read(T& object, Json& json, const JsonView& view, std::size_t& objectsLeft) {
  Reader reader(json, view, objectsLeft);
  describe(reader, object);
  reader.rest(object);
}

template <typename T>
void Reader::object(const char* key, T& member, Need need) {
  const JsonView found = view_.object(key);
  if (found.exists()) {
    read(member, *find(key), found, objectsLeft_);
    *find(key) = nullptr;
  } else if (need == Need::kRequired) {
    found.fail("is missing");
  }
}

template <typename T>
void Reader::list(const char* key, std::vector<T>& members, Need need) {
  const JsonView found = view_.array(key);
  if (!found.exists()) {
    if (need == Need::kRequired) found.fail("is missing");
    return;
  }
  Json& elements = *find(key);
  if (elements.size() > objectsLeft_) {
    throw Error(
        ErrorCode::kLimit,
        fmt::format("has {} elements, with those before more than the length of the JSON explains", elements.size()),
        found.path(), "export the model without empty elements");
  }
  objectsLeft_ -= elements.size();
  members.resize(elements.size());
  for (std::size_t i = 0; i < members.size(); ++i) read(members[i], elements[i], found[i], objectsLeft_);
  if (!members.empty()) elements = nullptr;
}

template <typename T>
Json written(const T& object) {
  Writer writer(object);
  describe(writer, const_cast<T&>(object));  // a writer takes all members as const
  writer.rest(object);
  return writer.take();
}

template <typename T>
void Writer::object(const char* key, const T& member, Need) {
  set(key, written(member));
}

template <typename T>
void Writer::list(const char* key, const std::vector<T>& members, Need need) {
  const Json* found = find(key);
  if (!members.empty()) {
    Json list = Json::array();
    for (const T& member : members) list.push_back(written(member));
    set(key, std::move(list));
  } else if (need == Need::kRequired) {
    set(key, Json::array());
  } else if (found != nullptr && found->is_null()) {
    erase(key);  // it became empty; a list that was empty stays
  }
}

// Major version of "2.0"; nothing if the text is no version.
std::optional<int> majorVersion(std::string_view version) {
  int major = 0;
  const auto [end, problem] = std::from_chars(version.data(), version.data() + version.size(), major);
  if (problem != std::errc() || end == version.data() + version.size() || *end != '.') return std::nullopt;
  return major;
}

void checkVersion(const JsonView& root) {
  const JsonView asset = root.object("asset");
  if (!asset.exists()) root.fail("is no glTF: it has no \"asset\" object");
  const std::string_view version = asset.text("version"), minimum = asset.text("minVersion", "2.0");
  const std::optional<int> major = majorVersion(version);
  if (!major) asset.member("version").fail("is missing or no version");
  if (*major == 2 && minimum == "2.0") return;
  throw Error(ErrorCode::kUnsupported,
              fmt::format("is glTF {}, limber reads glTF 2.0", shortened(*major == 2 ? minimum : version)), {},
              "export the model as glTF 2.0");
}

}  // namespace

Document documentOf(Json json, std::size_t textSize) {
  const JsonView root(json);
  root.requireObject();
  checkVersion(root);
  Document document;
  std::size_t objectsLeft = static_cast<std::size_t>(read_bounds::kListed.of(textSize / read_bounds::kBytesListed));
  read(document, json, root, objectsLeft);
  return document;
}

Json jsonOf(const Document& document) {
  return written(document);
}

}  // namespace limber::gltf
