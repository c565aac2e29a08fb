#include "limber/document/mesh/obj_vertices.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/import/import_obj.h"
#include "limber/document/scene/geometry.h"

namespace limber {

namespace {

void addVertex(std::string_view line, const std::string& name, ObjVertices& result) {
  const ObjVertexWords vertex(line);
  Vec3 numbers;  // what is no number is not finite either
  for (Eigen::Index i = 0; i < 3; ++i) {
    numbers[i] = objNumberOf(vertex.words[static_cast<std::size_t>(i)]).value_or(std::nan(""));
  }
  const Vec3f position = (numbers / vertex.w()).cast<float>();
  if (!position.allFinite()) {
    throw Error(ErrorCode::kBadData, fmt::format("vertex {} is not three finite numbers", result.positions.size() + 1),
                name);
  }
  if (result.positions.size() >= kNoIndex - 1) throw Error(ErrorCode::kLimit, "has too many vertices", name);
  result.positions.push_back(position);
}

// "7/1/3" names the seventh vertex, "-1" the last so far; vertices may come behind their faces.
void addFace(std::string_view line, const std::string& name, ObjVertices& result) {
  const auto badCorner = [&](std::string_view word) {
    return Error(ErrorCode::kBadData, fmt::format("a face names a vertex '{}'", word), name);
  };
  for (std::string_view word = nextObjWord(line); !word.empty(); word = nextObjWord(line)) {
    std::string_view corner = word;
    const std::int64_t number = takeObjNumber(corner);
    const std::int64_t vertex = number < 0 ? static_cast<std::int64_t>(result.positions.size()) + number : number - 1;
    if (vertex < 0 || vertex >= std::int64_t{kNoIndex}) throw badCorner(word.substr(0, 40));
    result.corners.push_back(static_cast<Index>(vertex));
  }
  result.corners.push_back(kNoIndex);
}

gltf::Attributes& attributesOf(Asset& asset, const PrimitiveInstance& instance) {
  return asset.document.meshes[instance.mesh].primitives[instance.primitive].attributes;
}

// The last of its colours, which has the numbers.
std::string numbersName(const gltf::Attributes& attributes) {
  return attributes.find("COLOR_1") ? "COLOR_1" : "COLOR_0";
}

std::vector<Index> takeNumbers(Asset& asset, const Geometry& geometry, std::size_t count) {
  std::vector<Index> result;
  const AccessorSweep unused(asset);
  for (const PrimitiveInstance& instance : geometry.instances) {
    gltf::Attributes& attributes = attributesOf(asset, instance);
    const std::string name = numbersName(attributes);
    const std::optional<Index> accessor = attributes.find(name);
    const std::vector<float> colors = accessor ? readFloats(asset, *accessor) : std::vector<float>();
    for (std::size_t i = 0; i + 3 < colors.size(); i += 4) {
      const std::optional<std::size_t> number = objNumber(colors[i], colors[i + 1], count);
      if (!number) break;
      result.push_back(static_cast<Index>(*number));
    }
    attributes.erase(name);
  }
  unused.sweep(asset);
  if (result.size() != geometry.positions.size()) {
    throw Error(ErrorCode::kUnsupported, "its vertices are not found again after reading", asset.name);
  }
  return result;
}

}  // namespace

ObjVertices readObjVertices(ByteSpan bytes, std::string_view name) {
  const std::string where(name);
  ObjVertices result;
  forEachObjLine(bytes, [&](std::string_view line) {
    const std::string_view kind = nextObjWord(line);
    if (kind == "v") addVertex(line, where, result);
    if (kind == "f") addFace(line, where, result);
  });
  for (const Index corner : result.corners) {
    if (corner != kNoIndex && corner >= result.positions.size()) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("a face names vertex {} of {}", std::uint64_t{corner} + 1, result.positions.size()),
                  where);
    }
  }
  return result;
}

ObjModel readObjModel(ByteSpan bytes, std::string_view name, const Resolver& resolver) {
  ObjModel result;
  result.vertices = readObjVertices(bytes, name);
  result.asset = readNumberedObj(bytes, name, resolver);
  const Geometry geometry = collectGeometry(result.asset);
  result.vertexOf = takeNumbers(result.asset, geometry, result.vertices.positions.size());
  return result;
}

}  // namespace limber
