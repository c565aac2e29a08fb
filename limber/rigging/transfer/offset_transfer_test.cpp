#include "limber/rigging/transfer/offset_transfer.h"

#include <cmath>

#include <gmock/gmock.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/transfer/weight_projection.h"

namespace limber {

namespace {

TEST(OffsetTransferTest, TurnsOffsetsAsTheSurfaceIsTurned) {
  const TriMesh sphere = testing::icosphere(2);
  const Mat3 turn = Eigen::AngleAxisd(1.9, Vec3(2, -1, 1).normalized()).toRotationMatrix();
  std::vector<Vec3> after;
  TriMesh target = sphere;
  std::vector<Vec3f> offsets;
  for (Index v = 0; v < sphere.vertexCount(); ++v) {
    after.push_back(turn * sphere.position(v) + Vec3(1, 0, 0));
    target.positions[v] = after.back().cast<float>();
    const double angle = v;
    offsets.push_back(Vec3(0.1 * std::sin(angle), 0.2, 0.1 * std::cos(angle)).cast<float>());
  }
  const std::vector<Mat3> gradients = deformationGradients(sphere, after);
  const std::vector<Vec3f> carried = carriedOffsets(sphere, gradients, offsets, takenAfter(target, target));
  for (Index v = 0; v < sphere.vertexCount(); ++v) {
    ASSERT_LT((carried[v].cast<double>() - turn * offsets[v].cast<double>()).norm(), 1e-5);
  }
}

TEST(OffsetTransferTest, GradientsOfAScaleAreThatScale) {
  const TriMesh sphere = testing::icosphere(2);
  std::vector<Vec3> after;
  for (Index v = 0; v < sphere.vertexCount(); ++v) after.push_back(3 * sphere.position(v));
  for (const Mat3& gradient : deformationGradients(sphere, after)) {
    ASSERT_LT((gradient - 3 * Mat3::Identity()).norm(), 1e-4);
  }
}

TEST(OffsetTransferTest, AreTheIdentityWithoutATriangle) {
  TriMesh mesh = testing::icosphere(1);
  mesh.positions.push_back({9, 9, 9});
  std::vector<Vec3> after(mesh.positions.size(), Vec3::Zero());
  EXPECT_EQ(deformationGradients(mesh, after).back(), Mat3(Mat3::Identity()));
}

}  // namespace

}  // namespace limber
