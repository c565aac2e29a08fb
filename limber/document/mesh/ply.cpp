#include "limber/document/mesh/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/bits.h"
#include "limber/core/srgb.h"
#include "limber/core/text/parse_number.h"
#include "limber/document/embedded_texture.h"
#include "limber/document/mesh/plain_mesh.h"
#include "limber/document/mesh/triangulate_polygon.h"
#include "limber/document/side_file.h"

namespace limber {

namespace {

enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct ScalarName {
  std::string_view name, longName;
  ScalarType type;
};
constexpr ScalarName kScalars[] = {
    {"char", "int8", ScalarType::kInt8},      {"uchar", "uint8", ScalarType::kUint8},
    {"short", "int16", ScalarType::kInt16},   {"ushort", "uint16", ScalarType::kUint16},
    {"int", "int32", ScalarType::kInt32},     {"uint", "uint32", ScalarType::kUint32},
    {"float", "float32", ScalarType::kFloat}, {"double", "float64", ScalarType::kDouble},
};

struct Property {
  std::string name;
  ScalarType type = ScalarType::kFloat;
  std::optional<ScalarType> countType;  // of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
  std::string texture;     // empty: none
  std::size_t length = 0;  // with the end of its last line
};

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorCode::kBadData, why);
}

ScalarType scalarNamed(const std::string& name) {
  for (const ScalarName& scalar : kScalars) {
    if (scalar.name == name || scalar.longName == name) return scalar.type;
  }
  refuse(fmt::format("it has numbers of a type \"{}\"", name.substr(0, 40)));
}

Property propertyOf(std::istringstream& words) {
  Property property;
  std::string type;
  words >> type;
  if (type == "list") {
    words >> type;
    property.countType = scalarNamed(type);
    words >> type;
  }
  property.type = scalarNamed(type);
  words >> property.name;
  return property;
}

Element elementOf(std::istringstream& words, std::size_t fileSize) {
  Element element;
  words >> element.name;
  if (!(words >> element.count) || element.count > fileSize) {  // an element takes a byte at least
    refuse("it announces more elements than it can hold");
  }
  return element;
}

Header parseHeader(std::string_view file) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  Header header;
  for (bool first = true; header.length < std::min(file.size(), kLongest); first = false) {
    const std::size_t end = file.find_first_of("\r\n", header.length);
    if (end == std::string_view::npos) break;
    std::istringstream words{std::string(file.substr(header.length, end - header.length))};
    // Old files end lines by \r alone: then no \n is part of the end.
    header.length = end + (file.substr(end, 2) == "\r\n" ? 2 : 1);
    std::string word;
    words >> word;
    if (first || word == "obj_info") continue;
    if (word == "end_header") return header;
    if (word == "format") {
      words >> word;
      header.encoding = word == "ascii"                  ? Encoding::kText
                        : word == "binary_little_endian" ? Encoding::kLittleEndian
                        : word == "binary_big_endian"    ? Encoding::kBigEndian
                                                      : (refuse("its format is none of PLY's three"), Encoding::kText);
    } else if (word == "element") {
      header.elements.push_back(elementOf(words, file.size()));
    } else if (word == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(propertyOf(words));
    } else if (word == "comment" && words >> word && word == "TextureFile") {
      std::getline(words >> std::ws, header.texture);
    }
  }
  refuse("its header has no end");
}

// What follows the header, number by number.
class Body {
 public:
  Body(std::string_view bytes, Encoding encoding) : left_(bytes), encoding_(encoding) {}

  double next(ScalarType type) {
    if (encoding_ == Encoding::kText) return nextWord();
    switch (type) {
      case ScalarType::kInt8:
        return nextBytes<std::int8_t>();
      case ScalarType::kUint8:
        return nextBytes<std::uint8_t>();
      case ScalarType::kInt16:
        return nextBytes<std::int16_t>();
      case ScalarType::kUint16:
        return nextBytes<std::uint16_t>();
      case ScalarType::kInt32:
        return nextBytes<std::int32_t>();
      case ScalarType::kUint32:
        return nextBytes<std::uint32_t>();
      case ScalarType::kFloat:
        return nextBytes<float>();
      case ScalarType::kDouble:
        return nextBytes<double>();
    }
    return 0;
  }

  // A list's length; what is left holds that many numbers.
  std::size_t nextCount(ScalarType type) {
    const double count = next(type);
    if (!(count >= 0)) refuse("a list has a negative length");
    if (count > static_cast<double>(left_.size())) refuseCut();
    return static_cast<std::size_t>(count);
  }

 private:
  [[noreturn]] static void refuseCut() { refuse("it is cut off: it holds less than its header announces"); }

  double nextWord() {
    constexpr std::string_view kSpace = " \t\r\n\f\v";
    left_.remove_prefix(std::min(left_.find_first_not_of(kSpace), left_.size()));
    if (left_.empty()) refuseCut();
    const std::size_t length = std::min(left_.find_first_of(kSpace), left_.size());
    const char* at = left_.data();
    const std::optional<double> value = parseNumber(at, left_.data() + length);
    if (!value || at != left_.data() + length) {
      refuse(
          fmt::format("it has \"{}\" where a number is expected", left_.substr(0, std::min<std::size_t>(length, 20))));
    }
    left_.remove_prefix(length);
    return *value;
  }

  template <class Scalar>
  double nextBytes() {
    if (left_.size() < sizeof(Scalar)) refuseCut();
    std::array<char, sizeof(Scalar)> bytes;
    std::copy_n(left_.data(), sizeof(Scalar), bytes.data());
    if ((encoding_ == Encoding::kBigEndian) == (std::endian::native == std::endian::little)) {
      std::reverse(bytes.begin(), bytes.end());
    }
    left_.remove_prefix(sizeof(Scalar));
    return static_cast<double>(bitCast<Scalar>(bytes));
  }

  std::string_view left_;
  Encoding encoding_;
};

// Where a vertex's property goes.
struct Target {
  std::string_view name;
  std::string_view attribute;
  Index component;
};
constexpr Target kTargets[] = {
    {"x", "POSITION", 0},
    {"y", "POSITION", 1},
    {"z", "POSITION", 2},
    {"nx", "NORMAL", 0},
    {"ny", "NORMAL", 1},
    {"nz", "NORMAL", 2},
    {"u", "TEXCOORD_0", 0},
    {"v", "TEXCOORD_0", 1},
    {"s", "TEXCOORD_0", 0},
    {"t", "TEXCOORD_0", 1},
    {"texture_u", "TEXCOORD_0", 0},
    {"texture_v", "TEXCOORD_0", 1},
    {"texture_s", "TEXCOORD_0", 0},
    {"texture_t", "TEXCOORD_0", 1},
    {"red", "COLOR_0", 0},
    {"green", "COLOR_0", 1},
    {"blue", "COLOR_0", 2},
    {"alpha", "COLOR_0", 3},
    {"r", "COLOR_0", 0},
    {"g", "COLOR_0", 1},
    {"b", "COLOR_0", 2},
    {"a", "COLOR_0", 3},
    {"diffuse_red", "COLOR_0", 0},
    {"diffuse_green", "COLOR_0", 1},
    {"diffuse_blue", "COLOR_0", 2},
    {"diffuse_alpha", "COLOR_0", 3},
};

double colorScale(ScalarType type) {
  switch (type) {
    case ScalarType::kFloat:
    case ScalarType::kDouble:
      return 1;
    case ScalarType::kInt8:
    case ScalarType::kUint8:
      return 1.0 / 255;
    default:
      return 1.0 / 65535;
  }
}

// Of a colour's component as the file has it. Bytes, which most scans have, go by a table: powers would take as long as
// all the rest of reading.
double linearColor(double stored, double scale) {
  constexpr double kByteScale = 1.0 / 255;
  static const std::array<double, 256> kBytes = [] {
    std::array<double, 256> linear;
    for (std::size_t byte = 0; byte < linear.size(); ++byte) linear[byte] = linearOf(kByteScale * double(byte));
    return linear;
  }();
  const bool isByte = scale == kByteScale && stored >= 0 && stored <= 255 && stored == std::floor(stored);
  return isByte ? kBytes[static_cast<std::size_t>(stored)] : linearOf(scale * stored);
}

class PlyReader {
 public:
  PlyReader(ByteSpan bytes, const Resolver& resolver)
      : file_(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
        header_(parseHeader(file_)),
        body_(file_.substr(header_.length), header_.encoding),
        resolver_(resolver) {}

  Asset read() {
    for (const Element& element : header_.elements) {
      if (element.properties.empty() && element.count > 0) refuse("it has elements without properties");
      if (element.name == "vertex") {
        readVertices(element);
      } else if (element.name == "face" || element.name == "tristrips") {
        readFaces(element);
      } else {
        skip(element);
      }
    }
    if (vertexCount_ == 0) refuse("it has no vertices");
    return asset();
  }

 private:
  void readVertices(const Element& element) {
    if (!mesh_.attributes.empty()) refuse("it has vertices twice");
    attributeNamed("POSITION");
    if (element.count > std::numeric_limits<Index>::max()) refuse("it has more vertices than limber counts");
    vertexCount_ = static_cast<Index>(element.count);
    struct Column {
      std::size_t attribute;
      Index component;
      double scale;
      bool isSrgb;
    };
    std::vector<std::optional<Column>> columns;
    for (const Property& property : element.properties) {
      const auto target = std::find_if(std::begin(kTargets), std::end(kTargets),
                                       [&](const Target& known) { return known.name == property.name; });
      columns.emplace_back();
      if (target == std::end(kTargets) || property.countType) continue;
      const bool isColor = target->attribute == "COLOR_0";
      columns.back() = Column{attributeNamed(target->attribute), target->component,
                              isColor ? colorScale(property.type) : 1, isColor && target->component < 3};
    }
    for (const char* axis : {"x", "y", "z"}) {
      if (std::none_of(element.properties.begin(), element.properties.end(),
                       [&](const Property& property) { return property.name == axis && !property.countType; })) {
        refuse(fmt::format("its vertices have no {}", axis));
      }
    }
    for (Index v = 0; v < vertexCount_; ++v) {
      for (VertexAttribute& attribute : mesh_.attributes) {
        attribute.values.resize(attribute.values.size() + attribute.components,
                                attribute.name == "COLOR_0" ? 1.f : 0.f);
      }
      for (std::size_t p = 0; p < columns.size(); ++p) {
        const Property& property = element.properties[p];
        if (!columns[p]) {
          skip(property);
          continue;
        }
        VertexAttribute& attribute = mesh_.attributes[columns[p]->attribute];
        const double stored = body_.next(property.type), scale = columns[p]->scale;
        attribute.values[v * std::size_t{attribute.components} + columns[p]->component] =
            static_cast<float>(columns[p]->isSrgb ? linearColor(stored, scale) : scale * stored);
      }
      if (!positionOf(v).allFinite()) refuse(fmt::format("vertex {} has a position that is not a finite number", v));
    }
  }

  Vec3f positionOf(Index v) const { return Eigen::Map<const Vec3f>(&mesh_.attributes[0].values[3 * std::size_t{v}]); }

  // Its index in the mesh's attributes; that of the positions is the first.
  std::size_t attributeNamed(std::string_view name) {
    for (std::size_t i = 0; i < mesh_.attributes.size(); ++i) {
      if (mesh_.attributes[i].name == name) return i;
    }
    const Index components = name == "TEXCOORD_0" ? 2 : name == "COLOR_0" ? 4 : 3;
    mesh_.attributes.push_back({std::string(name), components, {}});
    return mesh_.attributes.size() - 1;
  }

  void readFaces(const Element& element) {
    if (mesh_.attributes.empty()) refuse("its faces come before its vertices");
    hasFaceColors_ = hasFaceColors_ || std::any_of(element.properties.begin(), element.properties.end(),
                                                   [](const Property& property) { return property.name == "red"; });
    std::vector<double> corners, positions;
    for (std::uint64_t face = 0; face < element.count; ++face) {
      corners.clear();
      positions.clear();
      for (const Property& property : element.properties) {
        const bool isCorners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (property.countType && (isCorners || property.name == "texcoord")) {
          std::vector<double>& list = isCorners ? corners : positions;
          for (std::size_t left = body_.nextCount(*property.countType); left > 0; --left) {
            list.push_back(body_.next(property.type));
          }
        } else {
          skip(property);
        }
      }
      element.name == "face" ? addFace(face, corners, positions) : addStrips(face, corners);
    }
  }

  Index vertexOf(std::uint64_t face, double corner) const {
    if (!(corner >= 0 && corner < vertexCount_)) {
      refuse(fmt::format("face {} names vertex {} of {}", face, corner, vertexCount_));
    }
    return static_cast<Index>(corner);
  }

  void addFace(std::uint64_t face, const std::vector<double>& corners, const std::vector<double>& positions) {
    if (corners.empty()) return;
    polygon_.clear();
    for (const double corner : corners) polygon_.push_back(vertexOf(face, corner));
    std::vector<Index>& list = mesh_.corners[std::min<std::size_t>(polygon_.size(), 3) - 1];
    if (polygon_.size() < 4) {
      list.insert(list.end(), polygon_.begin(), polygon_.end());
      if (polygon_.size() == 3) keepTexCoords(positions, {0, 1, 2});
      return;
    }
    std::vector<Vec3> points;
    for (const Index v : polygon_) {
      points.push_back(positionOf(v).cast<double>());
    }
    cut_.clear();
    triangulatePolygon(points, cut_);
    for (const std::array<Index, 3>& triangle : cut_) {
      for (const Index corner : triangle) list.push_back(polygon_[corner]);
      keepTexCoords(positions, triangle);
    }
  }

  // The texture coordinates of the triangle that was added last, whose corners are these of the polygon.
  void keepTexCoords(const std::vector<double>& positions, const std::array<Index, 3>& corners) {
    if (positions.empty() && texCoords_.empty()) return;
    texCoords_.resize(2 * (mesh_.corners[2].size() - 3), 0.f);
    for (const Index corner : corners) {
      const bool given = positions.size() >= 2 * (std::size_t{corner} + 1);
      texCoords_.push_back(given ? static_cast<float>(positions[2 * std::size_t{corner}]) : 0);
      texCoords_.push_back(given ? static_cast<float>(positions[2 * std::size_t{corner} + 1]) : 0);
    }
  }

  // Every other triangle of a strip is turned round; -1 ends a strip.
  void addStrips(std::uint64_t row, const std::vector<double>& corners) {
    std::vector<Index> strip;
    for (const double corner : corners) {
      if (corner < 0) {
        strip.clear();
        continue;
      }
      strip.push_back(vertexOf(row, corner));
      const std::size_t length = strip.size();
      if (length < 3) continue;
      const Index a = strip[length - 3], b = strip[length - 2], c = strip[length - 1];
      for (const Index v : length % 2 ? std::array{a, b, c} : std::array{b, a, c}) mesh_.corners[2].push_back(v);
      keepTexCoords({}, {0, 1, 2});
    }
  }

  void skip(const Property& property) {
    for (std::size_t left = property.countType ? body_.nextCount(*property.countType) : 1; left > 0; --left) {
      body_.next(property.type);
    }
  }

  void skip(const Element& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) skip(property);
    }
    if (element.count > 0) others_ += 1;
  }

  // Corners that have texture coordinates of their own are vertices of their own, until they are joined.
  void spreadCorners() {
    std::vector<Index>& corners = mesh_.corners[2];
    texCoords_.resize(2 * corners.size(), 0.f);
    std::erase_if(mesh_.attributes, [](const VertexAttribute& attribute) { return attribute.name == "TEXCOORD_0"; });
    for (VertexAttribute& attribute : mesh_.attributes) {
      std::vector<float> values;
      values.reserve(corners.size() * attribute.components);
      for (const Index v : corners) {
        const auto row = attribute.values.begin() + static_cast<std::ptrdiff_t>(v * std::size_t{attribute.components});
        values.insert(values.end(), row, row + attribute.components);
      }
      attribute.values = std::move(values);
    }
    mesh_.attributes.push_back({"TEXCOORD_0", 2, std::move(texCoords_)});
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<Index>(i);
    mesh_.corners[0].clear();
    mesh_.corners[1].clear();
  }

  Asset asset() {
    if (!texCoords_.empty()) spreadCorners();
    for (VertexAttribute& attribute : mesh_.attributes) {
      if (attribute.name != "TEXCOORD_0") continue;
      for (std::size_t i = 1; i < attribute.values.size(); i += 2) attribute.values[i] = 1 - attribute.values[i];
    }
    Asset asset;
    asset.format = "ply";
    gltf::Document& document = asset.document;
    document.about.generator = "limber";
    asset.warnings.add("face-colors", "colours of faces are left out, those of vertices are read", {},
                       hasFaceColors_ ? 1 : 0);
    asset.warnings.add("other-elements", "elements other than vertices, faces and strips are left out", {}, others_);
    gltf::Mesh mesh;
    mesh.primitives = addPlainMesh(asset, std::move(mesh_));
    const Index material = addElement(document.materials, materialOf(asset));
    for (gltf::Primitive& primitive : mesh.primitives) primitive.material = material;
    gltf::Node node;
    node.mesh = addElement(document.meshes, std::move(mesh));
    document.scene = 0;
    document.scenes.emplace_back().nodes = {addElement(document.nodes, std::move(node))};
    return asset;
  }

  // Scans are open: their surface is seen from both sides.
  gltf::Material materialOf(Asset& asset) const {
    gltf::Material material;
    material.doubleSided = true;
    material.pbrMetallicRoughness.emplace().metallicFactor = 0;
    if (header_.texture.empty()) return material;
    if (const auto texture = addEmbeddedTexture(asset, header_.texture, sideFile(resolver_, header_.texture))) {
      material.pbrMetallicRoughness->baseColorTexture.emplace().index = *texture;
    }
    return material;
  }

  std::string_view file_;
  Header header_;
  Body body_;
  const Resolver& resolver_;
  PlainMesh mesh_;
  Index vertexCount_ = 0;
  std::vector<float> texCoords_;  // texture coordinates by triangle corner
  std::size_t others_ = 0;
  bool hasFaceColors_ = false;
  std::vector<Index> polygon_;             // of the face in hand
  std::vector<std::array<Index, 3>> cut_;  // likewise
};

}  // namespace

bool looksLikePly(ByteSpan bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "ply", 3) == 0 && (bytes[3] == '\n' || bytes[3] == '\r');
}

Asset readPly(ByteSpan bytes, const Resolver& resolver) {
  try {
    return PlyReader(bytes, resolver).read();
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("cannot be read as PLY: {}", error.message()), error.where(), error.remedy());
  }
}

}  // namespace limber
