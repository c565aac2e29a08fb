#include "limber/document/fbx/import_fbx_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "limber/core/srgb.h"
#include "limber/document/fbx/records/fbx_values.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/mesh/triangulate_polygon.h"
#include "limber/document/scene/joined_primitive.h"
#include "limber/document/utf8.h"

namespace limber {

namespace {

struct FbxPolygons {
  std::vector<Vec3> points;        // control points
  std::vector<Index> corners;      // control point of each
  std::vector<Index> polygon;      // of each corner
  std::vector<Index> firstCorner;  // #polygons + 1
};

FbxPolygons readPolygons(const FbxNode& geometry) {
  FbxPolygons result;
  const std::vector<double> positions = fbxNumbers(geometry, "Vertices");
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    result.points.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
    if (!result.points.back().allFinite()) {
      throw Error(ErrorCode::kBadData, fmt::format("vertex {} has a position that is not a finite number", i / 3));
    }
  }
  const std::vector<std::int64_t> indices = fbxIntegers(geometry, "PolygonVertexIndex");
  result.firstCorner.push_back(0);
  Index polygons = 0;
  for (const std::int64_t index : indices) {
    const std::int64_t point = index < 0 ? -(index + 1) : index;  // the last of a polygon is ~index
    if (static_cast<std::uint64_t>(point) >= result.points.size()) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("polygon {} names vertex {} of {}", polygons, point, result.points.size()));
    }
    result.corners.push_back(static_cast<Index>(point));
    result.polygon.push_back(polygons);
    if (index >= 0) continue;
    result.firstCorner.push_back(static_cast<Index>(result.corners.size()));
    ++polygons;
  }
  if (result.firstCorner.back() != result.corners.size()) {
    result.firstCorner.push_back(static_cast<Index>(result.corners.size()));
  }
  return result;
}

// A layer of a geometry: rows of numbers for corners, points, polygons or all.
class Layer {
 public:
  Layer(const FbxNode& node, std::string_view values, std::string_view index, std::size_t components)
      : values_(fbxNumbers(node, values)), components_(components) {
    const std::string_view by = fbxChildText(node, "MappingInformationType");
    if (by == "ByVertice" || by == "ByVertex" || by == "ByControlPoint") by_ = By::kPoint;
    if (by == "ByPolygon") by_ = By::kPolygon;
    if (by == "AllSame") by_ = By::kAll;
    if (by == "ByPolygonVertex") by_ = By::kCorner;
    const std::string_view reference = fbxChildText(node, "ReferenceInformationType");
    if (reference == "IndexToDirect" || reference == "Index") {
      index_ = fbxIntegers(node, index);
      isIndexed_ = !index.empty() && node.find(index) != nullptr;
    }
  }

  bool isKnown() const { return by_ != By::kUnknown && !values_.empty(); }

  // The row of a corner; null where the file has none.
  const double* row(const FbxPolygons& polygons, Index corner) const {
    std::size_t slot = 0;
    if (by_ == By::kCorner) slot = corner;
    if (by_ == By::kPoint) slot = polygons.corners[corner];
    if (by_ == By::kPolygon) slot = polygons.polygon[corner];
    if (isIndexed_) {
      if (slot >= index_.size() || index_[slot] < 0) return nullptr;
      slot = static_cast<std::size_t>(index_[slot]);
    }
    return slot < values_.size() / components_ ? &values_[slot * components_] : nullptr;
  }

 private:
  enum class By { kUnknown, kCorner, kPoint, kPolygon, kAll };
  By by_ = By::kUnknown;
  std::vector<double> values_;
  std::vector<std::int64_t> index_;
  std::size_t components_;
  bool isIndexed_ = false;
};

Vec3 areaNormal(const FbxPolygons& polygons, Index polygon) {
  Vec3 normal = Vec3::Zero();
  const Index first = polygons.firstCorner[polygon], end = polygons.firstCorner[polygon + 1];
  const Vec3& origin = polygons.points[polygons.corners[first]];
  for (Index c = first + 1; c + 1 < end; ++c) {
    normal += (polygons.points[polygons.corners[c]] - origin).cross(polygons.points[polygons.corners[c + 1]] - origin);
  }
  return normal;
}

class FbxMeshBuilder {
 public:
  FbxMeshBuilder(Asset& asset, const FbxNode& geometry, std::string name, const FbxMeshPlan& plan, FbxBudget& budget)
      : asset_(asset),
        geometry_(geometry),
        name_(std::move(name)),
        plan_(plan),
        budget_(budget),
        polygons_(readPolygons(geometry)) {
    const Mat3 linear = plan.placement.linear();
    isMirrored_ = linear.determinant() < 0;
    const Mat3 inverse = linear.inverse();
    toNormals_ = inverse.allFinite() ? Mat3(inverse.transpose()) : Mat3(Mat3::Identity());
  }

  FbxMesh build() {
    makePositions();
    for (const FbxNode& child : geometry_.children) addLayer(child);
    makeTriangles();
    if (triangles_.empty()) return {};
    joinCorners();
    return {primitives(), std::move(textureSets_)};
  }

 private:
  void makePositions() {
    std::vector<Vec3f> placed;
    placed.reserve(polygons_.points.size());
    for (const Vec3& point : polygons_.points) {
      placed.push_back((plan_.placement * point).cast<float>());
      if (!placed.back().allFinite()) {
        throw Error(ErrorCode::kBadData, "a position is beyond what single precision can hold");
      }
    }
    VertexAttribute& positions = attributes_.emplace_back(forCorners("POSITION", 3));
    for (const Index point : polygons_.corners) {
      positions.values.insert(positions.values.end(), placed[point].data(), placed[point].data() + 3);
    }
    std::vector<bool> used(polygons_.points.size(), false);
    for (const Index point : polygons_.corners) used[point] = true;
    asset_.warnings.add("loose-vertices", "vertices that no face uses are left out", name_,
                        static_cast<std::size_t>(std::count(used.begin(), used.end(), false)));
  }

  // An empty attribute with room for all corners.
  VertexAttribute forCorners(std::string name, Index components) {
    budget_.spend(components * polygons_.corners.size());
    VertexAttribute attribute{std::move(name), components, {}};
    attribute.values.reserve(components * polygons_.corners.size());
    return attribute;
  }

  void addLayer(const FbxNode& node) {
    if (node.name == "LayerElementNormal") {
      if (!hasNormals_) addNormals(Layer(node, "Normals", "NormalsIndex", 3));
    } else if (node.name == "LayerElementUV") {
      if (!hasRoom(textureSets_.size())) return;
      const bool isAdded =
          addNumbers(Layer(node, "UV", "UVIndex", 2), fmt::format("TEXCOORD_{}", textureSets_.size()), 2);
      if (isAdded) textureSets_.push_back(validUtf8(fbxChildText(node, "Name")));
    } else if (node.name == "LayerElementColor") {
      if (!hasRoom(colors_)) return;
      colors_ += addNumbers(Layer(node, "Colors", "ColorIndex", 4), fmt::format("COLOR_{}", colors_), 4);
    } else if (node.name == "LayerElementMaterial") {
      if (materials_.empty()) readMaterials(Layer(node, "Materials", "", 1));
    }
  }

  bool hasRoom(std::size_t sets) {
    if (sets < kMaxSets) return true;
    asset_.warnings.add("attribute-sets", "texture coordinates and colours beyond eight sets of each are left out",
                        name_);
    return false;
  }

  void warnOfLayer(std::string_view what) {
    asset_.warnings.add("invalid-attributes", "vertex attributes that cannot be read are left out",
                        fmt::format("{} {}", name_, what));
  }

  void addNormals(const Layer& layer) {
    if (!layer.isKnown()) return warnOfLayer("NORMAL");
    VertexAttribute normals = forCorners("NORMAL", 3);
    std::size_t made = 0;
    for (Index c = 0; c < polygons_.corners.size(); ++c) {
      const double* row = layer.row(polygons_, c);
      Vec3 normal = row ? Vec3(toNormals_ * Vec3(row[0], row[1], row[2])) : Vec3(Vec3::Zero());
      if (!(normal.norm() > 1e-12) || !std::isfinite(normal.norm())) {
        normal = toNormals_ * areaNormal(polygons_, polygons_.polygon[c]);
        ++made;
      }
      const double length = normal.norm();
      const Vec3f unit = length > 0 && std::isfinite(length) ? Vec3f((normal / length).cast<float>()) : Vec3f::UnitY();
      normals.values.insert(normals.values.end(), unit.data(), unit.data() + 3);
    }
    asset_.warnings.add("invalid-normals", "normals without a direction are made anew", name_, made);
    attributes_.push_back(std::move(normals));
    hasNormals_ = true;
  }

  // Texture coordinates (2 components) or colours (4). False where the layer holds none.
  bool addNumbers(const Layer& layer, std::string attribute, Index components) {
    if (!layer.isKnown()) {
      warnOfLayer(attribute);
      return false;
    }
    VertexAttribute result = forCorners(std::move(attribute), components);
    const bool isTexture = components == 2;
    for (Index c = 0; c < polygons_.corners.size(); ++c) {
      const double* row = layer.row(polygons_, c);
      for (Index i = 0; i < components; ++i) {
        double value = row ? row[i] : isTexture ? 0 : 1;
        if (isTexture && i == 1) value = 1 - value;  // glTF counts v downwards
        if (!isTexture && i < 3) value = linearOf(value);
        result.values.push_back(static_cast<float>(value));
      }
    }
    const bool isFinite =
        std::all_of(result.values.begin(), result.values.end(), [](float x) { return std::isfinite(x); });
    if (!isFinite) {
      warnOfLayer(result.name);
      return false;
    }
    attributes_.push_back(std::move(result));
    return true;
  }

  void readMaterials(const Layer& layer) {
    materials_.assign(polygons_.firstCorner.size() - 1, 0);
    for (Index p = 0; p < materials_.size(); ++p) {
      const Index corner = polygons_.firstCorner[p];
      const double* row = corner < polygons_.corners.size() && layer.isKnown() ? layer.row(polygons_, corner) : nullptr;
      if (row && row[0] >= 0 && row[0] < kMaxMaterials) materials_[p] = static_cast<Index>(row[0]);
    }
  }

  Index materialOf(Index polygon) const { return materials_.empty() ? 0 : materials_[polygon]; }

  void makeTriangles() {
    std::vector<Vec3> jointPositions;
    std::vector<std::array<Index, 3>> cut;
    std::size_t degenerate = 0;
    for (Index p = 0; p + 1 < polygons_.firstCorner.size(); ++p) {
      const Index first = polygons_.firstCorner[p], end = polygons_.firstCorner[p + 1];
      if (end - first < 3) {
        ++degenerate;
        continue;
      }
      jointPositions.clear();
      for (Index c = first; c < end; ++c) jointPositions.push_back(polygons_.points[polygons_.corners[c]]);
      cut.clear();
      triangulatePolygon(jointPositions, cut);
      for (const auto& [a, b, c] : cut) {
        triangles_.push_back({first + a, first + (isMirrored_ ? c : b), first + (isMirrored_ ? b : c)});
      }
    }
    asset_.warnings.add("loose-edges", "polygons of fewer than three corners are left out", name_, degenerate);
  }

  void joinCorners() {
    std::size_t width = 2;
    for (const VertexAttribute& attribute : attributes_) width += attribute.components;
    VertexRows rows(polygons_.corners.size(), width);
    for (Index c = 0; c < polygons_.corners.size(); ++c) {
      rows.add(polygons_.corners[c]);
      rows.add(materialOf(polygons_.polygon[c]));
      for (const VertexAttribute& attribute : attributes_) {
        for (Index i = 0; i < attribute.components; ++i) {
          rows.add(attribute.values[std::size_t{c} * attribute.components + i]);
        }
      }
    }
    joined_ = joinVertices(rows);
    sortByMaterialAndPoint();
  }

  void sortByMaterialAndPoint() {
    std::vector<Index> order(joined_.kept.size()), positionOf(order.size()), kept;
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](Index index) {
      const Index corner = joined_.kept[index];
      return std::pair(materialOf(polygons_.polygon[corner]), polygons_.corners[corner]);
    };
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
    for (Index i = 0; i < order.size(); ++i) {
      positionOf[order[i]] = i;
      kept.push_back(joined_.kept[order[i]]);
    }
    joined_.kept = std::move(kept);
    for (Index& vertex : joined_.vertex) vertex = positionOf[vertex];
  }

  std::vector<FbxPrimitive> primitives() {
    struct Part {
      std::vector<Index> corners;  // of triangles
      JoinedVertices vertices;
      Index first = 0;  // of the joined vertices
    };
    std::map<Index, Part> parts;  // by material
    for (const Triangle& triangle : triangles_) {
      std::vector<Index>& corners = parts[materialOf(polygons_.polygon[triangle[0]])].corners;
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    for (Index v = 0; v < joined_.kept.size(); ++v) {
      const auto part = parts.find(materialOf(polygons_.polygon[joined_.kept[v]]));
      if (part == parts.end()) continue;
      if (part->second.vertices.kept.empty()) part->second.first = v;
      part->second.vertices.kept.push_back(joined_.kept[v]);
    }
    std::vector<FbxPrimitive> result;
    for (auto& [material, part] : parts) {
      std::vector<Index> jointPositions(part.corners.size());
      std::iota(jointPositions.begin(), jointPositions.end(), 0);
      for (const Index corner : part.corners) part.vertices.vertex.push_back(joined_.vertex[corner] - part.first);
      result.push_back({primitive(part.vertices, std::move(jointPositions)), material});
    }
    return result;
  }

  gltf::Primitive primitive(const JoinedVertices& own, std::vector<Index> corners) {
    gltf::Primitive result;
    result.attributes = addJoinedAttributes(asset_, attributes_, {}, 0, own.kept);
    std::vector<Index> points;  // control point of each vertex
    for (const Index corner : own.kept) points.push_back(polygons_.corners[corner]);
    budget_.spend(2 * plan_.weights.slots * points.size());
    for (const auto& [name, accessor] : addJoinedAttributes(asset_, {}, plan_.weights, plan_.jointCount, points)) {
      result.attributes.set(name, accessor);
    }
    result.indices = addJoinedCorners(asset_, std::move(corners), own);
    const bool withNormals = hasNormals_ && std::all_of(plan_.shapes.begin(), plan_.shapes.end(),
                                                        [](const FbxShapeTarget& s) { return !s.normals.empty(); });
    for (const FbxShapeTarget& shape : plan_.shapes) {
      gltf::Attributes& target = result.targets.emplace_back();
      target.set("POSITION", addTarget(shape, shape.moves, plan_.placement.linear(), points, true));
      if (withNormals) {
        const double size = std::cbrt(std::abs(toNormals_.determinant()));
        target.set("NORMAL", addTarget(shape, shape.normals, toNormals_ / (size > 0 ? size : 1), points, false));
      }
    }
    return result;
  }

  Index addTarget(const FbxShapeTarget& shape, const std::vector<Vec3>& rows, const Mat3& map,
                  const std::vector<Index>& points, bool withBounds) {
    budget_.spend(3 * points.size());
    std::vector<float> values(3 * points.size(), 0.0f);
    for (std::size_t v = 0; v < points.size(); ++v) {
      const auto found = std::lower_bound(shape.points.begin(), shape.points.end(), points[v]);
      if (found == shape.points.end() || *found != points[v]) continue;
      const Vec3f moved = (map * rows[static_cast<std::size_t>(found - shape.points.begin())]).cast<float>();
      if (!moved.allFinite()) throw Error(ErrorCode::kBadData, "a blend shape moves a vertex beyond all bounds");
      std::copy_n(moved.data(), 3, &values[3 * v]);
    }
    return addFloatAccessor(asset_, values, 3, kVertexTarget, withBounds);
  }

  static constexpr double kMaxMaterials = 65536;
  static constexpr std::size_t kMaxSets = 8;

  Asset& asset_;
  const FbxNode& geometry_;
  std::string name_;
  const FbxMeshPlan& plan_;
  FbxBudget& budget_;
  FbxPolygons polygons_;
  bool isMirrored_ = false, hasNormals_ = false;
  Mat3 toNormals_;
  std::vector<VertexAttribute> attributes_;  // of the corners
  std::vector<std::string> textureSets_;     // their names
  std::size_t colors_ = 0;
  std::vector<Index> materials_;     // #polygons
  std::vector<Triangle> triangles_;  // of corners
  JoinedVertices joined_;
};

}  // namespace

Index fbxControlPointCount(const FbxNode& geometry) {
  return static_cast<Index>(fbxNumbers(geometry, "Vertices").size() / 3);
}

FbxMesh importFbxMesh(Asset& asset, const FbxNode& geometry, const std::string& name, const FbxMeshPlan& plan,
                      FbxBudget& budget) {
  return FbxMeshBuilder(asset, geometry, name, plan, budget).build();
}

}  // namespace limber
