#include "limber/rigging/piece_links.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/disjoint_sets.h"
#include "limber/core/parallel.h"
#include "limber/rigging/point_tree.h"

namespace limber {

namespace {

class PieceLinker {
 public:
  PieceLinker(std::span<const Vec3f> points, std::span<const VertexPair> edges, DisjointSets& sets)
      : points_(points), edges_(edges), sets_(sets), tree_(points), pieces_(points.size()) {}

  std::vector<VertexPair> run() {
    refreshPieces();
    joinTouching();
    while (sets_.count() > 1) joinNearest();
    std::sort(links_.begin(), links_.end());
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
    return std::move(links_);
  }

 private:
  struct Candidate {
    float distanceSquared = std::numeric_limits<float>::infinity();
    VertexPair link = {kNoIndex, kNoIndex};
    bool operator<(const Candidate& other) const {
      return distanceSquared != other.distanceSquared ? distanceSquared < other.distanceSquared : link < other.link;
    }
  };

  void refreshPieces() {
    for (Index i = 0; i < points_.size(); ++i) pieces_[i] = sets_.find(i);
    tree_.setPieces(pieces_);
  }

  void joinTouching();
  void joinNearest();

  std::span<const Vec3f> points_;
  std::span<const VertexPair> edges_;
  DisjointSets& sets_;
  PointTree tree_;
  std::vector<Index> pieces_;  // per point: the name of its piece at the start of the round
  std::vector<float> clear_;   // per point: no other piece is nearer than this (squared)
  std::vector<VertexPair> links_;
};

// Every point to the nearest one of another piece, if that is closer than a fraction of the edges at the point.
void PieceLinker::joinTouching() {
  std::vector<float> sum(points_.size(), 0);
  std::vector<Index> degree(points_.size(), 0);
  for (const auto& [a, b] : edges_) {
    const float length = (points_[a] - points_[b]).norm();
    for (const Index v : {a, b}) {
      sum[v] += length;
      ++degree[v];
    }
  }
  constexpr float kTouching = 0.5f;  // of the mean length of a point's edges
  clear_.assign(points_.size(), 0);
  std::vector<Index> touching(points_.size(), kNoIndex);
  const std::vector<Index>& order = tree_.order();
  parallelFor(order.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index v = order[i];
      if (degree[v] == 0) continue;
      const float reach = kTouching * sum[v] / static_cast<float>(degree[v]);
      const PointTree::Nearest nearest = tree_.nearestOfOtherPiece(v, reach * reach);
      clear_[v] = nearest.distanceSquared;
      touching[v] = nearest.point;
    }
  });
  for (Index v = 0; v < touching.size(); ++v) {
    if (touching[v] != kNoIndex) links_.push_back({std::min(v, touching[v]), std::max(v, touching[v])});
  }
  for (const auto& [a, b] : links_) sets_.unite(a, b);
  refreshPieces();
}

// One round of Boruvka's algorithm: every piece to the one nearest to it.
void PieceLinker::joinNearest() {
  std::vector<Candidate> best(points_.size());  // per piece, at its name
  for (const Index v : tree_.order()) {
    Candidate& own = best[pieces_[v]];
    if (clear_[v] > own.distanceSquared) continue;
    const PointTree::Nearest nearest = tree_.nearestOfOtherPiece(v, own.distanceSquared);
    clear_[v] = nearest.distanceSquared;
    if (nearest.point == kNoIndex) continue;
    const Candidate found{nearest.distanceSquared, {std::min(v, nearest.point), std::max(v, nearest.point)}};
    own = std::min(own, found);
    Candidate& theirs = best[pieces_[nearest.point]];  // they are no farther from here either
    theirs = std::min(theirs, found);
  }
  const auto unfound = [](const Candidate& candidate) { return candidate.link[0] == kNoIndex; };
  best.erase(std::remove_if(best.begin(), best.end(), unfound), best.end());
  std::sort(best.begin(), best.end());
  for (const Candidate& candidate : best) {
    if (sets_.unite(candidate.link[0], candidate.link[1])) links_.push_back(candidate.link);
  }
  refreshPieces();
}

}  // namespace

std::vector<VertexPair> pieceLinks(std::span<const Vec3f> points, std::span<const VertexPair> edges) {
  DisjointSets sets(points.size());
  for (const auto& [a, b] : edges) sets.unite(a, b);
  if (sets.count() <= 1) return {};
  return PieceLinker(points, edges, sets).run();
}

}  // namespace limber
