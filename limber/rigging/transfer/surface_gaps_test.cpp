#include "limber/rigging/transfer/surface_gaps.h"

#include <gmock/gmock.h>

#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

TEST(SurfaceGapsTest, NamesThePartThatLiesApart) {
  const RiggedBody person = testing::riggedCapsulePerson();
  const Index hand = *person.skeleton.find("leftHand");
  std::vector<SurfacePoint> points(person.mesh.vertexCount());
  for (Index v = 0; v < person.mesh.vertexCount(); ++v) {
    points[v].position = person.mesh.position(v);
    if (person.weights.jointsOf(v)[0] == hand) points[v].position.z() += 0.1;
  }
  const SurfaceGaps gaps = measureGaps(person.mesh, points, readAnatomy(person.skeleton), person.weights, 2);
  EXPECT_NEAR(gaps.worst, 5, 1e-4);  // percent of the height
  EXPECT_EQ(gaps.parts.front().part, "left hand");
  EXPECT_NEAR(gaps.parts.front().rms, 5, 1e-4);
  EXPECT_NEAR(gaps.parts.front().beyond, 1, 1e-9);
  EXPECT_NEAR(gaps.beyond, gaps.parts.front().area, 1e-9);
  EXPECT_EQ(gaps.parts[1].beyond, 0);
}

}  // namespace

}  // namespace limber
