#include "limber/pipeline/obj_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_sweep.h"
#include "limber/asset/geometry.h"
#include "limber/asset/json_text.h"
#include "limber/core/error.h"
#include "limber/core/parse_number.h"

namespace limber {

namespace {

constexpr const char* kColor = "COLOR_0";
constexpr Index kColorBase = 1 << 16;  // of the numbers that stand in a color: both digits are exact as floats

std::string_view takeWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line.remove_prefix(word.size());
  return word;
}

// Lines that a backslash continues are one.
std::string joinedLines(ByteSpan bytes) {
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    std::size_t end = at + 1;
    if (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') ++end;
    if (end > at + 1) std::fill(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end), ' ');
  }
  return text;
}

// Calls with the keyword of each line and what is behind it.
void forEachLine(std::string_view text, const std::function<void(std::string_view, std::string_view)>& visit) {
  while (!text.empty()) {
    const std::size_t length = text.find_first_of("\r\n");
    std::string_view line = text.substr(0, length);
    text.remove_prefix(length == std::string_view::npos ? text.size() : length + 1);
    const std::string_view keyword = takeWord(line);
    if (!keyword.empty()) visit(keyword, line);
  }
}

// x y z, x y z w or x y z r g b.
void addVertex(std::string_view line, const std::string& name, ObjVertices& result) {
  std::array<double, 6> numbers = {};
  std::size_t count = 0;
  while (count < numbers.size()) {
    const std::string_view word = takeWord(line);
    const char* at = word.data();
    const std::optional<double> number = parseNumber(at, word.data() + word.size());
    if (!number) break;
    numbers[count++] = *number;
  }
  const double w = count == 4 ? numbers[3] : 1;
  const Vec3f position = (Vec3(numbers[0], numbers[1], numbers[2]) / w).cast<float>();
  if (count < 3 || !position.allFinite()) {
    throw Error(ErrorCode::kBadData, fmt::format("vertex {} is not three finite numbers", result.positions.size() + 1),
                name);
  }
  if (count == 6 && result.colors.size() == result.positions.size()) {
    result.colors.push_back(Vec3(numbers[3], numbers[4], numbers[5]).cast<float>());
  }
  if (result.positions.size() >= kNoIndex - 1) throw Error(ErrorCode::kLimit, "has too many vertices", name);
  result.positions.push_back(position);
}

// "7/1/3" names the seventh vertex, "-1" the last so far; vertices may come behind their faces.
void addFace(std::string_view line, const std::string& name, ObjVertices& result) {
  const auto badCorner = [&](std::string_view word) {
    return Error(ErrorCode::kBadData, fmt::format("a face names a vertex '{}'", word), name);
  };
  line = line.substr(0, line.find('#'));
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
    const char* at = word.data();
    const std::optional<double> number = parseNumber(at, word.data() + word.size());
    const double vertex = !number ? -1 : *number < 0 ? *number + double(result.positions.size()) : *number - 1;
    if (!(vertex >= 0 && vertex < kNoIndex) || vertex != std::floor(vertex)) throw badCorner(word.substr(0, 40));
    result.corners.push_back(static_cast<Index>(vertex));
  }
  result.corners.push_back(kNoIndex);
}

ObjVertices verticesIn(std::string_view text, const std::string& name) {
  ObjVertices result;
  forEachLine(text, [&](std::string_view keyword, std::string_view line) {
    if (keyword == "v") addVertex(line, name, result);
    if (keyword == "f") addFace(line, name, result);
  });
  for (const Index corner : result.corners) {
    if (corner != kNoIndex && corner >= result.positions.size()) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("a face names vertex {} of {}", std::uint64_t{corner} + 1, result.positions.size()),
                  name);
    }
  }
  if (result.colors.size() < result.positions.size()) result.colors.clear();
  return result;
}

// How many vertices, texture coordinates and normals there are so far: of what a corner's numbers count, in their
// order.
using CornerCounts = std::array<Index, 3>;

// "7/-1/3" with numbers that count from the file's beginning; what is no number stays, for the importer to refuse.
std::string absoluteCorner(std::string_view corner, const CornerCounts& counts) {
  std::string result;
  for (const Index count : counts) {
    const std::string_view word = corner.substr(0, corner.find('/'));
    const char* at = word.data();
    const std::optional<double> number = parseNumber(at, word.data() + word.size());
    if (number && *number < 0 && *number >= -static_cast<double>(count) && *number == std::floor(*number)) {
      result += fmt::to_string(count + 1 - static_cast<Index>(-*number));
    } else {
      result += word;
    }
    corner.remove_prefix(word.size());
    if (corner.empty()) break;
    result += '/';
    corner.remove_prefix(1);
  }
  return result.append(corner);
}

// The importer reads neither a comment behind a face nor every number that counts backwards.
std::string absoluteFace(std::string_view line, const CornerCounts& counts) {
  std::string result = "f";
  line = line.substr(0, line.find('#'));
  for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line)) {
    result.append(" ").append(absoluteCorner(word, counts));
  }
  return result;
}

// The text with each vertex's number as its color: the importer splits meshes by material, joins vertices that are
// alike in everything, and tells no numbers.
std::string numberedText(std::string_view text, const ObjVertices& vertices) {
  std::string result;
  Index v = 0, uvs = 0, normals = 0;
  forEachLine(text, [&](std::string_view keyword, std::string_view line) {
    if (keyword == "f") {
      result.append(absoluteFace(line, {v, uvs, normals})).append("\n");
      return;
    }
    if (keyword != "v") {
      uvs += keyword == "vt" ? 1 : 0;
      normals += keyword == "vn" ? 1 : 0;
      result.append(keyword).append(line).append("\n");
      return;
    }
    const Vec3f& p = vertices.positions[v];
    fmt::format_to(std::back_inserter(result), "v {} {} {} {} {} 0\n", p.x(), p.y(), p.z(), v % kColorBase,
                   v / kColorBase);
    ++v;
  });
  return result;
}

gltf::Attributes& attributesOf(Asset& asset, const PrimitiveInstance& instance) {
  return asset.document.meshes[instance.mesh].primitives[instance.primitive].attributes;
}

std::vector<Index> vertexNumbersOf(Asset& asset, const Geometry& geometry, std::size_t count) {
  std::vector<Index> result;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const std::optional<Index> accessor = attributesOf(asset, instance).find(kColor);
    const std::vector<float> colors = accessor ? readFloats(asset, *accessor) : std::vector<float>();
    for (std::size_t i = 0; i + 3 < colors.size(); i += 4) {
      const double number = double{colors[i]} + double{kColorBase} * colors[i + 1];
      if (!(number >= 0 && number < static_cast<double>(count))) break;
      result.push_back(static_cast<Index>(number));
    }
  }
  if (result.size() != geometry.positions.size()) {
    throw Error(ErrorCode::kUnsupported, "its vertices are not found again after reading", asset.name);
  }
  return result;
}

// The file's own colors in place of the numbers, or none.
void restoreColors(const std::vector<Vec3f>& colors, const std::vector<Index>& vertexOf, const Geometry& geometry,
                   Asset& asset) {
  const AccessorSweep unused(asset);
  for (const PrimitiveInstance& instance : geometry.instances) {
    gltf::Attributes& attributes = attributesOf(asset, instance);
    attributes.erase(kColor);
    if (colors.empty()) continue;
    std::vector<float> values;
    for (Index i = instance.firstVertex; i < instance.firstVertex + instance.vertexCount; ++i) {
      const Vec3f& color = colors[vertexOf[i]];
      values.insert(values.end(), {color.x(), color.y(), color.z(), 1});
    }
    attributes.set(kColor, addFloatAccessor(asset, values, 4, kVertexTarget));
  }
  unused.sweep(asset);
}

}  // namespace

ObjVertices readObjVertices(ByteSpan bytes, std::string_view name) {
  return verticesIn(joinedLines(bytes), std::string(name));
}

NumberedObj readNumberedObj(ByteSpan bytes, std::string_view name, const Resolver& resolver) {
  const std::string text = joinedLines(bytes);
  NumberedObj result;
  result.vertices = verticesIn(text, std::string(name));
  result.asset = readAsset(asBytes(numberedText(text, result.vertices)), name, resolver);
  const Geometry geometry = collectGeometry(result.asset);
  result.vertexOf = vertexNumbersOf(result.asset, geometry, result.vertices.positions.size());
  restoreColors(result.vertices.colors, result.vertexOf, geometry, result.asset);
  return result;
}

}  // namespace limber
