#include "limber/geometry/solve/front_tree.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>

#include "limber/core/sort_unique.h"

namespace limber {

namespace {

constexpr Index kWholeSubtree = 8;      // unknowns; a subtree of at most so many is one front
constexpr double kZerosAllowed = 0.25;  // part of a front's entries that may be zeros added by gathering columns

std::vector<Index> minimumDegreeOrder(const Eigen::SparseMatrix<double>& lower) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(lower.selfadjointView<Eigen::Lower>(), order);
  std::vector<Index> positionOf(lower.cols());
  for (Eigen::Index index = 0; index < lower.cols(); ++index) {
    positionOf[order.indices()[index]] = static_cast<Index>(index);
  }
  return positionOf;
}

// Entries by the earlier (`byLater` false) or the later of their two positions in the order.
PermutedEntries permuteEntries(const Eigen::SparseMatrix<double>& lower, const std::vector<Index>& positionOf,
                               bool byLater) {
  PermutedEntries result;
  const std::size_t count = positionOf.size();
  const auto forEachEntry = [&](const auto& visit) {
    for (std::size_t column = 0; column < count; ++column) {
      for (int p = lower.outerIndexPtr()[column]; p < lower.outerIndexPtr()[column + 1]; ++p) {
        const auto [early, late] = std::minmax(positionOf[column], positionOf[lower.innerIndexPtr()[p]]);
        visit(byLater ? late : early, byLater ? early : late, p);
      }
    }
  };
  result.first.assign(count + 1, 0);
  forEachEntry([&](Index column, Index, int) { ++result.first[column + 1]; });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.row.resize(static_cast<std::size_t>(result.first.back()));
  result.position.resize(result.row.size());
  std::vector<int> end(result.first.begin(), result.first.end() - 1);
  forEachEntry([&](Index column, Index row, int p) {
    result.row[end[column]] = row;
    result.position[end[column]++] = p;
  });
  return result;
}

// The parent of each position in the order, itself for a root (Liu's algorithm with path compression).
std::vector<Index> eliminationTree(const PermutedEntries& byLater) {
  const Index count = static_cast<Index>(byLater.first.size() - 1);
  std::vector<Index> parent(count), ancestor(count);
  for (Index i = 0; i < count; ++i) {
    parent[i] = ancestor[i] = i;
    for (int p = byLater.first[i]; p < byLater.first[i + 1]; ++p) {
      for (Index k = byLater.row[p]; k != i;) {
        const Index next = ancestor[k];
        ancestor[k] = i;
        if (next == k) {
          parent[k] = i;
          break;
        }
        k = next;
      }
    }
  }
  return parent;
}

// New positions so that each subtree's are contiguous and a parent comes right after its largest child's subtree.
struct Postorder {
  std::vector<Index> positionOf;  // by old position
  std::vector<Index> parent;      // by new position, itself for a root
  std::vector<Index> treeSize;    // by new position: the size of the subtree under it
};

Postorder postorder(const std::vector<Index>& parent) {
  const Index count = static_cast<Index>(parent.size());
  std::vector<Index> size(count, 1), largest(count, kNoIndex);
  for (Index i = 0; i < count; ++i) {  // children come before parents
    if (parent[i] == i) continue;
    size[parent[i]] += size[i];
    Index& best = largest[parent[i]];
    if (best == kNoIndex || size[i] >= size[best]) best = i;
  }
  // Going down from the last position, each subtree takes the positions before its root: the largest child first, then
  // the others in the order met.
  Postorder result{std::vector<Index>(count), std::vector<Index>(count), std::vector<Index>(count)};
  std::vector<Index> freeEnd(count);  // by old position: where the next child's subtree ends
  Index rootsEnd = count;
  for (Index i = count; i-- > 0;) {
    const bool root = parent[i] == i;
    Index end;
    if (root) {
      end = rootsEnd;
      rootsEnd -= size[i];
    } else if (largest[parent[i]] == i) {
      end = result.positionOf[parent[i]];
    } else {
      end = freeEnd[parent[i]];
      freeEnd[parent[i]] -= size[i];
    }
    const Index index = end - 1;
    result.positionOf[i] = index;
    freeEnd[i] = index - (largest[i] == kNoIndex ? 0 : size[largest[i]]);
    result.parent[index] = root ? index : result.positionOf[parent[i]];
    result.treeSize[index] = size[i];
  }
  return result;
}

class FrontGatherer {
 public:
  FrontGatherer(const Postorder& tree, const PermutedEntries& entries) : tree_(tree), entries_(entries) {}

  std::vector<FrontPlan> run() {
    const Index count = static_cast<Index>(tree_.parent.size());
    roots_.resize(count);
    for (Index index = 0; index < count; ++index) {
      const bool rootOfAll = tree_.parent[index] == index;
      const bool small = tree_.treeSize[index] <= kWholeSubtree;
      if (small && !rootOfAll && tree_.treeSize[tree_.parent[index]] <= kWholeSubtree) continue;
      if (small) {
        addFront(index + 1 - tree_.treeSize[index], index + 1);
      } else {
        addColumn(index);
      }
      const Index front = static_cast<Index>(fronts_.size() - 1);
      if (!rootOfAll) roots_[tree_.parent[index]].push_back(front);
    }
    return std::move(fronts_);
  }

 private:
  // The entries of the columns begin to end that reach further.
  void addFront(Index begin, Index end) {
    FrontPlan front;
    front.begin = begin;
    front.end = end;
    for (int p = entries_.first[begin]; p < entries_.first[end]; ++p) {
      if (entries_.row[p] >= end) front.rows.push_back(entries_.row[p]);
    }
    sortUnique(front.rows);
    fronts_.push_back(std::move(front));
    zeros_.push_back(0);
  }

  void addColumn(Index index) {
    addFront(index, index + 1);
    FrontPlan column = std::move(fronts_.back());
    fronts_.pop_back();
    zeros_.pop_back();
    column.children = std::move(roots_[index]);
    std::vector<Index> merged;
    for (const Index child : column.children) {
      const std::vector<Index>& below = fronts_[child].rows;  // its first row is this position
      merged.clear();
      std::set_union(column.rows.begin(), column.rows.end(), below.begin() + 1, below.end(),
                     std::back_inserter(merged));
      column.rows.swap(merged);
    }
    // The front before this column is that of its largest child.
    const std::size_t last = fronts_.size() - 1;
    const double zeros = zeros_[last] + static_cast<double>(fronts_[last].ownCount()) *
                                            static_cast<double>(column.rows.size() + 1 - fronts_[last].rows.size());
    const double own = fronts_[last].ownCount() + 1;
    if (zeros <= kZerosAllowed * own * (0.5 * own + static_cast<double>(column.rows.size()))) {
      FrontPlan& front = fronts_[last];
      front.end = index + 1;
      front.rows = std::move(column.rows);
      column.children.pop_back();
      front.children.insert(front.children.end(), column.children.begin(), column.children.end());
      std::sort(front.children.begin(), front.children.end());
      zeros_[last] = zeros;
      return;
    }
    fronts_.push_back(std::move(column));
    zeros_.push_back(0);
  }

  const Postorder& tree_;
  const PermutedEntries& entries_;
  std::vector<FrontPlan> fronts_;
  std::vector<double> zeros_;              // by front: entries that are zero but kept
  std::vector<std::vector<Index>> roots_;  // by position: fronts whose first row it is
};

}  // namespace

FrontTree planFronts(const Eigen::SparseMatrix<double>& lower) {
  FrontTree result;
  result.positionOf = minimumDegreeOrder(lower);
  const Postorder tree = postorder(eliminationTree(permuteEntries(lower, result.positionOf, true)));
  for (Index& index : result.positionOf) index = tree.positionOf[index];
  result.entries = permuteEntries(lower, result.positionOf, false);
  result.fronts = FrontGatherer(tree, result.entries).run();
  return result;
}

}  // namespace limber
