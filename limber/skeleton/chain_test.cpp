#include "limber/skeleton/chain.h"

#include <gmock/gmock.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::ElementsAre;

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

TEST(Chain, ChainsEndWhereTheSkeletonForks) {
  const std::vector<JointChain> chains = jointChains(forked());
  ASSERT_EQ(chains.size(), 4u);
  EXPECT_THAT(chains[0].joints, ElementsAre(0, 1, 2));
  EXPECT_THAT(chains[1].joints, ElementsAre(3, 4));
  EXPECT_THAT(chains[2].joints, ElementsAre(5, 6, 7));
  EXPECT_THAT(chains[3].joints, ElementsAre(8));
  EXPECT_FALSE(chains[0].above);
  EXPECT_EQ(chains[1].above, 0u);
  EXPECT_EQ(chains[2].above, 0u);
  EXPECT_FALSE(chains[3].above);
}

TEST(Chain, AnEmptySkeletonHasNoChain) {
  EXPECT_TRUE(jointChains({}).empty());
}

TEST(Chain, ALimbRunsUpAndDown) {
  const Skeleton skeleton = forked();
  EXPECT_THAT(limbBetween(skeleton, 0, 4), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(limbBetween(skeleton, 4, 1), ElementsAre(4, 3, 2, 1));
  EXPECT_THAT(limbBetween(skeleton, 4, 7), ElementsAre(4, 3, 2, 5, 6, 7));
  EXPECT_THAT(limbBetween(skeleton, 3, 3), ElementsAre(3));
}

TEST(Chain, ALimbNeedsACommonRootAndRealJoints) {
  const Skeleton skeleton = forked();
  EXPECT_THROW(limbBetween(skeleton, 4, 8), Error);
  EXPECT_THROW(limbBetween(skeleton, 4, 9), Error);
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
