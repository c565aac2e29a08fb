#include "limber/rigging/prop_rigger.h"

#include <utility>

namespace limber {

namespace {

constexpr double kShareOfDiagonal = 0.05;  // the handle's radius: large enough to take hold of, and hides little

}  // namespace

AutoRig rigAsProp(const TriMesh& mesh, const RigOptions&, Progress&) {
  Box box;
  for (const Vec3f& position : mesh.positions) box.add(position.cast<double>());
  AutoRig rig;
  rig.skeleton.boneShape = BoneShape::kSphere;
  Joint joint;
  joint.name = kPropRigger;
  joint.rest.translation = box.center();
  joint.radius = kShareOfDiagonal * box.diagonal();
  rig.skeleton.joints.push_back(std::move(joint));
  return rig;
}

}  // namespace limber
