#include "limber/rigging/prop_rigger.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(PropRigger, GivesOneJointInTheMiddle) {
  TriMesh mesh;
  mesh.positions = {{-1, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, -4}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Progress progress;
  RigOptions options;
  options.handles = 20;
  const AutoRig rig = findRigger(kPropRigger).rig(mesh, options, progress);
  ASSERT_EQ(rig.skeleton.jointCount(), 1u);
  EXPECT_EQ(rig.skeleton.joints[0].rest.translation, Vec3(1, 1, -2));
  EXPECT_GT(rig.skeleton.joints[0].radius, 0);
  checkSkeleton(rig.skeleton);
}

}  // namespace
}  // namespace limber
