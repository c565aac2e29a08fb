// Where a document's vertices are at a moment, by glTF's own rules and by nothing else of the library: the oracle for
// changes of joints that must not be seen.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"

namespace limber::testing {

class GltfPlayer {
 public:
  explicit GltfPlayer(const Asset& asset) : asset_(asset), document_(asset.document) {}

  // All moments at which a channel of the animation has a key.
  std::vector<double> keys(Index animation) const {
    std::set<double> all;
    for (const gltf::AnimationSampler& sampler : document_.animations[animation].samplers) {
      for (const float time : readFloats(asset_, sampler.input)) all.insert(double{time});
    }
    return {all.begin(), all.end()};
  }

  // Every `step`th vertex of all that the default scene shows; without an animation as the nodes stand.
  std::vector<Vec3> vertices(std::optional<Index> animation, double seconds, std::size_t step = 1) const {
    std::vector<gltf::Node> nodes = document_.nodes;
    if (animation) pose(document_.animations[*animation], seconds, nodes);
    std::vector<Affine> world(nodes.size(), Affine::Identity());
    std::vector<Index> shown;
    std::vector<Index> stack = document_.scenes[document_.scene.value_or(0)].nodes;
    for (const Index root : stack) world[root] = local(nodes[root]);
    while (!stack.empty()) {
      const Index node = stack.back();
      stack.pop_back();
      shown.push_back(node);
      for (const Index child : nodes[node].children) {
        world[child] = world[node] * local(nodes[child]);
        stack.push_back(child);
      }
    }
    std::sort(shown.begin(), shown.end());
    std::vector<Vec3> result;
    for (const Index node : shown) addMesh(nodes[node], node, world, step, result);
    return result;
  }

 private:
  static Affine local(const gltf::Node& node) {
    Affine result = Affine::Identity();
    if (node.matrix) {
      result.matrix() = *node.matrix;
      return result;
    }
    if (node.translation) result.translate(*node.translation);
    if (node.rotation) result.rotate(Quat(*node.rotation).normalized());
    if (node.scale) result.scale(*node.scale);
    return result;
  }

  void pose(const gltf::Animation& animation, double seconds, std::vector<gltf::Node>& nodes) const {
    for (const gltf::AnimationChannel& channel : animation.channels) {
      if (!channel.target.node) continue;
      const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
      gltf::Node& node = nodes[*channel.target.node];
      if (channel.target.path == "translation") node.translation = value<3>(sampler, seconds, false);
      if (channel.target.path == "scale") node.scale = value<3>(sampler, seconds, false);
      if (channel.target.path == "rotation") node.rotation = value<4>(sampler, seconds, true);
    }
  }

  template <int n>
  Eigen::Matrix<double, n, 1> value(const gltf::AnimationSampler& sampler, double seconds, bool isRotation) const {
    using Value = Eigen::Matrix<double, n, 1>;
    const std::vector<float> times = readFloats(asset_, sampler.input), numbers = readFloats(asset_, sampler.output);
    const auto at = [&](std::size_t v) {
      Value found;
      for (int i = 0; i < n; ++i) found[i] = numbers[v * n + static_cast<std::size_t>(i)];
      return found;
    };
    const bool isCubic = sampler.interpolation == Interpolation::kCubic;
    const auto key = [&](std::size_t k) { return at(isCubic ? 3 * k + 1 : k); };
    const auto after = std::upper_bound(times.begin(), times.end(), static_cast<float>(seconds));
    if (after == times.begin()) return key(0);
    const auto k = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || sampler.interpolation == Interpolation::kStep) return key(k);
    const double span = double{times[k + 1]} - double{times[k]}, u = (seconds - double{times[k]}) / span;
    if (isCubic) {
      const Value found = (2 * u * u * u - 3 * u * u + 1) * at(3 * k + 1) +
                          span * (u * u * u - 2 * u * u + u) * at(3 * k + 2) +
                          (3 * u * u - 2 * u * u * u) * at(3 * k + 4) + span * (u * u * u - u * u) * at(3 * k + 3);
      return isRotation ? Value(found.normalized()) : found;
    }
    Value a = key(k), b = key(k + 1);
    if (!isRotation) return (1 - u) * a + u * b;
    if (a.dot(b) < 0) b = -b;
    const double angle = std::acos(std::min(1.0, a.dot(b) / a.norm() / b.norm()));
    if (angle < 1e-9) return a.normalized();
    return Value(std::sin((1 - u) * angle) * a.normalized() + std::sin(u * angle) * b.normalized()).normalized();
  }

  void addMesh(const gltf::Node& node, Index number, const std::vector<Affine>& world, std::size_t step,
               std::vector<Vec3>& result) const {
    if (!node.mesh) return;
    std::vector<Affine> joints;
    if (node.skin) {
      const gltf::Skin& skin = document_.skins[*node.skin];
      std::vector<float> inverse;
      if (skin.inverseBindMatrices) inverse = readFloats(asset_, *skin.inverseBindMatrices);
      for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        Affine bind = Affine::Identity();
        for (int i = 0; i < 16 && !inverse.empty(); ++i) {
          bind.matrix()(i % 4, i / 4) = inverse[16 * j + static_cast<std::size_t>(i)];
        }
        joints.push_back(world[skin.joints[j]] * bind);
      }
    }
    for (const gltf::Primitive& primitive : document_.meshes[*node.mesh].primitives) {
      const std::optional<Index> position = primitive.attributes.find("POSITION");
      if (!position) continue;
      const std::vector<float> points = readFloats(asset_, *position);
      std::vector<std::vector<Index>> jointSets;
      std::vector<std::vector<float>> weightSets;
      for (int set = 0; node.skin && set < 4; ++set) {
        const std::optional<Index> joint = primitive.attributes.find("JOINTS_" + std::to_string(set));
        const std::optional<Index> weight = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
        if (!joint || !weight) break;
        jointSets.push_back(readIndices(asset_, *joint));
        weightSets.push_back(readFloats(asset_, *weight));
      }
      for (std::size_t v = 0; 3 * v < points.size(); v += step) {
        const Vec3 point(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
        if (!node.skin) {
          result.push_back(world[number] * point);
          continue;
        }
        Vec3 sum = Vec3::Zero();
        for (std::size_t s = 0; s < jointSets.size(); ++s) {
          for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
            if (weightSets[s][i] != 0) sum += double{weightSets[s][i]} * (joints[jointSets[s][i]] * point);
          }
        }
        result.push_back(sum);
      }
    }
  }

  const Asset& asset_;
  const gltf::Document& document_;
};

// The largest distance between vertices of two documents at the keys of all clips, and midway between keys, as a
// fraction of their size. At most `most` times of each clip.
inline double largestMove(const Asset& before, const Asset& after, std::size_t step = 1, std::size_t most = 1000000) {
  const GltfPlayer a(before), b(after);
  Box box;
  double moved = 0;
  const auto compare = [&](std::optional<Index> animation, double seconds) {
    const std::vector<Vec3> p = a.vertices(animation, seconds, step), q = b.vertices(animation, seconds, step);
    if (p.size() != q.size()) {
      moved = HUGE_VAL;
      return;
    }
    for (std::size_t v = 0; v < p.size(); ++v) {
      box.add(p[v]);
      moved = std::max(moved, (p[v] - q[v]).norm());
    }
  };
  compare(std::nullopt, 0);
  for (Index clip = 0; clip < before.document.animations.size(); ++clip) {
    const std::vector<double> keys = a.keys(clip);
    const std::size_t stride = std::max<std::size_t>(1, keys.size() / most);
    for (std::size_t k = 0; k < keys.size(); k += stride) {
      compare(clip, keys[k]);
      if (k + 1 < keys.size()) compare(clip, (keys[k] + keys[k + 1]) / 2);
    }
  }
  return moved / box.diagonal();
}

}  // namespace limber::testing
