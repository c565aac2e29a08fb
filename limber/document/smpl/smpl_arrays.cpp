#include "limber/document/smpl/smpl_arrays.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/document/stored_archive.h"

namespace limber {

namespace {

constexpr std::string_view kSmplArrays[] = {
    // of bodies
    "J", "J_regressor", "f", "kintree_table", "posedirs", "shapedirs", "v_template", "weights",
    // of motions
    "betas", "body_pose", "fps", "frame_rate", "full_pose", "fullpose", "global_orient", "jaw_pose", "left_hand_pose",
    "leye_pose", "mocap_frame_rate", "mocap_framerate", "pose", "pose_body", "pose_eye", "pose_hand", "pose_jaw",
    "poses", "reye_pose", "right_hand_pose", "root_orient", "trans", "transl"};

}  // namespace

NpzFiles readSmplArrays(ByteSpan npz, std::string_view name) {
  return readZipArchive(npz, name, [](std::string_view path) {
    constexpr std::string_view kExtension = ".npy";
    if (!path.ends_with(kExtension)) return false;
    path.remove_suffix(kExtension.size());
    return std::find(std::begin(kSmplArrays), std::end(kSmplArrays), path) != std::end(kSmplArrays);
  });
}

void refuseSmplArray(const std::string& array, std::string what) {
  throw Error(ErrorCode::kBadData, std::move(what), array + ".npy");
}

NpyArray neededSmplArray(const NpzFiles& body, const std::string& array) {
  std::optional<NpyArray> found = npzArray(body, array);
  if (found) return std::move(*found);
  throw Error(ErrorCode::kBadData, fmt::format("holds no array '{}'", array), {},
              "a body in SMPL's layout has v_template, f, weights, kintree_table and J_regressor or J");
}

void checkSmplShape(const NpyArray& array, const std::string& name, const std::vector<std::size_t>& wanted) {
  if (array.hasShape(wanted)) return;
  refuseSmplArray(name,
                  fmt::format("has the shape ({}), not ({})", fmt::join(array.shape, ", "), fmt::join(wanted, ", ")));
}

std::size_t smplRowsOfThree(const NpyArray& array, const std::string& name) {
  if (array.shape.size() != 2 || array.shape[1] != 3 || array.shape[0] == 0) {
    refuseSmplArray(name, fmt::format("has the shape ({}), not rows of three", fmt::join(array.shape, ", ")));
  }
  return array.shape[0];
}

std::vector<Vec3> smplPoints(const NpyArray& array, const std::string& name) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < array.values.size(); i += 3) {
    points.emplace_back(array.values[i], array.values[i + 1], array.values[i + 2]);
    if (!points.back().cast<float>().allFinite()) refuseSmplArray(name, fmt::format("row {} is not finite", i / 3));
  }
  return points;
}

}  // namespace limber
