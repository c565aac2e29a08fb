#include "limber/document/smpl/smpl_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/blend_shapes.h"
#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_skeleton.h"

namespace limber {

namespace {

constexpr std::size_t kMaxShapes = 10;
constexpr std::size_t kMaxBodyInfluences = 8;

std::vector<Triangle> readTriangles(const NpzFiles& files, std::size_t vertices) {
  const NpyArray array = neededSmplArray(files, "f");
  smplRowsOfThree(array, "f");
  std::vector<Triangle> triangles(array.values.size() / 3);
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double corner = array.values[i];
    if (!(corner >= 0 && corner < static_cast<double>(vertices)) || corner != std::floor(corner)) {
      refuseSmplArray("f", fmt::format("triangle {} has a corner that is no vertex", i / 3));
    }
    triangles[i / 3][i % 3] = static_cast<Index>(corner);
  }
  return triangles;
}

NpyArray readWeightRows(const NpzFiles& files, std::size_t vertices) {
  NpyArray array = neededSmplArray(files, "weights");
  if (array.shape.size() != 2 || array.shape[1] == 0 || array.shape[1] > kMaxSmplVertices) {
    refuseSmplArray("weights", fmt::format("has the shape ({}), not (vertices, joints)", fmt::join(array.shape, ", ")));
  }
  checkSmplShape(array, "weights", {vertices, array.shape[1]});
  return array;
}

// The strongest of each vertex first.
SkinWeights strongest(const NpyArray& array) {
  const std::size_t vertices = array.shape[0], joints = array.shape[1];
  SkinWeights weights;
  weights.slots = static_cast<Index>(std::min(joints, kMaxBodyInfluences));
  weights.joints.assign(vertices * weights.slots, 0);
  weights.weights.assign(vertices * weights.slots, 0.0f);
  std::vector<std::pair<float, Index>> used;
  for (std::size_t v = 0; v < vertices; ++v) {
    used.clear();
    for (std::size_t j = 0; j < joints; ++j) {
      const auto weight = static_cast<float>(array.values[v * joints + j]);
      if (!std::isfinite(weight)) refuseSmplArray("weights", fmt::format("row {} is not finite", v));
      if (weight > 0) used.emplace_back(weight, static_cast<Index>(j));
    }
    if (used.empty()) refuseSmplArray("weights", fmt::format("row {} has no weight above 0", v));
    std::stable_sort(used.begin(), used.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t slot = 0; slot < std::min<std::size_t>(used.size(), weights.slots); ++slot) {
      weights.weights[v * weights.slots + slot] = used[slot].first;
      weights.joints[v * weights.slots + slot] = used[slot].second;
    }
  }
  normalizeWeights(weights);
  return weights;
}

std::vector<BlendShape> readShapes(const NpzFiles& files, std::size_t vertices) {
  const std::optional<NpyArray> array = npzArray(files, "shapedirs");
  if (!array) return {};
  const std::size_t count = array->shape.empty() ? 0 : array->shape.back();
  checkSmplShape(*array, "shapedirs", {vertices, 3, count});
  std::vector<BlendShape> shapes;
  for (std::size_t s = 0; s < std::min(count, kMaxShapes); ++s) {
    BlendShape shape{fmt::format("shape_{:02}", s), {}};
    for (std::size_t v = 0; v < vertices; ++v) {
      const double* row = array->values.data() + 3 * v * count + s;
      shape.offsets.push_back(Vec3(row[0], row[count], row[2 * count]).cast<float>());
      if (!shape.offsets.back().allFinite()) refuseSmplArray("shapedirs", fmt::format("row {} is not finite", v));
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

Asset bodyOf(const NpzFiles& files) {
  const std::vector<Vec3> vertices = smplVertices(files);
  TriMesh mesh;
  for (const Vec3& vertex : vertices) mesh.positions.push_back(vertex.cast<float>());
  mesh.triangles = readTriangles(files, vertices.size());
  const NpyArray rows = readWeightRows(files, vertices.size());
  const Skeleton skeleton = smplSkeleton(files, vertices);
  if (skeleton.jointCount() != rows.shape[1]) {
    refuseSmplArray("weights",
                    fmt::format("has {} joints where kintree_table has {}", rows.shape[1], skeleton.jointCount()));
  }
  Asset asset = meshAsset(mesh, "body");
  asset.document.about.generator.clear();  // another program made it
  const Geometry geometry = collectGeometry(asset);
  addBlendShapes(asset, geometry, readShapes(files, vertices.size()));
  attachRig(asset, geometry, skeleton, strongest(rows));
  if (files.count("posedirs.npy") > 0) {
    asset.warnings.add("pose-shapes", "shapes that depend on the pose left out", "posedirs.npy");
  }
  return asset;
}

}  // namespace

Asset smplBody(const NpzFiles& arrays, std::string_view name) {
  try {
    Asset asset = bodyOf(arrays);
    asset.name = name;
    asset.format = "npz";
    checkAsset(asset);
    return asset;
  } catch (const Error& error) {
    throwWithin(error, name);
  }
}

}  // namespace limber
