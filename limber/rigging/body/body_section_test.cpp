#include "limber/rigging/body/body_section.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

TEST(BodySection, IsCutOutOfOnePart) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const double y = 0.16;  // of the shins
  const Vec3 seed = person.frame.toBody({0.1, y, 0.01});
  const BodySection shin = sectionAt(person.body, person.frame, seed, Vec3::UnitY(), 0.05);
  ASSERT_FALSE(shin.empty());
  EXPECT_NEAR(shin.area, M_PI * 0.038 * 0.038, 0.25 * M_PI * 0.038 * 0.038);
  EXPECT_NEAR(shin.center.x(), 0.085, 0.01);
  EXPECT_NEAR(shin.halfDepth(), 0.038, 0.008);
  EXPECT_TRUE(shin.contains(shin.center));
  EXPECT_FALSE(shin.contains(shin.center.cwiseProduct(Vec3(-1, 1, 1))));
  EXPECT_TRUE(sectionAt(person.body, person.frame, {0.4, 0.3, 0}, Vec3::UnitY(), 0.05).empty());
}

}  // namespace limber
