#include "limber/document/usd/usd_crate.h"

#include <array>
#include <concepts>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include <fmt/format.h>

#include "limber/core/file/bits.h"
#include "limber/document/usd/usd_integers.h"

namespace limber {

namespace {

// Numbers that OpenUSD gives to types of values (pxr/usd/sdf/crateDataTypes.h) and to kinds of specs.
enum class CrateType : std::uint8_t {
  kBool = 1,
  kInt = 3,
  kFloat = 8,
  kDouble = 9,
  kString = 10,
  kToken = 11,
  kAsset = 12,
  kMatrix4d = 15,
  kQuatf = 17,
  kVec2f = 20,
  kVec3f = 24,
  kVec3h = 25,
  kVec4f = 28,
  kTokenListOp = 32,
  kPathListOp = 34,
  kTokenVector = 41,
  kSpecifier = 42,
  kVariability = 44,
  kTimeSamples = 46,
  kDoubleVector = 48
};
enum class SpecKind : std::int32_t { kAttribute = 1, kPrim = 6, kPseudoRoot = 7, kRelationship = 8 };

constexpr std::uint64_t kIsArray = std::uint64_t{1} << 63, kIsInlined = std::uint64_t{1} << 62,
                        kIsCompressed = std::uint64_t{1} << 61;
constexpr std::size_t kBootSize = 88, kSectionNameSize = 16;
constexpr std::size_t kFewestPacked = 16;                              // shorter arrays are never packed
constexpr std::uint8_t kExplicitItems = 0x03, kPrependedItems = 0x20;  // what a list op begins with
constexpr std::int32_t kUniform = 1;

void append(std::uint64_t value, std::size_t size, Bytes& out) {
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void append32(std::uint32_t value, Bytes& out) {
  append(value, 4, out);
}
void append64(std::uint64_t value, Bytes& out) {
  append(value, 8, out);
}
void appendFloat(float value, Bytes& out) {
  append32(bitCast<std::uint32_t>(value + 0.0f), out);
}
void appendDouble(double value, Bytes& out) {
  append64(bitCast<std::uint64_t>(value + 0.0), out);
}
void appendHalf(float value, Bytes& out) {
  append(Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(value + 0.0f)), 2, out);
}
void appendBytes(ByteSpan bytes, Bytes& out) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

// Each thing's number, in the order in which they were first asked for.
template <typename Thing>
class Numbering {
 public:
  std::uint32_t of(const Thing& thing) {
    const auto [at, isNew] = numbers_.try_emplace(thing, static_cast<std::uint32_t>(things_.size()));
    if (isNew) things_.push_back(thing);
    return at->second;
  }
  const std::vector<Thing>& things() const { return things_; }

 private:
  std::map<Thing, std::uint32_t> numbers_;
  std::vector<Thing> things_;
};

// A node in the tree of paths: a prim or one of its properties.
struct PathNode {
  std::int32_t token = 0;  // of the name; negative for a property
  std::int32_t jump = 0;   // see jumpOf
};

class CrateWriter {
 public:
  Bytes write(const UsdStage& stage) {
    out_.assign(kBootSize, 0);
    token(std::string(kUsdRoot));  // number 0, which has no negative, must not be a property's
    numberPath("/", 0);
    const std::size_t root = nodes_.size();
    numberPaths(stage.root, "");
    nodes_[0].jump = kOnlyChild;
    nodes_[root].jump = nodes_.size() == root + 1 ? kLeaf : kOnlyChild;
    writePseudoRoot(stage);
    writePrim(stage.root, "");
    writeSections();
    return std::move(out_);
  }

 private:
  using Fields = std::vector<std::uint32_t>;  // their numbers

  // --- paths, numbered in the order of the tree ---
  static constexpr std::int32_t kOnlySibling = 0, kOnlyChild = -1, kLeaf = -2;

  void numberPath(const std::string& path, std::int32_t nameToken) {
    paths_.emplace(path, static_cast<std::uint32_t>(nodes_.size()));
    nodes_.push_back({nameToken, kOnlySibling});
  }
  void numberPaths(const UsdPrim& prim, const std::string& parent) {
    const std::string path = parent + "/" + prim.name;
    numberPath(path, static_cast<std::int32_t>(token(prim.name)));
    std::optional<std::size_t> last;
    for (const UsdProperty& property : prim.properties) {
      last = nodes_.size();
      numberPath(path + "." + property.name, -static_cast<std::int32_t>(token(property.name)));
    }
    for (const UsdPrim& child : prim.children) {
      last = nodes_.size();
      numberPaths(child, path);
      // What follows begins behind everything below the child.
      nodes_[*last].jump = nodes_.size() == *last + 1 ? kOnlySibling : static_cast<std::int32_t>(nodes_.size() - *last);
    }
    if (last) nodes_[*last].jump = nodes_[*last].jump == kOnlySibling ? kLeaf : kOnlyChild;
  }
  std::uint32_t pathNumber(const std::string& path) const {
    const auto at = paths_.find(path);
    if (at == paths_.end()) throw std::logic_error("usdCrate: nothing is at " + path);
    return at->second;
  }

  // --- specs and their fields ---
  void writePseudoRoot(const UsdStage& stage) {
    Fields fields;
    const auto add = [&](const char* name, std::uint64_t rep) { fields.push_back(field(name, rep)); };
    add("defaultPrim", inlined(CrateType::kToken, token(stage.root.name)));
    add("metersPerUnit", number(1));
    add("upAxis", inlined(CrateType::kToken, token("Y")));
    if (stage.endTimeCode > 0) {
      add("startTimeCode", number(0));
      add("endTimeCode", number(stage.endTimeCode));
      add("timeCodesPerSecond", number(stage.timeCodesPerSecond));
    }
    add("primChildren", tokenVector({stage.root.name}));
    addSpec("/", SpecKind::kPseudoRoot, std::move(fields));
  }

  void writePrim(const UsdPrim& prim, const std::string& parent) {
    const std::string path = parent + "/" + prim.name;
    Fields fields = {field("specifier", inlined(CrateType::kSpecifier, 0)),
                     field("typeName", inlined(CrateType::kToken, token(prim.type)))};
    if (!prim.schemas.empty()) {
      Bytes list = {kPrependedItems};
      appendBytes(tokensOf(prim.schemas), list);
      fields.push_back(field("apiSchemas", stored(CrateType::kTokenListOp, 0, list)));
    }
    if (!prim.displayName.empty()) {
      fields.push_back(field("displayName", inlined(CrateType::kString, strings_.of(token(prim.displayName)))));
    }
    std::vector<std::string> properties, children;
    for (const UsdProperty& property : prim.properties) properties.push_back(property.name);
    for (const UsdPrim& child : prim.children) children.push_back(child.name);
    if (!properties.empty()) fields.push_back(field("properties", tokenVector(properties)));
    if (!children.empty()) fields.push_back(field("primChildren", tokenVector(children)));
    addSpec(path, SpecKind::kPrim, std::move(fields));
    for (const UsdProperty& property : prim.properties) writeProperty(property, path + "." + property.name);
    for (const UsdPrim& child : prim.children) writePrim(child, path);
  }

  void writeProperty(const UsdProperty& property, const std::string& path) {
    const bool isRelationship = property.type.empty();
    type_ = property.type;
    Fields fields;
    const auto add = [&](const char* name, std::uint64_t rep) { fields.push_back(field(name, rep)); };
    if (!isRelationship) add("typeName", inlined(CrateType::kToken, token(property.type)));
    if (property.isUniform) add("variability", inlined(CrateType::kVariability, kUniform));
    if (property.elementSize) add("elementSize", rep(*property.elementSize));
    if (!property.interpolation.empty())
      add("interpolation", inlined(CrateType::kToken, token(property.interpolation)));
    if (!property.targets.empty()) {
      Bytes list = {kExplicitItems};
      append64(property.targets.size(), list);
      for (const std::string& target : property.targets) append32(pathNumber(target), list);
      add(isRelationship ? "targetPaths" : "connectionPaths", stored(CrateType::kPathListOp, 0, list));
    }
    if (const std::optional<std::uint64_t> rep = valueRep(property.value)) add("default", *rep);
    if (!property.samples.empty()) add("timeSamples", timeSamples(property.samples));
    addSpec(path, isRelationship ? SpecKind::kRelationship : SpecKind::kAttribute, std::move(fields));
  }

  void addSpec(const std::string& path, SpecKind kind, Fields fields) {
    const auto [at, isNew] = fieldSets_.try_emplace(fields, static_cast<std::int32_t>(fieldSetNumbers_.size()));
    if (isNew) {
      for (const std::uint32_t each : fields) fieldSetNumbers_.push_back(static_cast<std::int32_t>(each));
      fieldSetNumbers_.push_back(-1);
    }
    specPaths_.push_back(static_cast<std::int32_t>(pathNumber(path)));
    specFieldSets_.push_back(at->second);
    specKinds_.push_back(static_cast<std::int32_t>(kind));
  }

  std::uint32_t token(const std::string& text) { return tokens_.of(text); }
  std::uint32_t field(const char* name, std::uint64_t rep) { return fields_.of({token(name), rep}); }

  // --- values: 64 bits that hold one or say where it lies ---
  static std::uint64_t inlined(CrateType type, std::uint32_t value) {
    return kIsInlined | static_cast<std::uint64_t>(type) << 48 | value;
  }

  // Stores bytes out of line; equal ones are stored once.
  std::uint64_t stored(CrateType type, std::uint64_t flags, const Bytes& bytes) {
    const std::string content(bytes.begin(), bytes.end());
    std::uint64_t& rep = stored_[static_cast<std::uint64_t>(type) << 48 | flags][content];
    if (rep == 0) {
      out_.resize((out_.size() + 7) / 8 * 8, 0);
      rep = flags | static_cast<std::uint64_t>(type) << 48 | out_.size();
      appendBytes(bytes, out_);
    }
    return rep;
  }

  std::uint64_t number(double value) {
    Bytes bytes;
    appendDouble(value, bytes);
    return stored(CrateType::kDouble, 0, bytes);
  }

  Bytes tokensOf(const std::vector<std::string>& texts) {
    Bytes bytes;
    append64(texts.size(), bytes);
    for (const std::string& text : texts) append32(token(text), bytes);
    return bytes;
  }
  std::uint64_t tokenVector(const std::vector<std::string>& texts) {
    return stored(CrateType::kTokenVector, 0, tokensOf(texts));
  }

  std::uint64_t timeSamples(const std::vector<std::pair<double, UsdValue>>& samples) {
    Bytes times;
    append64(samples.size(), times);
    for (const auto& sample : samples) appendDouble(sample.first, times);
    // Two offsets from where they stand themselves; both parts follow at once.
    Bytes bytes;
    append64(8, bytes);
    append64(stored(CrateType::kDoubleVector, 0, times), bytes);
    append64(8, bytes);
    append64(samples.size(), bytes);
    for (const auto& sample : samples) append64(valueRep(sample.second).value(), bytes);
    return stored(CrateType::kTimeSamples, 0, bytes);
  }

  static CrateType typeOf(const Vec2f&) { return CrateType::kVec2f; }
  CrateType typeOf(const Vec3f&) const { return isHalf() ? CrateType::kVec3h : CrateType::kVec3f; }
  static CrateType typeOf(const Vec4f&) { return CrateType::kVec4f; }
  static CrateType typeOf(const Eigen::Quaternionf&) { return CrateType::kQuatf; }
  static CrateType typeOf(const Affine&) { return CrateType::kMatrix4d; }
  bool isHalf() const { return type_ == "half3[]"; }

  template <int Size>
  void appendOne(const Eigen::Matrix<float, Size, 1>& value, Bytes& out) const {
    for (const float part : value) isHalf() ? appendHalf(part, out) : appendFloat(part, out);
  }
  static void appendOne(const Eigen::Quaternionf& value, Bytes& out) {
    for (const float part : value.coeffs()) appendFloat(part, out);  // w last
  }
  // Row by row of what USD calls the matrix, which is the transposed.
  static void appendOne(const Affine& value, Bytes& out) {
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) appendDouble(value.matrix()(row, column), out);
    }
  }

  static void appendPacked(std::span<const std::int32_t> values, Bytes& out) {
    const Bytes packed = packUsdIntegers(values);
    append64(packed.size(), out);
    appendBytes(packed, out);
  }

  // Values out of a table, where they are few enough for that to be smaller.
  static bool appendByTable(const std::vector<float>& values, Bytes& out) {
    constexpr std::size_t kMaxInTable = 1024;  // OpenUSD's
    if (values.size() < kFewestPacked) return false;
    Numbering<std::uint32_t> table;
    std::vector<std::int32_t> numbers;
    for (const float value : values) {
      numbers.push_back(static_cast<std::int32_t>(table.of(bitCast<std::uint32_t>(value + 0.0f))));
      if (table.things().size() > std::min(values.size() / 4, kMaxInTable)) return false;
    }
    out.push_back('t');
    append32(static_cast<std::uint32_t>(table.things().size()), out);
    for (const std::uint32_t value : table.things()) append32(value, out);
    appendPacked(numbers, out);
    return true;
  }

  std::optional<std::uint64_t> rep(std::monostate) { return std::nullopt; }
  std::uint64_t rep(bool value) { return inlined(CrateType::kBool, value ? 1 : 0); }
  std::uint64_t rep(int value) { return inlined(CrateType::kInt, static_cast<std::uint32_t>(value)); }
  std::uint64_t rep(float value) { return inlined(CrateType::kFloat, bitCast<std::uint32_t>(value + 0.0f)); }
  std::uint64_t rep(const std::string& value) {
    if (type_ == "string") return inlined(CrateType::kString, strings_.of(token(value)));
    return inlined(type_ == "asset" ? CrateType::kAsset : CrateType::kToken, token(value));
  }
  std::uint64_t rep(const std::vector<std::string>& values) {
    return values.empty() ? emptyArray(CrateType::kToken) : stored(CrateType::kToken, kIsArray, tokensOf(values));
  }
  std::uint64_t rep(const std::vector<int>& values) {
    Bytes bytes;
    append64(values.size(), bytes);
    if (values.size() >= kFewestPacked) {
      appendPacked(values, bytes);
      return stored(CrateType::kInt, kIsArray | kIsCompressed, bytes);
    }
    for (const int value : values) append32(static_cast<std::uint32_t>(value), bytes);
    return values.empty() ? emptyArray(CrateType::kInt) : stored(CrateType::kInt, kIsArray, bytes);
  }
  std::uint64_t rep(const std::vector<float>& values) {
    Bytes bytes;
    append64(values.size(), bytes);
    if (appendByTable(values, bytes)) return stored(CrateType::kFloat, kIsArray | kIsCompressed, bytes);
    for (const float value : values) appendFloat(value, bytes);
    return values.empty() ? emptyArray(CrateType::kFloat) : stored(CrateType::kFloat, kIsArray, bytes);
  }
  template <typename Value>
  std::uint64_t rep(const Value& value) {
    Bytes bytes;
    appendOne(value, bytes);
    return stored(typeOf(value), 0, bytes);
  }
  template <typename Value>
  std::uint64_t rep(const std::vector<Value>& values) {
    if (values.empty()) return emptyArray(typeOf(Value()));
    Bytes bytes;
    append64(values.size(), bytes);
    for (const Value& value : values) appendOne(value, bytes);
    return stored(typeOf(values[0]), kIsArray, bytes);
  }
  static std::uint64_t emptyArray(CrateType type) { return kIsArray | static_cast<std::uint64_t>(type) << 48; }
  std::optional<std::uint64_t> valueRep(const UsdValue& value) {
    return std::visit([this](const auto& own) -> std::optional<std::uint64_t> { return rep(own); }, value);
  }

  // --- the sections behind the values, their table, and where that is ---
  void writeSections() {
    Bytes contents;
    section("TOKENS", contents, [&] {
      Bytes texts;
      for (const std::string& text : tokens_.things()) {
        appendBytes(asBytes(text), texts);
        texts.push_back(0);
      }
      append64(tokens_.things().size(), out_);
      append64(texts.size(), out_);
      const Bytes packed = packUsdBytes(texts);
      append64(packed.size(), out_);
      appendBytes(packed, out_);
    });
    section("STRINGS", contents, [&] {
      append64(strings_.things().size(), out_);
      for (const std::uint32_t each : strings_.things()) append32(each, out_);
    });
    section("FIELDS", contents, [&] {
      std::vector<std::int32_t> names;
      Bytes reps;
      for (const auto& [name, rep] : fields_.things()) {
        names.push_back(static_cast<std::int32_t>(name));
        append64(rep, reps);
      }
      append64(names.size(), out_);
      appendPacked(names, out_);
      const Bytes packed = packUsdBytes(reps);
      append64(packed.size(), out_);
      appendBytes(packed, out_);
    });
    section("FIELDSETS", contents, [&] {
      append64(fieldSetNumbers_.size(), out_);
      appendPacked(fieldSetNumbers_, out_);
    });
    section("PATHS", contents, [&] {
      std::vector<std::int32_t> numbers, names, jumps;
      for (const PathNode& node : nodes_) {
        numbers.push_back(static_cast<std::int32_t>(numbers.size()));
        names.push_back(node.token);
        jumps.push_back(node.jump);
      }
      append64(nodes_.size(), out_);
      append64(nodes_.size(), out_);
      for (const auto* list : {&numbers, &names, &jumps}) appendPacked(*list, out_);
    });
    section("SPECS", contents, [&] {
      append64(specPaths_.size(), out_);
      for (const auto* list : {&specPaths_, &specFieldSets_, &specKinds_}) appendPacked(*list, out_);
    });
    writeBoot(out_.size());
    append64(contents.size() / (kSectionNameSize + 16), out_);
    appendBytes(contents, out_);
  }

  template <typename Write>
  void section(std::string_view name, Bytes& contents, const Write& write) {
    const std::size_t start = out_.size();
    write();
    appendBytes(asBytes(name), contents);
    contents.resize(contents.size() + kSectionNameSize - name.size(), 0);
    append64(start, contents);
    append64(out_.size() - start, contents);
  }

  void writeBoot(std::size_t contentsAt) {
    Bytes boot;
    appendBytes(asBytes("PXR-USDC"), boot);
    for (const std::uint8_t part : {0, 8, 0, 0, 0, 0, 0, 0}) boot.push_back(part);
    append64(contentsAt, boot);
    std::copy(boot.begin(), boot.end(), out_.begin());
  }

  Bytes out_;
  Numbering<std::string> tokens_;
  Numbering<std::uint32_t> strings_;                                      // by their tokens
  Numbering<std::pair<std::uint32_t, std::uint64_t>> fields_;             // token of the name, value
  std::map<std::uint64_t, std::map<std::string, std::uint64_t>> stored_;  // by type and flags, by content
  std::map<Fields, std::int32_t> fieldSets_;                              // where each begins
  std::vector<std::int32_t> fieldSetNumbers_, specPaths_, specFieldSets_, specKinds_;
  std::vector<PathNode> nodes_;
  std::unordered_map<std::string, std::uint32_t> paths_;
  std::string_view type_;  // of the property that is being written
};

}  // namespace

Bytes usdCrate(const UsdStage& stage) {
  return CrateWriter().write(stage);
}

}  // namespace limber
