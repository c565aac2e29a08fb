#include "limber/rigging/templates/standing_skeleton.h"

#include <cmath>
#include <optional>

#include "limber/core/text/numbers.h"

namespace limber {

Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
                          const AnatomicalFrame& frame) {
  const Index count = skeleton.jointCount();
  std::vector<std::optional<Index>> next(count);
  for (Index j = 0; j < count; ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (parent && (!next[*parent] || skeleton.joints[j].role == TemplateRole::kTip)) next[*parent] = j;
  }
  const Vec3 front = frame.axes.row(2).transpose(), up = frame.axes.row(1).transpose();
  std::vector<Affine> globals(count);
  std::vector<std::optional<Index>> kept(count);
  Skeleton result;
  for (Index j = 0; j < count; ++j) {
    const TemplateJoint& from = skeleton.joints[j];
    if (from.role == TemplateRole::kTip) continue;
    const Vec3 position = frame.fromBody(positions[j]);
    Vec3 bone = next[j] ? Vec3(frame.fromBody(positions[*next[j]]) - position) : Vec3(Vec3::Zero());
    if (!(bone.norm() > 1e-9)) bone = from.parent ? Vec3(globals[*from.parent].linear().col(1)) : up;
    const Vec3 y = bone.normalized();
    const Vec3& toward = std::abs(y.dot(front)) > std::cos(kPi / 6) ? up : front;
    const Vec3 z = (toward - toward.dot(y) * y).normalized();
    Mat3 rotation;
    rotation << y.cross(z), y, z;
    globals[j].linear() = rotation;
    globals[j].translation() = position;
    globals[j].makeAffine();
    Joint joint;
    joint.name = from.name;
    if (from.parent) joint.parent = kept[*from.parent];
    const Affine above = from.parent ? globals[*from.parent] : Affine::Identity();
    joint.rest = decompose(above.inverse(Eigen::Isometry) * globals[j]);
    joint.rest.scale = Vec3::Ones();
    kept[j] = result.jointCount();
    result.joints.push_back(std::move(joint));
  }
  return result;
}

}  // namespace limber
