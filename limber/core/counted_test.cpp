#include "limber/core/counted.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Counted, OneIsNoPlural) {
  EXPECT_EQ(counted(0, "joint"), "0 joints");
  EXPECT_EQ(counted(1, "joint"), "1 joint");
  EXPECT_EQ(counted(2, "joint"), "2 joints");
  EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(counted(7, "vertex", "vertices"), "7 vertices");
}

}  // namespace
}  // namespace limber
