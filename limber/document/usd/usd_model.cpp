#include "limber/document/usd/usd_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/clip_name.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/clip/shape_tracks.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/shape_name.h"
#include "limber/document/unique_names.h"
#include "limber/document/usd/usd_stage.h"

namespace limber {

namespace {

std::vector<std::string> jointPaths(const Skeleton& skeleton) {
  UniqueNames names;
  std::vector<std::string> paths;
  for (const Joint& joint : skeleton.joints) {
    const std::string name = names.add(usdName(joint.name));
    paths.push_back(joint.parent ? paths[*joint.parent] + "/" + name : name);
  }
  return paths;
}

// The number of the clip that is asked for, the first where none is; none where there are none.
std::optional<Index> chosenClip(const Asset& asset, const std::optional<std::string>& name) {
  std::vector<std::string> names;
  for (const gltf::Animation& animation : asset.document.animations) names.push_back(animation.name);
  if (name) return clipNamed(names, *name, asset.name);
  return names.empty() ? std::nullopt : std::optional<Index>(0);
}

class ModelReader {
 public:
  ModelReader(const Asset& asset, const std::vector<UsdSurface>& surfaces)
      : asset_(asset), document_(asset.document), surfaces_(surfaces), geometry_(collectGeometry(asset)) {
    for (const char* sibling : {kUsdSkeleton, kUsdMaterials}) names_.add(sibling);
  }

  UsdModel read(const UsdOptions& options) {
    clip_ = chosenClip(asset_, options.clip);
    normals_ = readNormals(asset_, geometry_);
    readRig();
    readMeshes();
    tellOfNodeAnimation();
    return std::move(model_);
  }

  UsdModel readStill(const UsdStillSurface& still) {
    const std::size_t count = geometry_.positions.size();
    if (still.points.size() != count || still.normals.size() != count) {
      throw Error(ErrorCode::kBadArgument,
                  fmt::format("the surface has {} points and {} normals, and the model {} vertices",
                              still.points.size(), still.normals.size(), count),
                  asset_.name);
    }
    isStill_ = true;
    geometry_.positions.assign(still.points.begin(), still.points.end());
    normals_.assign(still.normals.begin(), still.normals.end());
    readMeshes();
    return std::move(model_);
  }

 private:
  void readMeshes() {
    for (const PrimitiveInstance& instance : geometry_.instances) addMesh(instance);
    model_.pointDecimals = decimalsFor(5e-6);
    model_.moveDecimals = decimalsFor(2e-6);
  }

  void readRig() {
    if (!hasRig(asset_) && !movesNodes()) return;
    const AssetSkeleton rig = animatedSkeleton(asset_);
    weights_ = readWeights(asset_, geometry_, rig);
    normalizeWeights(weights_);
    model_.skeleton = rig.skeleton;
    model_.stance = readNodePose(asset_, rig);
    jointNodes_ = rig.jointNode;
    if (clip_) {
      std::vector<Clip> clips = readClips(asset_, rig, model_.warnings);
      if (clips[*clip_].duration() > 0) {
        model_.clip = std::move(clips[*clip_]);
      } else {  // a pose
        model_.stance = restPose(model_.skeleton);
        sampleClip(clips[*clip_], 0, model_.stance);
      }
    }
    joinRoots();
    model_.joints = jointPaths(model_.skeleton);
    foldScales();
  }

  // Some readers take a skeleton of one root alone: several get a joint above them, which becomes the first.
  void joinRoots() {
    std::vector<Joint>& joints = model_.skeleton.joints;
    if (std::count_if(joints.begin(), joints.end(), [](const Joint& joint) { return !joint.parent; }) < 2) return;
    UniqueNames names;
    for (const Joint& joint : joints) names.add(usdName(joint.name));
    for (Joint& joint : joints) joint.parent = joint.parent ? *joint.parent + 1 : 0;
    Joint root;
    root.name = names.add("root");
    joints.insert(joints.begin(), root);
    model_.stance.locals.insert(model_.stance.locals.begin(), Transform());
    for (std::size_t i = 0; i < weights_.joints.size(); ++i) weights_.joints[i] += weights_.weights[i] > 0 ? 1 : 0;
    if (!model_.clip) return;
    for (auto& track : model_.clip->translations) ++track.joint;
    for (auto& track : model_.clip->rotations) ++track.joint;
    for (auto& track : model_.clip->scales) ++track.joint;
  }

  // A SkelAnimation's scales have eleven bits. So each joint's frame is scaled, in bind pose and in motion alike, by
  // what makes its scales 1 where they are uniform and stand still, and at most 1 along x where they change; its
  // children's translations become lengths in the world.
  void foldScales() {
    std::vector<Joint>& joints = model_.skeleton.joints;
    std::vector<double> own;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      own.push_back(std::abs(model_.clip ? joints[j].rest.scale.x() : model_.stance.locals[j].scale.x()));
    }
    if (model_.clip) {
      for (const Track<Vec3f>& track : model_.clip->scales) {
        own[track.joint] = 0;
        for (const Vec3f& value : track.values)
          own[track.joint] = std::max<double>(own[track.joint], std::abs(value.x()));
      }
    }
    std::vector<double> ofParent;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!(own[j] > 0)) own[j] = 1;
      ofParent.push_back(joints[j].parent ? ofParent[*joints[j].parent] * own[*joints[j].parent] : 1);
      for (Transform* local : {&joints[j].rest, &model_.stance.locals[j]}) {
        local->translation *= ofParent[j];
        local->scale /= own[j];
      }
    }
    if (!model_.clip) return;
    for (Track<Vec3f>& track : model_.clip->translations) {
      for (Vec3f& value : track.values) value = (value.cast<double>() * ofParent[track.joint]).cast<float>();
    }
    for (Track<Vec3f>& track : model_.clip->scales) {
      for (Vec3f& value : track.values) value = (value.cast<double>() / own[track.joint]).cast<float>();
    }
  }

  bool movesNodes() const {
    if (!clip_) return false;
    const std::vector<gltf::AnimationChannel>& channels = document_.animations[*clip_].channels;
    return std::any_of(channels.begin(), channels.end(), [](const gltf::AnimationChannel& channel) {
      return channel.target.node && channel.target.path != "weights";
    });
  }

  void addMesh(const PrimitiveInstance& instance) {
    const gltf::Mesh& source = document_.meshes[instance.mesh];
    const gltf::Primitive& primitive = source.primitives[instance.primitive];
    UsdMesh mesh;
    readCorners(instance, mesh);
    if (mesh.corners.empty()) return;  // points or lines
    const std::string& nodeName = document_.nodes[instance.node].name;
    const std::string& name = nodeName.empty() ? source.name : nodeName;
    mesh.label = name.empty() ? "mesh" : name;
    mesh.name = names_.add(usdName(mesh.label));
    mesh.material = primitive.material;
    const bool hasNormals = primitive.attributes.find("NORMAL").has_value();
    for (const Index v : vertices_) {
      mesh.points.push_back(geometry_.positions[instance.firstVertex + v]);
      if (hasNormals) mesh.normals.push_back(normals_[instance.firstVertex + v]);
    }
    readUvs(primitive, mesh);
    readColors(primitive, mesh);
    if (!isStill_) {
      readInfluences(instance.firstVertex, mesh);
      reportLostInfluences(primitive, mesh.name, model_.warnings);
      readShapes(instance, source, primitive, mesh);
    }
    model_.meshes.push_back(std::move(mesh));
  }

  // The instance's triangles, whose vertices are numbered in the order in which the instance has them.
  void readCorners(const PrimitiveInstance& instance, UsdMesh& mesh) {
    const std::size_t first = triangle_;
    std::vector<int> number(instance.vertexCount, -1);
    for (; triangle_ < geometry_.triangles.size(); ++triangle_) {
      const Triangle& t = geometry_.triangles[triangle_];
      if (t[0] >= instance.firstVertex + instance.vertexCount) break;
      for (const Index corner : t) number[corner - instance.firstVertex] = 0;
    }
    vertices_.clear();
    for (Index v = 0; v < instance.vertexCount; ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(vertices_.size());
      vertices_.push_back(v);
    }
    for (std::size_t t = first; t < triangle_; ++t) {
      for (const Index corner : geometry_.triangles[t]) mesh.corners.push_back(number[corner - instance.firstVertex]);
    }
  }

  // Those that the material's textures ask for; the first where none does.
  void readUvs(const gltf::Primitive& primitive, UsdMesh& mesh) const {
    std::set<Index> sets = {0};
    if (primitive.material && !surfaces_[*primitive.material].uvSets.empty())
      sets = surfaces_[*primitive.material].uvSets;
    for (const Index set : sets) {
      const std::optional<Index> accessor = primitive.attributes.find(fmt::format("TEXCOORD_{}", set));
      if (!accessor) continue;
      const std::vector<float> values = readFloats(asset_, *accessor);
      std::vector<Vec2f>& uvs = mesh.uvs[set];
      for (const Index v : vertices_) uvs.emplace_back(values[2 * v], 1 - values[2 * v + 1]);
    }
  }

  void readColors(const gltf::Primitive& primitive, UsdMesh& mesh) {
    const std::optional<Index> accessor = primitive.attributes.find("COLOR_0");
    if (!accessor) return;
    const UsdSurface* surface = primitive.material ? &surfaces_[*primitive.material] : nullptr;
    const Vec4f factor = surface != nullptr ? surface->baseColor : Vec4f(Vec4f::Ones());
    const std::size_t parts = accessorInfo(asset_, *accessor).components;
    const std::vector<float> values = readFloats(asset_, *accessor);
    bool isWhite = true;
    for (const Index v : vertices_) {
      Vec4f color = Vec4f::Ones();
      for (std::size_t i = 0; i < std::min<std::size_t>(parts, 4); ++i)
        color[static_cast<int>(i)] = values[parts * v + i];
      isWhite = isWhite && color == Vec4f::Ones();
      color.array() *= factor.array();
      mesh.colors.emplace_back(color.head<3>());
      mesh.opacities.push_back(color.w());
    }
    const bool isLost = surface != nullptr && surface->isTextured;
    if (isLost && !isWhite) {
      model_.warnings.add("vertex-colors", "colours of vertices below a texture are left out", mesh.name);
    }
    if (isLost || isWhite) mesh.colors.clear();
    if (isLost || isWhite || surface == nullptr || !surface->hasOpacity) mesh.opacities.clear();
    keepOneOfAll(mesh.colors);
    keepOneOfAll(mesh.opacities);
  }
  template <typename Value>
  static void keepOneOfAll(std::vector<Value>& values) {
    if (std::all_of(values.begin(), values.end(), [&](const Value& value) { return value == values[0]; })) {
      values.resize(std::min<std::size_t>(values.size(), 1));
    }
  }

  void readInfluences(Index firstVertex, UsdMesh& mesh) const {
    for (const Index v : vertices_) {
      for (Index slot = 0; slot < weights_.slots; ++slot) {
        if (weights_.weightsOf(firstVertex + v)[slot] > 0) {
          mesh.influences = std::max(mesh.influences, static_cast<int>(slot) + 1);
        }
      }
    }
    if (mesh.influences == 0) return;
    for (const Index v : vertices_) {
      for (int slot = 0; slot < mesh.influences; ++slot) {
        mesh.joints.push_back(static_cast<int>(weights_.jointsOf(firstVertex + v)[slot]));
        mesh.weights.push_back(weights_.weightsOf(firstVertex + v)[slot]);
      }
      // A vertex that the file gives no weights stays with the first joint, where USD would have it nowhere.
      float& strongest = mesh.weights[mesh.weights.size() - static_cast<std::size_t>(mesh.influences)];
      if (strongest == 0) strongest = 1;
    }
  }

  void readShapes(const PrimitiveInstance& instance, const gltf::Mesh& source, const gltf::Primitive& primitive,
                  UsdMesh& mesh) {
    const std::size_t count = primitive.targets.size();
    if (count == 0) return;
    std::vector<Track<float>> tracks = shapeTracks(asset_, instance.node, count, clip_);
    const Mat3 linear = instance.toWorld.linear(), turn = linear.inverse().transpose();
    for (std::size_t s = 0; s < count; ++s) {
      const auto offsetsOf = [&](const char* attribute, const Mat3& by) {
        const std::optional<Index> accessor = primitive.targets[s].find(attribute);
        std::vector<Vec3f> offsets(instance.vertexCount, Vec3f::Zero());
        if (!accessor) return offsets;
        const std::vector<float> values = readFloats(asset_, *accessor);
        for (std::size_t v = 0; v < offsets.size(); ++v) {
          offsets[v] = (by * Eigen::Map<const Vec3f>(&values[3 * v]).cast<double>()).cast<float>();
        }
        return offsets;
      };
      const std::vector<Vec3f> offsets = offsetsOf("POSITION", linear);
      const bool hasNormals = !mesh.normals.empty() && primitive.targets[s].find("NORMAL");
      const std::vector<Vec3f> normals = hasNormals ? offsetsOf("NORMAL", turn) : std::vector<Vec3f>();
      UsdShape shape;
      shape.label = shapeLabels_.add(usdLabel(shapeName(source, s)));
      shape.name = shapeNames_.add(usdName(shape.label));
      for (std::size_t number = 0; number < vertices_.size(); ++number) {
        const Index v = vertices_[number];
        if (offsets[v].isZero(0) && (!hasNormals || normals[v].isZero(0))) continue;
        shape.vertices.push_back(static_cast<int>(number));
        shape.offsets.push_back(offsets[v]);
        if (hasNormals) shape.normalOffsets.push_back(normals[v]);
      }
      shape.weight = std::move(tracks[s]);
      mesh.shapes.push_back(std::move(shape));
    }
  }

  // The fewest that step by that much of the model's size or less.
  int decimalsFor(double step) const {
    constexpr int kMax = 12;
    Box box;
    for (const UsdMesh& mesh : model_.meshes) {
      for (const Vec3f& point : mesh.points) box.add(point.cast<double>());
    }
    int decimals = 0;
    for (double unit = 1; decimals < kMax && unit > step * box.diagonal(); unit /= 10) ++decimals;
    return decimals;
  }

  void tellOfNodeAnimation() {
    if (!clip_) return;
    std::size_t others = 0;
    for (const gltf::AnimationChannel& channel : document_.animations[*clip_].channels) {
      const std::optional<Index> node = channel.target.node;
      const bool isJoint = node && std::find(jointNodes_.begin(), jointNodes_.end(), *node) != jointNodes_.end();
      others += node && !isJoint && channel.target.path != "weights" ? 1 : 0;
    }
    model_.warnings.add("node-animation", "movements of nodes that are no joints are left out", {}, others);
  }

  const Asset& asset_;
  const gltf::Document& document_;
  const std::vector<UsdSurface>& surfaces_;
  Geometry geometry_;
  bool isStill_ = false;
  std::optional<Index> clip_;
  std::vector<Vec3f> normals_;
  SkinWeights weights_;
  std::vector<Index> jointNodes_;
  std::size_t triangle_ = 0;              // the next of the geometry's
  std::vector<Index> vertices_;           // of the instance that is being read: those that have triangles
  UniqueNames names_;                     // of meshes
  UniqueNames shapeNames_, shapeLabels_;  // of all their shapes
  UsdModel model_;
};

}  // namespace

UsdModel readUsdModel(const Asset& asset, const std::vector<UsdSurface>& surfaces, const UsdOptions& options) {
  const std::optional<Asset> joined = withJoinedBinds(asset);
  return ModelReader(joined ? *joined : asset, surfaces).read(options);
}

UsdModel readStillUsdModel(const Asset& asset, const std::vector<UsdSurface>& surfaces, const UsdStillSurface& still) {
  return ModelReader(asset, surfaces).readStill(still);
}

}  // namespace limber
