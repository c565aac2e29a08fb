#include "limber/document/live/live_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

constexpr std::size_t kMaxLiveJoints = 1000;

constexpr std::size_t kNumbers = 7;  // of a joint

// nullopt where they are no position and rotation.
std::optional<Transform> transformOf(const std::array<double, kNumbers>& n) {
  Transform transform;
  transform.translation = Vec3(n[0], n[1], n[2]);
  transform.rotation = Quat(n[6], n[3], n[4], n[5]);
  constexpr double kUnit = 1e-3;
  if (!transform.translation.cast<float>().allFinite()) return std::nullopt;
  if (!(std::abs(transform.rotation.norm() - 1) < kUnit)) return std::nullopt;
  transform.rotation.normalize();
  return transform;
}

Transform restIn(const JsonView& list) {
  if (list.size() != kNumbers) list.fail("has not seven numbers");
  std::array<double, kNumbers> numbers;
  for (std::size_t i = 0; i < kNumbers; ++i) numbers[i] = list[i].asNumber();
  const std::optional<Transform> rest = transformOf(numbers);
  if (!rest) list.fail("is no place and rotation");
  return *rest;
}

}  // namespace

std::string liveSkeletonText(const Skeleton& skeleton) {
  Json joints = Json::array();
  for (const Joint& joint : skeleton.joints) {
    const Vec3& p = joint.rest.translation;
    const Quat& q = joint.rest.rotation;
    joints.push_back({{"name", joint.name},
                      {"parent", joint.parent ? Json(*joint.parent) : Json(nullptr)},
                      {"rest", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}}});
  }
  return dumpReport({{"joints", std::move(joints)}}, -1);
}

Skeleton liveSkeletonFrom(std::string_view text) {
  Warnings ignored;
  const Json json = parseJson(text, ignored);
  const JsonView joints = JsonView(json).array("joints");
  if (joints.size() == 0) joints.fail("has no joint");
  if (joints.size() > kMaxLiveJoints) {
    throw Error(ErrorCode::kLimit, fmt::format("has more than {} joints", kMaxLiveJoints));
  }
  Skeleton skeleton;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Joint joint;
    joint.name = joints[j].text("name");
    const JsonView parent = joints[j].member("parent");
    if (parent.exists() && !parent.json().is_null()) joint.parent = joints[j].requireIndex("parent", j);
    joint.rest = restIn(joints[j].array("rest"));
    skeleton.joints.push_back(std::move(joint));
  }
  checkSkeleton(skeleton);
  return skeleton;
}

std::string liveFrameText(const Pose& pose, double seconds) {
  std::string text = fmt::format("[{:.4f}", seconds);
  for (const Transform& local : pose.locals) {
    const Vec3& p = local.translation;
    const Quat& q = local.rotation;
    fmt::format_to(std::back_inserter(text), ",{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}", p.x(), p.y(), p.z(),
                   q.x(), q.y(), q.z(), q.w());
  }
  return text + "]";
}

Pose livePoseFrom(ByteSpan floats) {
  constexpr std::size_t kJoint = kNumbers * sizeof(float);
  if (floats.size() % kJoint != 0)
    throw Error(ErrorCode::kBadData, "a live frame has not seven numbers for each joint");
  Pose pose;
  for (std::size_t at = 0; at < floats.size(); at += kJoint) {
    std::array<float, kNumbers> values;
    std::memcpy(values.data(), floats.data() + at, kJoint);
    std::array<double, kNumbers> numbers;
    std::copy(values.begin(), values.end(), numbers.begin());
    const std::optional<Transform> local = transformOf(numbers);
    if (!local) throw Error(ErrorCode::kBadData, "a live frame holds what is no place and rotation");
    pose.locals.push_back(*local);
  }
  return pose;
}

}  // namespace limber
