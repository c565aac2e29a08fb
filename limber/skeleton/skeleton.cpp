#include "limber/skeleton/skeleton.h"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

std::optional<Index> Skeleton::find(std::string_view name) const {
  const auto joint = std::find_if(joints.begin(), joints.end(), [&](const Joint& j) { return j.name == name; });
  if (joint == joints.end()) return std::nullopt;
  return static_cast<Index>(joint - joints.begin());
}

void checkSkeleton(const Skeleton& skeleton) {
  std::unordered_set<std::string_view> names;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const std::string where = fmt::format("joint {} '{}'", j, joint.name);
    const auto bad = [&](const char* what) { throw Error(ErrorCode::kBadData, what, where); };
    if (joint.name.empty()) bad("has no name");
    if (!names.insert(joint.name).second) bad("has the name of another joint");
    if (joint.parent && *joint.parent >= j) bad("comes before its parent");
    const Affine rest = joint.rest.toAffine();
    if (!rest.matrix().allFinite()) bad("has a rest transform that is not finite");
    if (!(joint.radius >= 0) || !std::isfinite(joint.radius)) bad("has a radius that is negative or not finite");
  }
}

void globalTransforms(const Skeleton& skeleton, std::span<const Transform> locals, std::span<Affine> globals) {
  const Index count = skeleton.jointCount();
  if (locals.size() != count || globals.size() != count) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("{} local and {} global transforms for {} joints", locals.size(), globals.size(), count));
  }
  for (Index j = 0; j < count; ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    globals[j] = parent ? globals[*parent] * locals[j].toAffine() : locals[j].toAffine();
  }
}

std::vector<Transform> restLocals(const Skeleton& skeleton) {
  std::vector<Transform> locals(skeleton.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) locals[j] = skeleton.joints[j].rest;
  return locals;
}

std::vector<Affine> restGlobals(const Skeleton& skeleton) {
  std::vector<Affine> globals(skeleton.jointCount());
  globalTransforms(skeleton, restLocals(skeleton), globals);
  return globals;
}

}  // namespace limber
