#include "limber/rigging/sphere_mesh/edge_heap.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

TEST(EdgeHeap, EmptiesInOrderOfKeyThenIndex) {
  constexpr float kKeys[] = {3, 1, 2, 1, 0, 5};
  EdgeHeap heap;
  heap.reset(6);
  for (Index e = 0; e < 6; ++e) heap.insert(e, kKeys[e]);
  std::vector<Index> order;
  for (; !heap.empty(); heap.remove(heap.top())) order.push_back(heap.top());
  EXPECT_EQ(order, (std::vector<Index>{4, 1, 3, 2, 0, 5}));
}

TEST(EdgeHeap, AgreesWithASortedSetThroughRandomChanges) {
  constexpr Index kEdges = 300;
  testing::TestRandom random(5);
  EdgeHeap heap;
  heap.reset(kEdges);
  std::set<std::pair<float, Index>> sorted;
  std::vector<float> keys(kEdges, -1);
  for (int step = 0; step < 20000; ++step) {
    const Index edge = random.below(kEdges);
    const float key = static_cast<float>(random.below(50));
    const Index action = random.below(3);
    if (!heap.contains(edge)) {
      heap.insert(edge, key);
      sorted.insert({key, edge});
      keys[edge] = key;
    } else if (action == 0) {
      heap.remove(edge);
      sorted.erase({keys[edge], edge});
    } else {
      heap.update(edge, key);
      sorted.erase({keys[edge], edge});
      sorted.insert({key, edge});
      keys[edge] = key;
    }
    ASSERT_EQ(heap.empty(), sorted.empty());
    if (!sorted.empty()) {
      ASSERT_EQ(heap.top(), sorted.begin()->second);
    }
  }
}

}  // namespace

}  // namespace limber
