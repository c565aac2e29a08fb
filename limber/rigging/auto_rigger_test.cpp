#include "limber/rigging/auto_rigger.h"

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/prop_rigger.h"

namespace limber {
namespace {

AutoRig tableAutoRig(std::string_view rigger, const TriMesh& mesh) {
  RigOptions options;
  options.handles = 9;
  Progress progress;
  return findRigger(rigger).rig(mesh, options, progress);
}

Skeleton tableRig(std::string_view rigger, const TriMesh& mesh) {
  return tableAutoRig(rigger, mesh).skeleton;
}

void expectSameJoints(const Skeleton& skeleton, const Skeleton& other) {
  ASSERT_EQ(skeleton.jointCount(), other.jointCount());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    EXPECT_EQ(skeleton.joints[j].name, other.joints[j].name);
    EXPECT_EQ(skeleton.joints[j].rest.translation, other.joints[j].rest.translation);
    EXPECT_EQ(skeleton.joints[j].radius, other.joints[j].radius);
  }
}

TEST(AutoRigger, LooseVerticesMakeNoDifference) {
  const TriMesh mesh = testing::blockBiped(1);
  for (const char* rigger : {"sphere-mesh", "curve-skeleton", kPropRigger}) {
    SCOPED_TRACE(rigger);
    const Skeleton expected = tableRig(rigger, mesh);
    for (const float far : {7.f, 1e5f}) {
      TriMesh loose = mesh;
      loose.positions.push_back({far, 2 * far, 0});
      loose.positions.insert(loose.positions.begin(), Vec3f(0, 0, far));
      for (Triangle& t : loose.triangles) {
        for (Index& v : t) ++v;
      }
      expectSameJoints(tableRig(rigger, loose), expected);
    }
  }
}

TEST(AutoRigger, LooseVerticesAreOfNoRegion) {
  TriMesh mesh = testing::blockBiped(1);
  const std::vector<Index> expected = tableAutoRig("sphere-mesh", mesh).jointOf;
  mesh.positions.insert(mesh.positions.begin(), Vec3f(0, 0, 7));
  for (Triangle& t : mesh.triangles) {
    for (Index& v : t) ++v;
  }
  std::vector<Index> jointOf = tableAutoRig("sphere-mesh", mesh).jointOf;
  ASSERT_EQ(jointOf.size(), mesh.positions.size());
  EXPECT_EQ(jointOf.front(), kNoIndex);
  jointOf.erase(jointOf.begin());
  EXPECT_EQ(jointOf, expected);
}

TEST(AutoRigger, AFarBitTakesNoHandle) {
  const TriMesh mesh = testing::blockBiped(1);
  TriMesh bit = testing::octahedron();
  for (Vec3f& p : bit.positions) p *= 0.1f;
  for (const float far : {100.f, 1e5f}) {
    SCOPED_TRACE(far);
    const Skeleton skeleton = tableRig("sphere-mesh", testing::joined(mesh, bit, Vec3f(0, far, 0)));
    const Skeleton expected = tableRig("sphere-mesh", mesh);
    ASSERT_EQ(skeleton.jointCount(), expected.jointCount());
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      EXPECT_TRUE(skeleton.joints[j].rest.translation.isApprox(expected.joints[j].rest.translation, 1e-3)) << j;
    }
  }
}

}  // namespace
}  // namespace limber
