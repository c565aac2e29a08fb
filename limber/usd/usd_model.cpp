#include "limber/usd/usd_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limber/asset/accessor.h"
#include "limber/asset/clip_io.h"
#include "limber/asset/clip_name.h"
#include "limber/asset/geometry.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/shape_name.h"
#include "limber/asset/unique_names.h"
#include "limber/usd/usd_text.h"

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

// The weights of a node's blend shapes over time, one track for each of `count`.
std::vector<Track<float>> shapeTracks(const Asset& asset, Index node, const gltf::Mesh& mesh, std::size_t count,
                                      std::optional<Index> clip) {
  const std::vector<double>& own = asset.document.nodes[node].weights;
  const std::vector<double>& standing = own.empty() ? mesh.weights : own;
  std::vector<Track<float>> tracks(count);
  for (std::size_t s = 0; s < count; ++s) {
    tracks[s].times = {0};
    tracks[s].values = {s < standing.size() ? static_cast<float>(standing[s]) : 0.0f};
  }
  if (!clip) return tracks;
  const gltf::Animation& animation = asset.document.animations[*clip];
  for (const gltf::AnimationChannel& channel : animation.channels) {
    if (channel.target.node != node || channel.target.path != "weights") continue;
    const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
    const std::vector<float> times = readFloats(asset, sampler.input), values = readFloats(asset, sampler.output);
    const std::size_t perKey = sampler.interpolation == Interpolation::kCubic ? 3 : 1;
    if (times.empty() || values.size() < times.size() * perKey * count) continue;
    for (std::size_t s = 0; s < count; ++s) {
      tracks[s] = {0, sampler.interpolation, times, {}};
      for (std::size_t k = 0; k < times.size() * perKey; ++k) tracks[s].values.push_back(values[k * count + s]);
    }
  }
  return tracks;
}

class ModelReader {
 public:
  ModelReader(const Asset& asset, const UsdOptions& options)
      : asset_(asset), document_(asset.document), clip_(chosenClip(asset, options.clip)) {}

  UsdModel read() {
    geometry_ = collectGeometry(asset_);
    normals_ = readNormals(asset_, geometry_);
    readRig();
    for (const PrimitiveInstance& instance : geometry_.instances) addMesh(instance);
    tellOfNodeAnimation();
    return std::move(model_);
  }

 private:
  void readRig() {
    if (!hasRig(asset_) && !movesNodes()) return;
    const AssetSkeleton rig = animatedSkeleton(asset_);
    weights_ = readWeights(asset_, geometry_, rig);
    normalizeWeights(weights_);
    model_.skeleton = rig.skeleton;
    model_.joints = jointPaths(rig.skeleton);
    model_.stance = readNodePose(asset_, rig);
    jointNodes_ = rig.jointNode;
    if (!clip_) return;
    std::vector<Clip> clips = readClips(asset_, rig, model_.warnings);
    if (clips[*clip_].duration() > 0) model_.clip = std::move(clips[*clip_]);
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
    const int first = static_cast<int>(instance.firstVertex);
    for (; triangle_ < geometry_.triangles.size(); ++triangle_) {
      const Triangle& t = geometry_.triangles[triangle_];
      if (t[0] >= instance.firstVertex + instance.vertexCount) break;
      for (const Index corner : t) mesh.corners.push_back(static_cast<int>(corner) - first);
    }
    if (mesh.corners.empty()) return;  // points or lines
    const std::string& nodeName = document_.nodes[instance.node].name;
    const std::string& name = nodeName.empty() ? source.name : nodeName;
    mesh.name = names_.add(usdName(name.empty() ? "mesh" : name));
    mesh.material = primitive.material;
    const auto from = static_cast<std::ptrdiff_t>(instance.firstVertex);
    const auto to = from + static_cast<std::ptrdiff_t>(instance.vertexCount);
    mesh.points.assign(geometry_.positions.begin() + from, geometry_.positions.begin() + to);
    if (primitive.attributes.find("NORMAL")) mesh.normals.assign(normals_.begin() + from, normals_.begin() + to);
    readUvs(primitive, mesh);
    readInfluences(instance, mesh);
    readShapes(instance, source, primitive, mesh);
    model_.meshes.push_back(std::move(mesh));
  }

  // Those that the base colour's texture asks for.
  void readUvs(const gltf::Primitive& primitive, UsdMesh& mesh) const {
    Index set = 0;
    if (primitive.material) {
      const auto& surface = document_.materials[*primitive.material].pbrMetallicRoughness;
      if (surface && surface->baseColorTexture) set = surface->baseColorTexture->texCoord;
    }
    const std::optional<Index> accessor = primitive.attributes.find(fmt::format("TEXCOORD_{}", set));
    if (!accessor) return;
    const std::vector<float> values = readFloats(asset_, *accessor);
    for (std::size_t v = 0; v + 1 < values.size(); v += 2) mesh.uvs.emplace_back(values[v], 1 - values[v + 1]);
  }

  void readInfluences(const PrimitiveInstance& instance, UsdMesh& mesh) const {
    const Index end = instance.firstVertex + instance.vertexCount;
    for (Index v = instance.firstVertex; v < end && weights_.slots > 0; ++v) {
      for (Index slot = 0; slot < weights_.slots; ++slot) {
        if (weights_.weightsOf(v)[slot] > 0) mesh.influences = std::max(mesh.influences, static_cast<int>(slot) + 1);
      }
    }
    for (Index v = instance.firstVertex; v < end && mesh.influences > 0; ++v) {
      for (int slot = 0; slot < mesh.influences; ++slot) {
        mesh.joints.push_back(static_cast<int>(weights_.jointsOf(v)[slot]));
        mesh.weights.push_back(weights_.weightsOf(v)[slot]);
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
    std::vector<Track<float>> tracks = shapeTracks(asset_, instance.node, source, count, clip_);
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
      shape.name = shapeNames_.add(usdName(shapeName(source, s)));
      for (std::size_t v = 0; v < offsets.size(); ++v) {
        if (offsets[v].isZero(0) && (!hasNormals || normals[v].isZero(0))) continue;
        shape.vertices.push_back(static_cast<int>(v));
        shape.offsets.push_back(offsets[v]);
        if (hasNormals) shape.normalOffsets.push_back(normals[v]);
      }
      shape.weight = std::move(tracks[s]);
      mesh.shapes.push_back(std::move(shape));
    }
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
  std::optional<Index> clip_;
  Geometry geometry_;
  std::vector<Vec3f> normals_;
  SkinWeights weights_;
  std::vector<Index> jointNodes_;
  std::size_t triangle_ = 0;  // the next of the geometry's
  UniqueNames names_, shapeNames_;
  UsdModel model_;
};

}  // namespace

UsdModel readUsdModel(const Asset& asset, const UsdOptions& options) {
  return ModelReader(asset, options).read();
}

}  // namespace limber
