#include "limber/core/srgb.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Srgb, ThereAndBackIsTheSame) {
  for (int byte = 0; byte < 256; ++byte) EXPECT_NEAR(srgbOf(linearOf(byte / 255.0)), byte / 255.0, 1e-7) << byte;
  EXPECT_NEAR(linearOf(0.5), 0.21404114, 1e-7);
  EXPECT_EQ(linearOf(1), 1);
}

// A library's power may be a few units in the last place off: that never reaches the next float.
TEST(Srgb, IntegerColorsAreTheSameByAnyLibrarysPowers) {
  for (const int most : {255, 65535}) {
    for (int level = 0; level <= most; ++level) {
      const double srgb = double(level) / most;
      if (srgb <= 0.04045) continue;
      const double decoded = std::pow((srgb + 0.055) / 1.055, 2.4);
      const double error = 8 * std::numeric_limits<double>::epsilon() * decoded;
      EXPECT_EQ(static_cast<float>(decoded - error), static_cast<float>(decoded + error)) << level;
    }
  }
}

}  // namespace
}  // namespace limber
