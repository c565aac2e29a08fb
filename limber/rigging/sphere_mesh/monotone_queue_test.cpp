#include "limber/rigging/sphere_mesh/monotone_queue.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

TEST(MonotoneQueue, EmptiesInOrderOfKeyThenIndex) {
  MonotoneQueue queue;
  queue.fill({3, 1, 2, 1, 0, 5});
  std::vector<Index> order;
  for (; !queue.empty(); queue.remove(queue.top())) order.push_back(queue.top());
  EXPECT_EQ(order, (std::vector<Index>{4, 1, 3, 2, 0, 5}));
}

TEST(MonotoneQueue, FillsWithNothingAndOne) {
  MonotoneQueue queue;
  queue.fill({});
  EXPECT_TRUE(queue.empty());
  queue.fill({7});
  EXPECT_EQ(queue.top(), 0u);
  EXPECT_EQ(queue.key(0), 7);
}

TEST(MonotoneQueue, ASmallerKeyLeavesAnEdgeAsItIs) {
  MonotoneQueue queue;
  queue.fill({3, 4});
  queue.raise(0, 2);
  EXPECT_EQ(queue.key(0), 3);
  queue.raise(0, 5);
  EXPECT_EQ(queue.top(), 1u);
}

// Keys of every magnitude, and many alike.
float randomKey(testing::TestRandom& random) {
  const float fraction = random.below(4) == 0 ? 0.5f : static_cast<float>(random.unit());
  return random.below(20) == 0 ? 0 : std::ldexp(fraction, static_cast<int>(random.below(60)) - 50);
}

TEST(MonotoneQueue, AgreesWithASortedSetThroughRandomChanges) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    testing::TestRandom random(seed);
    std::vector<float> keys(3000);
    for (float& key : keys) key = randomKey(random);
    MonotoneQueue queue;
    queue.fill(keys);
    std::set<std::pair<float, Index>> sorted;
    for (Index e = 0; e < keys.size(); ++e) sorted.insert({keys[e], e});
    while (!sorted.empty()) {
      ASSERT_EQ(queue.top(), sorted.begin()->second);
      const bool ofTop = random.below(2) == 0;
      const Index edge = ofTop ? queue.top() : random.below(3000);
      if (!queue.contains(edge)) continue;
      ASSERT_EQ(queue.key(edge), keys[edge]);
      sorted.erase({keys[edge], edge});
      if (random.below(2) == 0) {
        queue.remove(edge);
        EXPECT_FALSE(queue.contains(edge));
      } else {
        keys[edge] = std::max(keys[edge], randomKey(random));
        queue.raise(edge, keys[edge]);
        sorted.insert({keys[edge], edge});
      }
      ASSERT_EQ(queue.empty(), sorted.empty());
    }
  }
}

}  // namespace

}  // namespace limber
