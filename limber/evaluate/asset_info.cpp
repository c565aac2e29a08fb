#include "limber/evaluate/asset_info.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber {

namespace {

std::size_t storedVertices(const Asset& asset) {
  std::set<Index> accessors;
  for (const gltf::Mesh& mesh : asset.document.meshes) {
    for (const gltf::Primitive& primitive : mesh.primitives) {
      if (const auto position = primitive.attributes.find("POSITION")) accessors.insert(*position);
    }
  }
  std::size_t count = 0;
  for (const Index accessor : accessors) count += accessorInfo(asset, accessor).count;
  return count;
}

Index primitiveCount(const Asset& asset) {
  std::size_t count = 0;
  for (const gltf::Mesh& mesh : asset.document.meshes) count += mesh.primitives.size();
  return static_cast<Index>(count);
}

void countEdges(const TriMesh& mesh, SurfaceInfo& info) {
  EdgeGroups(mesh.triangles, mesh.vertexCount()).forEachEdge([&](std::span<const Index> sides) {
    if (sides.size() == 1) ++info.openEdges;
    if (sides.size() > 2) ++info.crowdedEdges;
  });
}

std::optional<SurfaceInfo> inspectSurface(const Geometry& geometry) {
  try {
    const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
    SurfaceInfo info;
    info.weldedVertices = prepared.mesh.vertexCount();
    info.triangles = prepared.mesh.triangleCount();
    Index count = 0;
    const std::vector<Index> pieceOf = vertexComponents(prepared.mesh, &count);
    std::vector<bool> solid(count, false);
    for (const Triangle& t : prepared.mesh.triangles) solid[pieceOf[t[0]]] = true;
    info.pieces = static_cast<Index>(std::count(solid.begin(), solid.end(), true));
    countEdges(prepared.mesh, info);
    return info;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadData) throw;
    return std::nullopt;  // nothing but degenerate triangles
  }
}

SkinWeightInfo inspectWeights(const SkinWeights& weights) {
  SkinWeightInfo info;
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    double sum = 0;
    Index influences = 0;
    for (const float weight : weights.weightsOf(v)) {
      if (weight == 0) continue;
      info.least = info.vertices == 0 && influences == 0 ? weight : std::min(info.least, weight);
      info.greatest = std::max(info.greatest, weight);
      sum += weight;
      ++influences;
    }
    if (influences == 0) {
      ++info.withoutWeights;
      continue;
    }
    ++info.vertices;
    info.maxInfluences = std::max(info.maxInfluences, influences);
    info.largestSumError = std::max(info.largestSumError, std::abs(sum - 1));
  }
  return info;
}

std::vector<ClipInfo> inspectClips(const Asset& asset) {
  std::vector<ClipInfo> clips;
  for (const gltf::Animation& animation : asset.document.animations) {
    ClipInfo clip;
    clip.name = animation.name;
    clip.channels = static_cast<Index>(animation.channels.size());
    for (const gltf::AnimationSampler& sampler : animation.samplers) {
      for (const float time : readFloats(asset, sampler.input)) clip.seconds = std::max(clip.seconds, double{time});
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

// Clips are read only where the size of the rest pose is unlikely: reading them may fail where all else is right.
void inspectSize(const Asset& asset, const AssetSkeleton& skeleton, const SkeletonReading& reading,
                 Warnings& warnings) {
  Warnings found;
  warnUnlikelySize(reading, {}, found);
  if (found.empty()) return;
  try {
    const Motion motion = motionOf(asset, skeleton);
    found = {};
    warnUnlikelySize(reading, motion.clips, found);
  } catch (const Error&) {  // the rest pose alone counts
  }
  warnings.append(found);
}

// Null where the scene has no triangle.
const Geometry* sceneGeometry(const Character& character) {
  try {
    return &character.inOneBindPose().shapedSurface();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadData) throw;
    return nullptr;
  }
}

}  // namespace

AssetInfo inspectAsset(const Character& character) {
  const Asset& asset = character.document();
  const gltf::Document& document = asset.document;
  const auto count = [](const auto& list) { return static_cast<Index>(list.size()); };
  AssetInfo info;
  info.format = asset.format;
  info.storedVertices = storedVertices(asset);
  info.nodes = count(document.nodes);
  info.meshes = count(document.meshes);
  info.primitives = primitiveCount(asset);
  info.materials = count(document.materials);
  info.textures = count(document.textures);
  info.images = count(document.images);
  info.skins = count(document.skins);
  info.clips = inspectClips(asset);
  info.warnings = asset.warnings;
  info.extensions = document.extensionsUsed;

  const Geometry* geometry = sceneGeometry(character);
  if (geometry) {
    info.sceneVertices = static_cast<Index>(geometry->positions.size());
    for (const Vec3f& position : geometry->positions) info.bounds.add(position.cast<double>());
    info.surface = inspectSurface(*geometry);
  }
  if (!document.skins.empty()) {  // a motion has a skin that no mesh wears
    const Skeleton& skeleton = character.binding().skeleton;
    for (const Joint& joint : skeleton.joints) info.joints.push_back(joint.name);
    info.jointPositions = restPositions(skeleton);
    const SkeletonReading reading(skeleton);
    info.anatomy = reading.anatomy();
    info.bodySize = skeletonSize(skeleton, restPose(skeleton), *info.anatomy);
    inspectSize(asset, character.binding(), reading, info.warnings);
    if (character.hasRig()) {
      info.weights = geometry ? inspectWeights(character.inOneBindPose().weights()) : SkinWeightInfo();
    }
  }
  return info;
}

}  // namespace limber
