// The plan against what any factorisation needs of it, with the fill worked out entry by entry.
#include "limber/geometry/solve/front_tree.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {
namespace {

class FrontTreeCatalogue : public ::testing::TestWithParam<testing::NamedMesh> {
 protected:
  FrontTreeCatalogue()
      : matrix_(robustLaplacian(GetParam().mesh, vertexComponents(GetParam().mesh)).stiffness),
        tree_(planFronts(matrix_)) {}

  // By position: the later positions that elimination in this order fills.
  std::vector<std::set<Index>> fill() const {
    std::vector<std::set<Index>> rows(tree_.positionOf.size());
    for (int column = 0; column < matrix_.cols(); ++column) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix_, column); it; ++it) {
        const auto [early, late] = std::minmax(tree_.positionOf[column], tree_.positionOf[it.row()]);
        if (early != late) rows[early].insert(late);
      }
    }
    for (Index index = 0; index < rows.size(); ++index) {
      if (rows[index].empty()) continue;
      const Index parent = *rows[index].begin();
      rows[parent].insert(std::next(rows[index].begin()), rows[index].end());
    }
    return rows;
  }

  Eigen::SparseMatrix<double> matrix_;
  FrontTree tree_;
};

TEST_P(FrontTreeCatalogue, EveryUnknownHasAPlaceInOneFront) {
  std::vector<Index> indices = tree_.positionOf;
  std::sort(indices.begin(), indices.end());
  for (Index i = 0; i < indices.size(); ++i) EXPECT_EQ(indices[i], i);
  Index next = 0;
  for (const FrontPlan& front : tree_.fronts) {
    EXPECT_EQ(front.begin, next);
    EXPECT_GT(front.end, front.begin);
    next = front.end;
  }
  EXPECT_EQ(next, indices.size());
}

TEST_P(FrontTreeCatalogue, RowsHoldAllFill) {
  const std::vector<std::set<Index>> filled = fill();
  for (const FrontPlan& front : tree_.fronts) {
    EXPECT_TRUE(std::is_sorted(front.rows.begin(), front.rows.end()));
    for (Index index = front.begin; index < front.end; ++index) {
      for (const Index row : filled[index]) {
        EXPECT_TRUE(row < front.end || std::binary_search(front.rows.begin(), front.rows.end(), row));
      }
    }
  }
}

TEST_P(FrontTreeCatalogue, ChildrenHandOnToTheirParent) {
  std::vector<int> parents(tree_.fronts.size(), 0);
  for (Index i = 0; i < tree_.fronts.size(); ++i) {
    const FrontPlan& front = tree_.fronts[i];
    for (const Index child : front.children) {
      ASSERT_LT(child, i);
      ++parents[child];
      const std::vector<Index>& rows = tree_.fronts[child].rows;
      ASSERT_FALSE(rows.empty());
      EXPECT_GE(rows.front(), front.begin);
      EXPECT_LT(rows.front(), front.end);
      for (const Index row : rows) {
        EXPECT_TRUE(row < front.end || std::binary_search(front.rows.begin(), front.rows.end(), row));
      }
    }
  }
  for (Index i = 0; i < tree_.fronts.size(); ++i) EXPECT_EQ(parents[i], tree_.fronts[i].rows.empty() ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(, FrontTreeCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

}  // namespace
}  // namespace limber
