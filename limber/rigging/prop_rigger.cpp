#include "limber/rigging/prop_rigger.h"

#include <utility>

#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

constexpr double kDiagonalFraction = 0.05;  // the handle's radius: large enough to take hold of, and hides little

}  // namespace

AutoRig rigAsProp(const TriMesh& mesh, const RigOptions&, Progress&) {
  const Box box = modelBox(mesh);
  AutoRig rig;
  rig.skeleton.boneShape = BoneShape::kSphere;
  Joint joint;
  joint.name = kPropRigger;
  joint.rest.translation = box.center();
  joint.radius = kDiagonalFraction * box.diagonal();
  rig.skeleton.joints.push_back(std::move(joint));
  return rig;
}

}  // namespace limber
