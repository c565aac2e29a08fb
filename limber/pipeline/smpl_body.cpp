#include "limber/pipeline/smpl_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/asset/accessor.h"
#include "limber/asset/rig_io.h"
#include "limber/core/known_error.h"
#include "limber/pipeline/blend_shapes.h"

namespace limber {

namespace {

constexpr std::size_t kMostShapes = 10;
constexpr std::size_t kMostInfluences = 8;
constexpr std::size_t kMostVertices = 100'000'000;
// How files write "none" in signed and unsigned integers.
constexpr double kNoParents[] = {-1.0, 4294967295.0, 18446744073709551615.0};
constexpr std::array<const char*, 24> kSmplJoints = {
    "pelvis",     "left_hip",    "right_hip",    "spine1",      "left_knee",     "right_knee",
    "spine2",     "left_ankle",  "right_ankle",  "spine3",      "left_foot",     "right_foot",
    "neck",       "left_collar", "right_collar", "head",        "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist",   "right_wrist", "left_hand",     "right_hand"};

[[noreturn]] void refuseArray(const std::string& array, std::string what) {
  throw Error(ErrorCode::kBadData, std::move(what), array + ".npy");
}

NpyArray needed(const NpzFiles& files, const std::string& array) {
  std::optional<NpyArray> found = npzArray(files, array);
  if (found) return std::move(*found);
  throw Error(ErrorCode::kBadData, fmt::format("holds no array '{}'", array), {},
              "a body in SMPL's layout has v_template, f, weights, kintree_table and J_regressor or J");
}

void checkShape(const NpyArray& array, const std::string& name, std::vector<std::size_t> wanted) {
  if (array.hasShape(wanted)) return;
  refuseArray(name, fmt::format("has the shape ({}), not ({})", fmt::join(array.shape, ", "), fmt::join(wanted, ", ")));
}

// An array of rows of three, as many as there are.
std::size_t rowsOfThree(const NpyArray& array, const std::string& name) {
  if (array.shape.size() != 2 || array.shape[1] != 3 || array.shape[0] == 0) {
    refuseArray(name, fmt::format("has the shape ({}), not rows of three", fmt::join(array.shape, ", ")));
  }
  return array.shape[0];
}

std::vector<Vec3> finitePoints(const NpyArray& array, const std::string& name) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < array.values.size(); i += 3) {
    points.emplace_back(array.values[i], array.values[i + 1], array.values[i + 2]);
    if (!points.back().cast<float>().allFinite()) refuseArray(name, fmt::format("row {} is not finite", i / 3));
  }
  return points;
}

std::vector<Vec3> readVertices(const NpzFiles& files) {
  const NpyArray array = needed(files, "v_template");
  if (rowsOfThree(array, "v_template") > kMostVertices) refuseArray("v_template", "has more than 100 million rows");
  return finitePoints(array, "v_template");
}

std::vector<std::uint32_t> readCorners(const NpzFiles& files, std::size_t vertices) {
  const NpyArray array = needed(files, "f");
  rowsOfThree(array, "f");
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double corner = array.values[i];
    if (!(corner >= 0 && corner < static_cast<double>(vertices)) || corner != std::floor(corner)) {
      refuseArray("f", fmt::format("triangle {} has a corner that is no vertex", i / 3));
    }
    corners.push_back(static_cast<std::uint32_t>(corner));
  }
  return corners;
}

NpyArray readWeightRows(const NpzFiles& files, std::size_t vertices) {
  NpyArray array = needed(files, "weights");
  if (array.shape.size() != 2 || array.shape[1] == 0 || array.shape[1] > kMostVertices) {
    refuseArray("weights", fmt::format("has the shape ({}), not (vertices, joints)", fmt::join(array.shape, ", ")));
  }
  checkShape(array, "weights", {vertices, array.shape[1]});
  return array;
}

// The strongest of each vertex first.
SkinWeights strongest(const NpyArray& array) {
  const std::size_t vertices = array.shape[0], joints = array.shape[1];
  SkinWeights weights;
  weights.slots = static_cast<Index>(std::min(joints, kMostInfluences));
  weights.joints.assign(vertices * weights.slots, 0);
  weights.weights.assign(vertices * weights.slots, 0.0f);
  std::vector<std::pair<float, Index>> used;
  for (std::size_t v = 0; v < vertices; ++v) {
    used.clear();
    for (std::size_t j = 0; j < joints; ++j) {
      const auto weight = static_cast<float>(array.values[v * joints + j]);
      if (!std::isfinite(weight)) refuseArray("weights", fmt::format("row {} is not finite", v));
      if (weight > 0) used.emplace_back(weight, static_cast<Index>(j));
    }
    if (used.empty()) refuseArray("weights", fmt::format("row {} has no weight above 0", v));
    std::stable_sort(used.begin(), used.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t slot = 0; slot < std::min<std::size_t>(used.size(), weights.slots); ++slot) {
      weights.weights[v * weights.slots + slot] = used[slot].first;
      weights.joints[v * weights.slots + slot] = used[slot].second;
    }
  }
  normalizeWeights(weights);
  return weights;
}

std::vector<Vec3> readPlaces(const NpzFiles& files, const std::vector<Vec3>& vertices, std::size_t joints) {
  const std::optional<NpyArray> regressor = npzArray(files, "J_regressor");
  if (!regressor) {
    const NpyArray array = needed(files, "J");
    checkShape(array, "J", {joints, 3});
    return finitePoints(array, "J");
  }
  checkShape(*regressor, "J_regressor", {joints, vertices.size()});
  std::vector<Vec3> places(joints, Vec3::Zero());
  for (std::size_t j = 0; j < joints; ++j) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      places[j] += regressor->values[j * vertices.size() + v] * vertices[v];
    }
    if (!places[j].cast<float>().allFinite()) refuseArray("J_regressor", fmt::format("row {} is not finite", j));
  }
  return places;
}

std::string smplJointName(std::size_t joint, std::size_t count) {
  return count == kSmplJoints.size() ? kSmplJoints[joint] : fmt::format("joint_{:02}", joint);
}

Skeleton readTree(const NpzFiles& files, const std::vector<Vec3>& places) {
  const NpyArray array = needed(files, "kintree_table");
  const std::size_t count = places.size();
  checkShape(array, "kintree_table", {2, count});
  Skeleton skeleton;
  for (std::size_t j = 0; j < count; ++j) {
    if (array.values[count + j] != static_cast<double>(j)) {
      refuseArray("kintree_table", fmt::format("joint {} has another number", j));
    }
    Joint joint;
    joint.name = smplJointName(j, count);
    joint.rest.translation = places[j];
    const double parent = array.values[j];
    if (std::find(std::begin(kNoParents), std::end(kNoParents), parent) == std::end(kNoParents)) {
      if (!(parent >= 0 && parent < static_cast<double>(j)) || parent != std::floor(parent)) {
        refuseArray("kintree_table", fmt::format("joint {} has a parent that does not come before it", j));
      }
      joint.parent = static_cast<Index>(parent);
      joint.rest.translation -= places[*joint.parent];
    }
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

std::vector<BlendShape> readShapes(const NpzFiles& files, std::size_t vertices) {
  const std::optional<NpyArray> array = npzArray(files, "shapedirs");
  if (!array) return {};
  const std::size_t count = array->shape.empty() ? 0 : array->shape.back();
  checkShape(*array, "shapedirs", {vertices, 3, count});
  std::vector<BlendShape> shapes;
  for (std::size_t s = 0; s < std::min(count, kMostShapes); ++s) {
    BlendShape shape{fmt::format("shape_{:02}", s), {}};
    for (std::size_t v = 0; v < vertices; ++v) {
      const double* row = array->values.data() + 3 * v * count + s;
      shape.offsets.push_back(Vec3(row[0], row[count], row[2 * count]).cast<float>());
      if (!shape.offsets.back().allFinite()) refuseArray("shapedirs", fmt::format("row {} is not finite", v));
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

Asset surfaceAsset(const std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& corners) {
  Asset asset;
  std::vector<float> positions;
  for (const Vec3& v : vertices) {
    for (const double x : v) positions.push_back(static_cast<float>(x));
  }
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  primitive.indices =
      addAccessor(asset, {static_cast<Index>(corners.size()), 1, ComponentType::kU32, false},
                  {reinterpret_cast<const std::uint8_t*>(corners.data()), 4 * corners.size()}, kIndexTarget);
  gltf::Mesh mesh;
  mesh.name = "body";
  mesh.primitives.push_back(std::move(primitive));
  gltf::Node node;
  node.name = "body";
  node.mesh = addElement(asset.document.meshes, std::move(mesh));
  gltf::Scene scene;
  scene.nodes = {addElement(asset.document.nodes, std::move(node))};
  asset.document.scene = addElement(asset.document.scenes, std::move(scene));
  return asset;
}

Asset bodyOf(const NpzFiles& files) {
  const std::vector<Vec3> vertices = readVertices(files);
  const std::vector<std::uint32_t> corners = readCorners(files, vertices.size());
  const NpyArray rows = readWeightRows(files, vertices.size());
  const Skeleton skeleton = readTree(files, readPlaces(files, vertices, rows.shape[1]));
  Asset asset = surfaceAsset(vertices, corners);
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
