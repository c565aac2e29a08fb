#include "limber/document/clip/pose_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/known_error.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

namespace {

constexpr int kPoseVersion = 1;
constexpr std::size_t kMaxBytes = 4'000'000;  // some 300 for each joint
constexpr std::size_t kMaxJoints = 2000;      // characters have a few hundred at most
constexpr double kFarthest = 1e6;             // metres, and as a scale; the least scale is one over it
constexpr double kUnitWithin = 1e-3;          // of a quaternion's length
constexpr double kExactlyUnit = 1e-12;        // what is nearer stays as it is, bit for bit

template <class Vector>
Json listJson(const Vector& vector) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(vector[i]);
  return list;
}

Json transformJson(const Transform& transform) {
  Json json = Json::object();
  if (transform.translation != Vec3::Zero()) json["translation"] = listJson(transform.translation);
  if (transform.rotation.coeffs() != Quat::Identity().coeffs()) {
    json["rotation"] = listJson(transform.rotation.coeffs());  // x, y, z, w
  }
  if (transform.scale != Vec3::Ones()) json["scale"] = listJson(transform.scale);
  return json;
}

bool isAtRest(const Transform& rest, const Transform& local) {
  return rest.translation == local.translation && rest.rotation.coeffs() == local.rotation.coeffs() &&
         rest.scale == local.scale;
}

void refuseOtherKeys(const JsonView& object, std::initializer_list<std::string_view> known) {
  object.forEachMember([&](std::string_view key, const JsonView& value) {
    if (std::find(known.begin(), known.end(), key) == known.end()) value.fail("is not part of a pose");
  });
}

template <int kCount>
Eigen::Matrix<double, kCount, 1> numbersOf(const JsonView& list) {
  if (list.size() != kCount) list.fail(fmt::format("is not {} numbers", kCount));
  Eigen::Matrix<double, kCount, 1> numbers;
  for (int i = 0; i < kCount; ++i) {
    numbers[i] = list[static_cast<std::size_t>(i)].asNumber();
    if (!(std::abs(numbers[i]) <= kFarthest)) list.fail("is too large a number");
  }
  return numbers;
}

Transform transformOf(const JsonView& object) {
  refuseOtherKeys(object, {"translation", "rotation", "scale"});
  Transform transform;
  if (const JsonView list = object.array("translation"); list.exists()) transform.translation = numbersOf<3>(list);
  if (const JsonView list = object.array("rotation"); list.exists()) {
    transform.rotation = Quat(numbersOf<4>(list));
    const double off = std::abs(transform.rotation.norm() - 1);
    if (!(off <= kUnitWithin)) list.fail("is not of unit length");
    if (off > kExactlyUnit) transform.rotation.normalize();
  }
  if (const JsonView list = object.array("scale"); list.exists()) {
    transform.scale = numbersOf<3>(list);
    if (!(transform.scale.cwiseAbs().minCoeff() >= 1 / kFarthest)) list.fail("is too small a scale");
  }
  return transform;
}

std::string requiredText(const JsonView& object, std::string_view key) {
  const std::string_view text = object.text(key);
  if (text.empty()) object.fail(fmt::format("has no \"{}\"", key));
  return std::string(text);
}

// Empty: none is declared.
std::string_view boneOf(const JsonView& entry) {
  const std::string_view name = entry.text("bone");
  if (name.empty()) return {};
  const std::span<const std::string_view> bones = humanoidBones();
  const auto found = std::find(bones.begin(), bones.end(), name);
  if (found == bones.end()) entry.member("bone").fail("is no bone of VRM 1.0");
  return *found;
}

}  // namespace

std::string poseToJson(const PortablePose& pose) {
  Json joints = Json::array();
  for (Index j = 0; j < pose.skeleton.jointCount(); ++j) {
    const Joint& joint = pose.skeleton.joints[j];
    Json entry = {{"name", joint.name}};
    if (!joint.declaredBone.empty()) entry["bone"] = joint.declaredBone;
    if (joint.parent) entry["parent"] = pose.skeleton.joints[*joint.parent].name;
    entry["rest"] = transformJson(joint.rest);
    const Transform& local = pose.pose.locals[j];
    if (!isAtRest(joint.rest, local)) entry["local"] = transformJson(local);
    joints.push_back(std::move(entry));
  }
  return dumpReport({{"limber_pose", kPoseVersion}, {"name", pose.name}, {"joints", std::move(joints)}}, 1);
}

PortablePose poseFromJson(std::string_view text) {
  if (text.size() > kMaxBytes) throw Error(ErrorCode::kLimit, "the pose is larger than 4 MB");
  Warnings warnings;
  const Json document = parseJson(text, warnings);
  const JsonView root(document);
  if (!document.is_object() || root.number("limber_pose", 0) != kPoseVersion) {
    throw KnownError(ErrorKind::kNoPoseFile,
                     {ErrorCode::kBadData,
                      "is no pose that limber knows",
                      {},
                      fmt::format("save one in the studio, or by limber pose -o NAME{}", kPoseFileEnding)});
  }
  refuseOtherKeys(root, {"limber_pose", "name", "joints"});
  PortablePose pose;
  pose.name = root.text("name");
  const JsonView joints = root.array("joints");
  if (joints.size() == 0) root.fail("has no \"joints\"");
  if (joints.size() > kMaxJoints) {
    throw Error(ErrorCode::kLimit, fmt::format("the pose has more than {} joints", kMaxJoints), joints.path());
  }
  std::map<std::string, Index> known;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JsonView entry = joints[j];
    refuseOtherKeys(entry, {"name", "bone", "parent", "rest", "local"});
    Joint joint;
    joint.name = requiredText(entry, "name");
    if (!known.emplace(joint.name, static_cast<Index>(j)).second) entry.fail("has the name of another joint");
    if (const JsonView parent = entry.member("parent"); parent.exists()) {
      const auto above = known.find(requiredText(entry, "parent"));
      if (above == known.end() || above->second == j) parent.fail("is no joint before this one");
      joint.parent = above->second;
    }
    joint.declaredBone = boneOf(entry);
    joint.rest = transformOf(entry.object("rest"));
    const JsonView local = entry.object("local");
    pose.pose.locals.push_back(local.exists() ? transformOf(local) : joint.rest);
    pose.skeleton.joints.push_back(std::move(joint));
  }
  return pose;
}

}  // namespace limber
