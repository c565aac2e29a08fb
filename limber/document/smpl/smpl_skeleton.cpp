#include "limber/document/smpl/smpl_skeleton.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/document/smpl/smpl_arrays.h"

namespace limber {

namespace {

// How files write "none" in signed and unsigned integers.
constexpr double kNoParents[] = {-1.0, 4294967295.0, 18446744073709551615.0};

// x to the body's left, y up, z to the front; metres, of the whole height of 1.70 m.
struct SmplJoint {
  std::string_view name, parent;
  double x, y, z;
};

constexpr SmplJoint kBody[] = {
    {"pelvis", "", 0, 0.95, 0},
    {"left_hip", "pelvis", 0.085, 0.90, 0},
    {"right_hip", "pelvis", -0.085, 0.90, 0},
    {"spine1", "pelvis", 0, 1.05, -0.01},
    {"left_knee", "left_hip", 0.085, 0.485, 0},
    {"right_knee", "right_hip", -0.085, 0.485, 0},
    {"spine2", "spine1", 0, 1.16, -0.01},
    {"left_ankle", "left_knee", 0.085, 0.066, -0.02},
    {"right_ankle", "right_knee", -0.085, 0.066, -0.02},
    {"spine3", "spine2", 0, 1.23, 0},
    {"left_foot", "left_ankle", 0.09, 0.02, 0.1},
    {"right_foot", "right_ankle", -0.09, 0.02, 0.1},
    {"neck", "spine3", 0, 1.42, -0.01},
    {"left_collar", "spine3", 0.05, 1.36, 0},
    {"right_collar", "spine3", -0.05, 1.36, 0},
    {"head", "neck", 0, 1.50, 0.01},
    {"left_shoulder", "left_collar", 0.175, 1.39, -0.01},
    {"right_shoulder", "right_collar", -0.175, 1.39, -0.01},
    {"left_elbow", "left_shoulder", 0.49, 1.39, -0.01},
    {"right_elbow", "right_shoulder", -0.49, 1.39, -0.01},
    {"left_wrist", "left_elbow", 0.74, 1.39, -0.01},
    {"right_wrist", "right_elbow", -0.74, 1.39, -0.01},
};
constexpr SmplJoint kFists[] = {{"left_hand", "left_wrist", 0.82, 1.39, -0.01},
                                {"right_hand", "right_wrist", -0.82, 1.39, -0.01}};
constexpr SmplJoint kFace[] = {{"jaw", "head", 0, 1.49, 0.03},
                               {"left_eye_smplhf", "head", 0.03, 1.58, 0.09},
                               {"right_eye_smplhf", "head", -0.03, 1.58, 0.09}};
constexpr SmplJoint kLeftFingers[] = {
    {"left_index1", "left_wrist", 0.835, 1.39, 0.02},      {"left_index2", "left_index1", 0.87, 1.39, 0.021},
    {"left_index3", "left_index2", 0.893, 1.39, 0.022},    {"left_middle1", "left_wrist", 0.837, 1.39, -0.002},
    {"left_middle2", "left_middle1", 0.875, 1.39, -0.002}, {"left_middle3", "left_middle2", 0.9, 1.39, -0.002},
    {"left_pinky1", "left_wrist", 0.823, 1.385, -0.043},   {"left_pinky2", "left_pinky1", 0.85, 1.385, -0.045},
    {"left_pinky3", "left_pinky2", 0.867, 1.385, -0.046},  {"left_ring1", "left_wrist", 0.832, 1.39, -0.023},
    {"left_ring2", "left_ring1", 0.867, 1.39, -0.024},     {"left_ring3", "left_ring2", 0.891, 1.39, -0.025},
    {"left_thumb1", "left_wrist", 0.765, 1.38, 0.017},     {"left_thumb2", "left_thumb1", 0.79, 1.375, 0.042},
    {"left_thumb3", "left_thumb2", 0.81, 1.372, 0.062},
};

class SmplTree {
 public:
  void add(std::string name, std::string_view parent, const Vec3& position) {
    Joint joint;
    joint.name = std::move(name);
    joint.rest.translation = position;
    if (!parent.empty()) {
      joint.parent = skeleton_.find(parent);
      joint.rest.translation -= positions_[*joint.parent];
    }
    positions_.push_back(position);
    skeleton_.joints.push_back(std::move(joint));
  }
  void add(std::span<const SmplJoint> joints) {
    for (const SmplJoint& joint : joints) add(std::string(joint.name), joint.parent, {joint.x, joint.y, joint.z});
  }
  // The other side of joints that begin with "left".
  void addMirrored(std::span<const SmplJoint> joints) {
    const auto mirrored = [](std::string_view name) { return "right" + std::string(name.substr(4)); };
    for (const SmplJoint& joint : joints) {
      add(mirrored(joint.name), mirrored(joint.parent), {-joint.x, joint.y, joint.z});
    }
  }
  Skeleton take() { return std::move(skeleton_); }

 private:
  Skeleton skeleton_;
  std::vector<Vec3> positions_;
};

std::vector<Vec3> jointPositions(const NpzFiles& body, std::span<const Vec3> vertices, std::size_t joints) {
  const std::optional<NpyArray> regressor = npzArray(body, "J_regressor");
  if (!regressor) {
    const NpyArray array = neededSmplArray(body, "J");
    checkSmplShape(array, "J", {joints, 3});
    return smplPoints(array, "J");
  }
  checkSmplShape(*regressor, "J_regressor", {joints, vertices.size()});
  std::vector<Vec3> positions(joints, Vec3::Zero());
  for (std::size_t j = 0; j < joints; ++j) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      positions[j] += regressor->values[j * vertices.size() + v] * vertices[v];
    }
    if (!positions[j].cast<float>().allFinite()) refuseSmplArray("J_regressor", fmt::format("row {} is not finite", j));
  }
  return positions;
}

}  // namespace

bool isSmplJointCount(std::size_t joints) {
  return joints == 22 || joints == 24 || joints == 52 || joints == 55;
}

Skeleton smplSkeleton(std::size_t joints) {
  if (!isSmplJointCount(joints)) {
    throw Error(ErrorCode::kBadArgument, fmt::format("no skeleton of SMPL's has {} joints", joints));
  }
  SmplTree tree;
  tree.add(kBody);
  if (joints == 24) tree.add(kFists);
  if (joints == 55) tree.add(kFace);
  if (joints >= 52) {
    tree.add(kLeftFingers);
    tree.addMirrored(kLeftFingers);
  }
  return tree.take();
}

std::vector<std::string> smplJointNames(std::size_t joints) {
  std::vector<std::string> names;
  if (isSmplJointCount(joints)) {
    for (Joint& joint : smplSkeleton(joints).joints) names.push_back(std::move(joint.name));
    return names;
  }
  for (std::size_t j = 0; j < joints; ++j) names.push_back(fmt::format("joint_{:02}", j));
  return names;
}

Skeleton smplSkeleton(const NpzFiles& body, std::span<const Vec3> vertices) {
  const NpyArray table = neededSmplArray(body, "kintree_table");
  const std::size_t count = table.shape.empty() ? 0 : table.shape.back();
  checkSmplShape(table, "kintree_table", {2, count});
  const std::vector<Vec3> positions = jointPositions(body, vertices, count);
  std::vector<std::string> names = smplJointNames(count);
  Skeleton skeleton;
  for (std::size_t j = 0; j < count; ++j) {
    if (table.values[count + j] != static_cast<double>(j)) {
      refuseSmplArray("kintree_table", fmt::format("joint {} has another number", j));
    }
    Joint joint;
    joint.name = std::move(names[j]);
    joint.rest.translation = positions[j];
    const double parent = table.values[j];
    if (std::find(std::begin(kNoParents), std::end(kNoParents), parent) == std::end(kNoParents)) {
      if (!(parent >= 0 && parent < static_cast<double>(j)) || parent != std::floor(parent)) {
        refuseSmplArray("kintree_table", fmt::format("joint {} has a parent that does not come before it", j));
      }
      joint.parent = static_cast<Index>(parent);
      joint.rest.translation -= positions[*joint.parent];
    }
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

std::vector<Vec3> smplVertices(const NpzFiles& body) {
  const NpyArray array = neededSmplArray(body, "v_template");
  if (smplRowsOfThree(array, "v_template") > kMaxSmplVertices) {
    refuseSmplArray("v_template", "has more than 100 million rows");
  }
  return smplPoints(array, "v_template");
}

std::vector<Vec3> smplVertices(const NpzFiles& body, std::span<const double> betas) {
  std::vector<Vec3> vertices = smplVertices(body);
  const std::optional<NpyArray> shapes = betas.empty() ? std::nullopt : npzArray(body, "shapedirs");
  if (!shapes) return vertices;
  const std::size_t count = shapes->shape.empty() ? 0 : shapes->shape.back();
  checkSmplShape(*shapes, "shapedirs", {vertices.size(), 3, count});
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const double* const row = shapes->values.data() + 3 * v * count;
    for (std::size_t s = 0; s < std::min(count, betas.size()); ++s) {
      vertices[v] += betas[s] * Vec3(row[s], row[count + s], row[2 * count + s]);
    }
    if (!vertices[v].cast<float>().allFinite()) refuseSmplArray("shapedirs", fmt::format("row {} is not finite", v));
  }
  return vertices;
}

}  // namespace limber
