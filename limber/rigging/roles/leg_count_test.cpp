#include "limber/rigging/roles/leg_count.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/prepare.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/body/testing/capsule_animal.h"

namespace limber {

namespace {

// The mesh is in the body's frame.
std::size_t legsOf(const TriMesh& raw) {
  const TriMesh mesh = prepareMesh(raw.positions, raw.triangles).mesh;
  const BodyVolume body = measureBody(mesh);
  const std::shared_ptr<const ReadingWeights> weights = shapeWeights();
  const RoleReading reading(sampleSurface(mesh, weights->sampleCount()), *weights,
                            possibleFrames(mesh, body, Vec3::UnitY(), Vec3::UnitZ()).front());
  return countLegs(body, reading);
}

}  // namespace

// Head and abdomen end, too.
TEST(LegCount, IsThatOfTheEndsOfLegs) {
  EXPECT_EQ(legsOf(testing::capsuleSpider(3)), 6u);
  EXPECT_EQ(legsOf(testing::capsuleSpider(4)), 8u);
}

}  // namespace limber
