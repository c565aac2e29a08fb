#include "limber/document/scene/shape_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "limber/core/file/read_bounds.h"
#include "limber/document/clip/shape_tracks.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

std::size_t shapeCount(const gltf::Document& document, const gltf::Node& node) {
  if (!node.mesh || document.meshes[*node.mesh].primitives.empty()) return 0;
  return document.meshes[*node.mesh].primitives.front().targets.size();
}

// A few kilobytes of nodes must not ask for gigabytes, nor for minutes where their channels share keys. `counts`: of
// each node's shapes.
void checkSizes(const Asset& asset, const std::vector<std::size_t>& counts, std::optional<Index> animation) {
  std::size_t total = 0;
  std::uint64_t keyNumbers = 0;
  for (Index n = 0; n < counts.size(); ++n) {
    if (counts[n] == 0) continue;
    total += counts[n];
    if (animation) keyNumbers += shapeTrackSize(asset, n, counts[n], *animation);
    if (total > read_bounds::kShapeWeights.of(0)) {
      throw Error(ErrorCode::kLimit, "has too many nodes that show meshes with blend shapes", asset.name);
    }
    if (keyNumbers > read_bounds::kShapeKeys.of(0)) {
      throw Error(ErrorCode::kLimit, "has too many keys of blend shapes in one clip", asset.name);
    }
  }
}

// The keys of a track that can be sampled.
Track<Vec3f> validKeys(const Track<float>& track) {
  Track<Vec3f> valid{0, track.interpolation, {}, {}};
  const std::size_t perKey = track.interpolation == Interpolation::kCubic ? 3 : 1;
  float latest = -std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    const auto first = track.values.begin() + static_cast<std::ptrdiff_t>(k * perKey);
    const auto last = first + static_cast<std::ptrdiff_t>(perKey);
    if (!std::isfinite(track.times[k]) || track.times[k] <= latest) continue;
    latest = track.times[k];
    if (!std::all_of(first, last, [](float value) { return std::isfinite(value); })) continue;
    valid.times.push_back(track.times[k]);
    std::for_each(first, last, [&](float value) { valid.values.emplace_back(value, 0, 0); });
  }
  return valid;
}

// What an attribute has with the weighted offsets of its shapes; empty where it has no shapes.
std::vector<float> movedAttribute(const Asset& asset, const gltf::Primitive& primitive,
                                  const std::vector<float>& weights, const char* attribute) {
  const std::optional<Index> accessor = primitive.attributes.find(attribute);
  if (!accessor || primitive.targets.empty()) return {};
  std::vector<float> values = readFloats(asset, *accessor);
  for (std::size_t s = 0; s < std::min(weights.size(), primitive.targets.size()); ++s) {
    const std::optional<Index> target = primitive.targets[s].find(attribute);
    if (weights[s] == 0 || !target) continue;
    const std::vector<float> offsets = readFloats(asset, *target);
    for (std::size_t i = 0; i < std::min(values.size(), offsets.size()); ++i) values[i] += weights[s] * offsets[i];
  }
  return values;
}

}  // namespace

ShapeWeights readShapeWeights(const Asset& asset, std::optional<Index> animation, double seconds) {
  const Index nodeCount = asset.document.nodeCount();
  std::vector<std::size_t> counts(nodeCount);
  for (Index n = 0; n < nodeCount; ++n) counts[n] = shapeCount(asset.document, asset.document.nodes[n]);
  checkSizes(asset, counts, animation);
  ShapeWeights weights(nodeCount);
  for (Index n = 0; n < nodeCount; ++n) {
    if (counts[n] == 0) continue;
    const std::vector<Track<float>> still = shapeTracks(asset, n, counts[n], std::nullopt);
    const std::vector<Track<float>> tracks = animation ? shapeTracks(asset, n, counts[n], animation) : still;
    for (std::size_t s = 0; s < counts[n]; ++s) {
      Track<Vec3f> track = validKeys(tracks[s]);
      if (track.times.empty()) track = validKeys(still[s]);
      weights[n].push_back(track.times.empty() ? 0.0f : static_cast<float>(sampleTrack(track, seconds).x()));
    }
  }
  return weights;
}

std::optional<Index> animationNamed(const gltf::Document& document, std::string_view name) {
  const auto found = std::find_if(document.animations.begin(), document.animations.end(),
                                  [&](const gltf::Animation& animation) { return animation.name == name; });
  if (found == document.animations.end()) return std::nullopt;
  return static_cast<Index>(found - document.animations.begin());
}

double shapeDuration(const Asset& asset, Index animation) {
  double last = 0;
  const gltf::Animation& source = asset.document.animations[animation];
  for (const gltf::AnimationChannel& channel : source.channels) {
    if (channelTarget(channel).path != "weights") continue;
    for (const float time : readFloats(asset, source.samplers[channel.sampler].input)) {
      if (std::isfinite(time)) last = std::max(last, double{time});
    }
  }
  return last;
}

void moveByShapes(const Asset& asset, const ShapeWeights& weights, Geometry& geometry, std::vector<Vec3f>* normals) {
  for (const PrimitiveInstance& instance : geometry.instances) {
    const std::vector<float>& own = weights[instance.node];
    if (own.empty()) continue;
    const gltf::Primitive& primitive = asset.document.meshes[instance.mesh].primitives[instance.primitive];
    const std::vector<float> positions = movedAttribute(asset, primitive, own, "POSITION");
    for (std::size_t v = 0; 3 * v < positions.size(); ++v) {
      const Vec3 stored = Eigen::Map<const Vec3f>(&positions[3 * v]).cast<double>();
      geometry.positions[instance.firstVertex + v] = (instance.toWorld * stored).cast<float>();
    }
    if (normals == nullptr) continue;
    const std::vector<float> directions = movedAttribute(asset, primitive, own, "NORMAL");
    for (std::size_t v = 0; 3 * v < directions.size(); ++v) {
      (*normals)[instance.firstVertex + v] =
          turnNormal(instance.toWorld.linear(), Eigen::Map<const Vec3f>(&directions[3 * v]));
    }
  }
}

Geometry shapedGeometry(const Asset& asset) {
  Geometry geometry = collectGeometry(asset);
  moveByShapes(asset, readShapeWeights(asset), geometry);
  return geometry;
}

void writeShapeWeights(Asset& asset, const ShapeWeights& weights) {
  for (std::size_t n = 0; n < weights.size(); ++n) {
    if (weights[n].empty()) continue;
    std::vector<double>& own = asset.document.nodes[n].weights;
    own.clear();
    for (const float weight : weights[n]) own.push_back(shortDouble(weight));
  }
}

}  // namespace limber
