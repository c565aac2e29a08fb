#include "limber/skeleton/chain.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// A trunk 0-1-2 that forks at 2 into 3-4 and 5-6-7, and another root 8.
Skeleton forked() {
  const std::optional<Index> parents[] = {{}, 0, 1, 2, 3, 2, 5, 6, {}};
  Skeleton skeleton;
  for (const std::optional<Index>& parent : parents) {
    Joint joint;
    joint.name.assign(1, static_cast<char>('a' + skeleton.jointCount()));
    joint.parent = parent;
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

TEST(Chain, AncestorsAreThoseOnTheWayToTheRoot) {
  const Skeleton skeleton = forked();
  EXPECT_TRUE(isAncestorOrSelf(skeleton, 2, 7));
  EXPECT_TRUE(isAncestorOrSelf(skeleton, 7, 7));
  EXPECT_FALSE(isAncestorOrSelf(skeleton, 3, 7));
  EXPECT_FALSE(isAncestorOrSelf(skeleton, 7, 2));
  EXPECT_FALSE(isAncestorOrSelf(skeleton, 0, 8));
  EXPECT_EQ(rootOf(skeleton, 7), 0u);
  EXPECT_EQ(rootOf(skeleton, 8), 8u);
}

}  // namespace
}  // namespace limber
