#include "limber/document/fbx/export_fbx_geometry.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "limber/core/srgb.h"
#include "limber/document/clip/shape_tracks.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/primitive_triangles.h"
#include "limber/document/scene/shape_name.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

using gltf::Attributes;

// A layer of values, one for each vertex: what it is called in the file, and where it lies in its own kind's order.
struct FbxLayerKind {
  const char *element, *values;
  int version;
};
constexpr FbxLayerKind kFbxNormals = {"LayerElementNormal", "Normals", 101}, kFbxUvs = {"LayerElementUV", "UV", 101},
                       kFbxColors = {"LayerElementColor", "Colors", 101};

class FbxGeometryWriter {
 public:
  FbxGeometryWriter(const Asset& asset, Index mesh, Index node, const FbxSpace& space, FbxObjectWriter& objects)
      : asset_(asset),
        mesh_(asset.document.meshes[mesh]),
        meshIndex_(mesh),
        node_(node),
        space_(space),
        objects_(objects) {}

  FbxGeometry write() {
    for (const gltf::Primitive& primitive : mesh_.primitives) addPrimitive(primitive);
    FbxObjectWriter::Made made = objects_.make("Geometry", mesh_.name, "Geometry", "Mesh");
    geometry_.id = made.id;
    writeSurface(made.record);
    writeShapes();
    return std::move(geometry_);
  }

 private:
  struct Part {
    const gltf::Primitive* primitive;
    Index firstVertex, vertexCount;
    std::size_t firstTriangle, endTriangle;
  };

  void addPrimitive(const gltf::Primitive& primitive) {
    const std::optional<Index> positions = primitive.attributes.find("POSITION");
    if (!positions || primitive.mode < gltf::kTriangles) {
      geometry_.vertexStart.push_back(kNoIndex);
      return;
    }
    const Index count = accessorInfo(asset_, *positions).count;
    const Index first = vertexStart(primitive, *positions);
    geometry_.vertexStart.push_back(first);
    const std::vector<Triangle> triangles = primitiveTriangles(asset_, primitive, count);
    const std::size_t firstTriangle = triangles_.size();
    for (const Triangle& t : triangles) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
    parts_.push_back({&primitive, first, count, firstTriangle, triangles_.size()});
    const auto known = std::find(geometry_.materials.begin(), geometry_.materials.end(), primitive.material);
    const auto number = static_cast<std::int32_t>(known - geometry_.materials.begin());
    if (known == geometry_.materials.end()) geometry_.materials.push_back(primitive.material);
    materialNumbers_.insert(materialNumbers_.end(), triangles.size(), number);
  }

  // Primitives of the same attributes and blend shapes have the same vertices.
  Index vertexStart(const gltf::Primitive& primitive, Index positions) {
    for (const Part& part : parts_) {
      if (part.primitive->attributes == primitive.attributes && part.primitive->targets == primitive.targets) {
        return part.firstVertex;
      }
    }
    const Index first = geometry_.vertexCount;
    const std::vector<float> values = readFloats(asset_, positions);
    for (std::size_t v = 0; v + 2 < values.size(); v += 3) {
      const Vec3 point(values[v], values[v + 1], values[v + 2]);
      if (!point.allFinite()) {
        failAt(fmt::format("{}: meshes[{}]", asset_.name, meshIndex_),
               fmt::format("vertex {} has a position that is not a finite number", v / 3));
      }
      const Vec3 length = space_.length(point);
      points_.insert(points_.end(), {length.x(), length.y(), length.z()});
    }
    geometry_.vertexCount += static_cast<Index>(values.size() / 3);
    return first;
  }

  void writeSurface(FbxNode& record) {
    FbxPropertyWriter properties(record);  // none, but the list is expected
    std::vector<std::int32_t> corners;
    corners.reserve(3 * triangles_.size());
    for (const Triangle& t : triangles_) {
      corners.push_back(static_cast<std::int32_t>(t[0]));
      corners.push_back(static_cast<std::int32_t>(t[1]));
      corners.push_back(~static_cast<std::int32_t>(t[2]));  // ends a polygon
    }
    addRecord(record, "GeometryVersion", {std::int32_t{124}});
    addRecord(record, "Vertices", {std::move(points_)});
    addRecord(record, "PolygonVertexIndex", {std::move(corners)});
    FbxNode layers{"Layer", {std::int32_t{0}}, {}};
    addRecord(layers, "Version", {std::int32_t{100}});
    std::vector<FbxNode> further;  // layers above the first have one UV set (or colours) each
    if (anyHas("NORMAL")) writeNormals(record, layers);
    writeSets(record, kFbxUvs, "TEXCOORD_", 2, "UVMap", layers, further);
    writeSets(record, kFbxColors, "COLOR_", 4, "Color", layers, further);
    writeMaterialNumbers(record, layers);
    record.children.push_back(std::move(layers));
    for (FbxNode& layer : further) record.children.push_back(std::move(layer));
  }

  bool anyHas(std::string_view attribute) const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const Part& part) { return part.primitive->attributes.find(attribute).has_value(); });
  }

  static void refer(FbxNode& layer, const char* element, int number) {
    FbxNode& entry = addRecord(layer, "LayerElement");
    addRecord(entry, "Type", {std::string(element)});
    addRecord(entry, "TypedIndex", {std::int32_t{number}});
  }

  static FbxNode& addElement(FbxNode& record, const FbxLayerKind& kind, int number, std::string_view name,
                             std::string_view mapping, std::string_view reference) {
    FbxNode& element = addRecord(record, kind.element, {std::int32_t{number}});
    addRecord(element, "Version", {std::int32_t{kind.version}});
    addRecord(element, "Name", {std::string(name)});
    addRecord(element, "MappingInformationType", {std::string(mapping)});
    addRecord(element, "ReferenceInformationType", {std::string(reference)});
    return element;
  }

  void writeNormals(FbxNode& record, FbxNode& layer) {
    std::vector<double> values(3 * std::size_t{geometry_.vertexCount}, 0);
    for (const Part& part : parts_) {
      const std::optional<Index> accessor = part.primitive->attributes.find("NORMAL");
      if (!accessor) {
        addSmoothNormals(part, values);
        continue;
      }
      const std::vector<float> normals = readFloats(asset_, *accessor);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        values[3 * std::size_t{part.firstVertex} + i] = std::isfinite(normals[i]) ? normals[i] : 0;
      }
    }
    FbxNode& element = addElement(record, kFbxNormals, 0, "", "ByVertice", "Direct");
    addRecord(element, kFbxNormals.values, {std::move(values)});
    refer(layer, kFbxNormals.element, 0);
    // Unreal asks for smoothing groups; all in one lets the normals tell.
    constexpr FbxLayerKind kSmoothing = {"LayerElementSmoothing", "Smoothing", 102};
    FbxNode& smoothing = addElement(record, kSmoothing, 0, "", "ByPolygon", "Direct");
    addRecord(smoothing, kSmoothing.values, {std::vector<std::int32_t>(triangles_.size(), 1)});
    refer(layer, kSmoothing.element, 0);
  }

  // Of a part that has none, beside others that have: from its triangles, by their area.
  void addSmoothNormals(const Part& part, std::vector<double>& values) const {
    const std::vector<float> points = readFloats(asset_, *part.primitive->attributes.find("POSITION"));
    const auto point = [&](Index v) {
      return Eigen::Map<const Vec3f>(&points[3 * std::size_t{v - part.firstVertex}]).cast<double>().eval();
    };
    for (std::size_t f = part.firstTriangle; f < part.endTriangle; ++f) {
      const Triangle& t = triangles_[f];
      const Vec3 normal = (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
      for (const Index v : t) Eigen::Map<Vec3>(&values[3 * std::size_t{v}]) += normal;
    }
    for (Index v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v) {
      Eigen::Map<Vec3>(&values[3 * std::size_t{v}]).normalize();
    }
  }

  // All sets of an attribute ("TEXCOORD_0", "TEXCOORD_1", ...) that a part has.
  void writeSets(FbxNode& record, const FbxLayerKind& kind, const char* prefix, std::size_t components,
                 const char* name, FbxNode& first, std::vector<FbxNode>& further) const {
    for (int set = 0; anyHas(fmt::format("{}{}", prefix, set)); ++set) {
      const std::string setName = set == 0 ? name : fmt::format("{}_{}", name, set);
      FbxNode& element = addElement(record, kind, set, setName, "ByVertice", "Direct");
      addRecord(element, kind.values, {setValues(fmt::format("{}{}", prefix, set), components)});
      const auto layer = static_cast<std::size_t>(set);
      if (layer > further.size()) {
        further.push_back({"Layer", {std::int32_t{set}}, {}});
        addRecord(further.back(), "Version", {std::int32_t{100}});
      }
      refer(layer == 0 ? first : further[layer - 1], kind.element, set);
    }
  }

  // UVs (2) grow upwards; colours (4) are white where a part has none.
  std::vector<double> setValues(const std::string& attribute, std::size_t components) const {
    std::vector<double> values(components * geometry_.vertexCount, components == 4 ? 1.0 : 0.0);
    for (const Part& part : parts_) {
      const std::optional<Index> accessor = part.primitive->attributes.find(attribute);
      if (!accessor) continue;
      const std::size_t stored = accessorInfo(asset_, *accessor).components;
      const std::vector<float> numbers = readFloats(asset_, *accessor);
      for (std::size_t v = 0; v < part.vertexCount; ++v) {
        for (std::size_t c = 0; c < std::min(stored, components); ++c) {
          const double number = std::isfinite(numbers[stored * v + c]) ? numbers[stored * v + c] : 0;
          double& value = values[components * (part.firstVertex + v) + c];
          value = components == 2 ? (c == 1 ? 1 - number : number) : (c < 3 ? srgbOf(number) : number);
        }
      }
    }
    return values;
  }

  void writeMaterialNumbers(FbxNode& record, FbxNode& layer) {
    const bool isPlain = geometry_.materials.size() == 1 && !geometry_.materials[0];
    if (isPlain) geometry_.materials.clear();
    if (geometry_.materials.empty()) return;
    constexpr FbxLayerKind kMaterials = {"LayerElementMaterial", "Materials", 101};
    const bool isOne = geometry_.materials.size() == 1;
    if (isOne) materialNumbers_.assign(1, 0);
    FbxNode& element = addElement(record, kMaterials, 0, "", isOne ? "AllSame" : "ByPolygon", "IndexToDirect");
    addRecord(element, kMaterials.values, {std::move(materialNumbers_)});
    refer(layer, kMaterials.element, 0);
  }

  void writeShapes() {
    std::size_t count = 0;
    for (const Part& part : parts_) count = std::max(count, part.primitive->targets.size());
    if (count == 0) return;
    FbxObjectWriter::Made deformer = objects_.make("Deformer", mesh_.name, "Deformer", "BlendShape");
    const FbxId blendShape = deformer.id;
    addRecord(deformer.record, "Version", {std::int32_t{100}});
    objects_.connect(blendShape, geometry_.id);
    const std::vector<Track<float>> weights = shapeTracks(asset_, node_, count, {});
    UniqueNames names;
    for (std::size_t s = 0; s < count; ++s) {
      const std::string name = names.add(shapeName(mesh_, s));
      const double percent = 100 * double{weights[s].values[0]};
      FbxObjectWriter::Made channel = objects_.make("Deformer", name, "SubDeformer", "BlendShapeChannel");
      const FbxId channelId = channel.id;
      addRecord(channel.record, "Version", {std::int32_t{100}});
      addRecord(channel.record, "DeformPercent", {percent});
      addRecord(channel.record, "FullWeights", {std::vector<double>{100}});
      FbxPropertyWriter(channel.record).number("DeformPercent", percent);
      objects_.connect(channelId, blendShape);
      objects_.connect(writeShape(name, s), channelId);
      geometry_.shapeChannels.push_back(channelId);
    }
  }

  FbxId writeShape(const std::string& name, std::size_t shape) {
    std::vector<std::int32_t> vertices;
    std::vector<double> offsets, normals;
    Index done = 0;  // vertices that parts share come once
    for (const Part& part : parts_) {
      if (part.firstVertex < done) continue;
      done = part.firstVertex + part.vertexCount;
      if (shape >= part.primitive->targets.size()) continue;
      const std::vector<float> moved = offsetsOf(part, shape, "POSITION"), turned = offsetsOf(part, shape, "NORMAL");
      for (Index v = 0; v < part.vertexCount; ++v) {
        const Vec3 offset = space_.length(Eigen::Map<const Vec3f>(&moved[3 * std::size_t{v}]).cast<double>());
        const Vec3 normal = Eigen::Map<const Vec3f>(&turned[3 * std::size_t{v}]).cast<double>();
        if (offset.isZero(0) && normal.isZero(0)) continue;
        vertices.push_back(static_cast<std::int32_t>(part.firstVertex + v));
        offsets.insert(offsets.end(), offset.data(), offset.data() + 3);
        normals.insert(normals.end(), normal.data(), normal.data() + 3);
      }
    }
    if (vertices.empty()) {  // Blender fails on a shape without any
      vertices = {0};
      offsets = normals = {0, 0, 0};
    }
    FbxObjectWriter::Made made = objects_.make("Geometry", name, "Geometry", "Shape");
    addRecord(made.record, "Version", {std::int32_t{100}});
    addRecord(made.record, "Indexes", {std::move(vertices)});
    addRecord(made.record, "Vertices", {std::move(offsets)});
    addRecord(made.record, "Normals", {std::move(normals)});
    return made.id;
  }

  std::vector<float> offsetsOf(const Part& part, std::size_t shape, const char* attribute) const {
    const std::optional<Index> accessor = part.primitive->targets[shape].find(attribute);
    std::vector<float> values = accessor ? readFloats(asset_, *accessor) : std::vector<float>();
    values.resize(3 * std::size_t{part.vertexCount});
    for (float& value : values) value = std::isfinite(value) ? value : 0;
    return values;
  }

  const Asset& asset_;
  const gltf::Mesh& mesh_;
  Index meshIndex_, node_;
  const FbxSpace& space_;
  FbxObjectWriter& objects_;
  FbxGeometry geometry_;
  std::vector<Part> parts_;
  std::vector<double> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> materialNumbers_;  // one for each triangle
};

// What a joint of a skin moves.
struct FbxCluster {
  std::vector<std::int32_t> vertices;
  std::vector<double> weights;
};

std::vector<FbxCluster> clustersOf(const Asset& asset, const gltf::Mesh& mesh, const FbxGeometry& geometry,
                                   std::size_t joints) {
  std::vector<FbxCluster> clusters(joints);
  Index done = 0;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const Index first = geometry.vertexStart[p];
    if (first == kNoIndex || first < done) continue;
    const std::vector<InfluenceSet> sets = readInfluenceSets(asset, mesh.primitives[p]);
    const Index count = accessorInfo(asset, *mesh.primitives[p].attributes.find("POSITION")).count;
    done = first + count;
    std::map<Index, double> ofVertex;
    for (std::size_t v = 0; v < count; ++v) {
      ofVertex.clear();
      double sum = 0;
      for (const InfluenceSet& set : sets) {
        for (std::size_t i = 4 * v; i < 4 * v + 4 && i < set.weights.size(); ++i) {
          if (!(set.weights[i] > 0) || !std::isfinite(set.weights[i]) || set.joints[i] >= joints) continue;
          ofVertex[set.joints[i]] += set.weights[i];
          sum += set.weights[i];
        }
      }
      for (const auto& [joint, weight] : ofVertex) {
        clusters[joint].vertices.push_back(static_cast<std::int32_t>(first + v));
        clusters[joint].weights.push_back(static_cast<float>(weight / sum));
      }
    }
  }
  return clusters;
}

// The bind-pose transform, in the file's space, of the model that a joint's skeleton is a child of.
Affine armatureWorld(const FbxScenePlan& scene, std::size_t joint, const FbxSpace& space) {
  std::optional<std::size_t> model = joint;
  while (model && scene.models[*model].kind == FbxModelKind::kLimb) model = scene.models[*model].parent;
  return model ? space.world(scene.models[*model].bindWorld) : Affine::Identity();
}

}  // namespace

FbxGeometry writeFbxGeometry(const Asset& asset, Index mesh, Index node, const FbxSpace& space,
                             FbxObjectWriter& objects) {
  return FbxGeometryWriter(asset, mesh, node, space, objects).write();
}

void writeFbxSkin(const Asset& asset, const FbxScenePlan& scene, const FbxModelPlan& model, const FbxGeometry& geometry,
                  const std::vector<FbxId>& models, const FbxSpace& space, FbxObjectWriter& objects) {
  const SkinBinding binding = readSkinBinding(asset, *model.skin);
  std::vector<FbxCluster> clusters =
      clustersOf(asset, asset.document.meshes[*model.mesh], geometry, binding.joints.size());
  FbxObjectWriter::Made skin = objects.make("Deformer", model.name, "Deformer", "Skin");
  const FbxId skinId = skin.id;
  addRecord(skin.record, "Version", {std::int32_t{101}});
  addRecord(skin.record, "Link_DeformAcuracy", {50.0});
  objects.connect(skinId, geometry.id);
  for (std::size_t j = 0; j < clusters.size(); ++j) {
    const std::optional<std::size_t> joint = scene.modelOfNode[binding.joints[j]];
    if (!joint) continue;
    // Where this skin has the joint: a document may bind it elsewhere for another.
    const Affine toMesh = binding.inverseBinds[j].inverse(Eigen::Affine);
    const bool isKnown = toMesh.matrix().allFinite();
    const Affine link = space.world(isKnown ? model.bindWorld * toMesh : scene.models[*joint].bindWorld);
    FbxObjectWriter::Made made = objects.make("Deformer", scene.models[*joint].name, "SubDeformer", "Cluster");
    addRecord(made.record, "Version", {std::int32_t{100}});
    addRecord(made.record, "UserData", {std::string(), std::string()});
    if (!clusters[j].vertices.empty()) {
      addRecord(made.record, "Indexes", {std::move(clusters[j].vertices)});
      addRecord(made.record, "Weights", {std::move(clusters[j].weights)});
    }
    const Affine transform = link.inverse(Eigen::Affine) * space.world(model.bindWorld);
    addRecord(made.record, "Transform", {fbxMatrix(transform)});
    addRecord(made.record, "TransformLink", {fbxMatrix(link)});
    // Blender positions the mesh by it.
    addRecord(made.record, "TransformAssociateModel", {fbxMatrix(armatureWorld(scene, *joint, space))});
    objects.connect(made.id, skinId);
    objects.connect(models[*joint], made.id);
  }
}

}  // namespace limber
