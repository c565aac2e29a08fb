#include "limber/document/up_axis.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(UpAxis, TurnsItsAxisUpAndKeepsX) {
  const Vec3 y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::pair<UpAxis, Vec3> axes[] = {
      {UpAxis::kY, y}, {UpAxis::kZ, z}, {UpAxis::kMinusY, -y}, {UpAxis::kMinusZ, -z}};
  for (const auto& [axis, up] : axes) {
    Vec3 turned = up, x = Vec3::UnitX(), any(1, 2, 3);
    turnUpright(turned, axis);
    turnUpright(x, axis);
    turnUpright(any, axis);
    EXPECT_EQ(turned, y);
    EXPECT_EQ(x, Vec3(Vec3::UnitX()));
    EXPECT_LT((uprightTurn(axis) * Vec3(1, 2, 3) - any).norm(), 1e-12) << "the same turn as a quaternion";
    EXPECT_EQ(opposite(opposite(axis)), axis);
    EXPECT_EQ(upAxisNamed(nameOf(axis)), axis);
  }
  EXPECT_EQ(upAxisNamed("auto"), std::nullopt);
}

}  // namespace
}  // namespace limber
