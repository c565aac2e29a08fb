#include "limber/rigging/transfer/whole_alignment.h"

#include <gmock/gmock.h>

#include "limber/rigging/transfer/facing_surface.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

TEST(WholeAlignmentTest, FindsTheSimilarityOfACopy) {
  const TriMesh person = testing::riggedCapsulePerson().mesh;
  Affine map = Affine::Identity();
  map.linear() = 1.7 * Eigen::AngleAxisd(0.1, Vec3(0.2, 1, 0.1).normalized()).toRotationMatrix();
  map.translation() = Vec3(-2, 0.3, 1);
  const TriMesh target = testing::mapped(person, [&](const Vec3& p) { return Vec3(map * p); });
  const Affine found = wholeSimilarity(person, target, Quat::Identity(), Vec3::UnitY());
  for (Index v = 0; v < person.vertexCount(); v += 11) {
    ASSERT_LT((found * person.position(v) - map * person.position(v)).norm(), 0.02);
  }
}

TEST(WholeAlignmentTest, MeasuresHowFarSurfacesLieApart) {
  const TriMesh person = testing::riggedCapsulePerson().mesh;
  EXPECT_LT(surfacesApart(person, person), 1e-6);
  const auto shifted = [&](double by) {
    return surfacesApart(testing::mapped(person, [&](const Vec3& p) { return Vec3(p + Vec3(0, 0, by)); }), person);
  };
  EXPECT_LT(shifted(0.02), shifted(0.05));
  EXPECT_NEAR(shifted(100), 0.1, 1e-9);  // as far as it counts
}

}  // namespace

}  // namespace limber
