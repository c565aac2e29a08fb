#include "limber/skeleton/skin_weights.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(SkinWeights, RowsAreVertices) {
  const SkinWeights weights{2, {5, 6, 7, 8}, {0.75f, 0.25f, 1, 0}};
  EXPECT_EQ(weights.vertexCount(), 2u);
  EXPECT_EQ(weights.jointsOf(1)[0], 7u);
  EXPECT_EQ(weights.weightsOf(0)[1], 0.25f);
  EXPECT_EQ(SkinWeights().vertexCount(), 0u);
}

TEST(ExpandWeights, GivesEverySourceVertexTheRowOfItsWeldedOne) {
  const SkinWeights welded{2, {5, 6, 7, 8}, {0.75f, 0.25f, 1, 0}};
  const SkinWeights expanded = expandWeights(welded, std::vector<Index>{1, 0, 0, 1, 1});
  EXPECT_EQ(expanded.slots, 2u);
  EXPECT_EQ(expanded.joints, (std::vector<Index>{7, 8, 5, 6, 5, 6, 7, 8, 7, 8}));
  EXPECT_EQ(expanded.weights, (std::vector<float>{1, 0, 0.75f, 0.25f, 0.75f, 0.25f, 1, 0, 1, 0}));
}

}  // namespace
}  // namespace limber
