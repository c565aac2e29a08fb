#include "limber/geometry/surface/piece_links.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limber/core/disjoint_sets.h"
#include "limber/core/sort_unique.h"
#include "limber/geometry/surface/point_tree.h"

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
    sortUnique(links_);
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
  std::vector<Candidate> alongTheCurve() const;

  std::span<const Vec3f> points_;
  std::span<const VertexPair> edges_;
  DisjointSets& sets_;
  PointTree tree_;
  std::vector<Index> pieces_;  // per point: the name of its piece at the start of the round
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
  constexpr float kTouching = 0.5f;             // of the mean length of a point's edges
  std::vector<float> reach(points_.size(), 0);  // squared
  for (Index v = 0; v < points_.size(); ++v) {
    if (degree[v] > 0) reach[v] = std::pow(kTouching * sum[v] / static_cast<float>(degree[v]), 2.0f);
  }
  const std::vector<float> partReach = tree_.largestOf(reach);
  std::vector<Index> touching(points_.size(), kNoIndex);
  tree_.forNearPairs([&](PointTree::Part part) { return partReach[part]; },
                     [&](Index a, Index b, float distanceSquared) {
                       for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
                         if (degree[from] == 0 || distanceSquared > reach[from]) continue;
                         if (distanceSquared == reach[from] && to >= touching[from]) continue;
                         reach[from] = distanceSquared;
                         touching[from] = to;
                       }
                     });
  for (Index v = 0; v < touching.size(); ++v) {
    if (touching[v] != kNoIndex) links_.push_back({std::min(v, touching[v]), std::max(v, touching[v])});
  }
  for (const auto& [a, b] : links_) sets_.unite(a, b);
  refreshPieces();
}

// Per piece, at its name: the nearest other piece among those that it is beside on the tree's curve. Not the nearest of
// all, but it is found in one pass, and bounds the search well.
std::vector<PieceLinker::Candidate> PieceLinker::alongTheCurve() const {
  constexpr std::size_t kAhead = 4;
  std::vector<Candidate> best(points_.size());
  const std::vector<Index>& order = tree_.order();
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(order.size(), i + 1 + kAhead); ++j) {
      const Index a = order[i], b = order[j];
      if (pieces_[a] == pieces_[b]) continue;
      const Candidate found{(points_[a] - points_[b]).squaredNorm(), {std::min(a, b), std::max(a, b)}};
      for (const Index v : {a, b}) best[pieces_[v]] = std::min(best[pieces_[v]], found);
    }
  }
  return best;
}

// One round of Boruvka's algorithm: every piece to the one nearest to it.
void PieceLinker::joinNearest() {
  std::vector<Candidate> best = alongTheCurve();
  std::vector<float> reach(points_.size());
  for (Index v = 0; v < points_.size(); ++v) reach[v] = best[pieces_[v]].distanceSquared;
  const std::vector<float> partReach = tree_.largestOf(reach);
  tree_.forNearPairs(
      [&](PointTree::Part part) {
        const Index piece = tree_.pieceOf(part);
        return piece == kNoIndex ? partReach[part] : best[piece].distanceSquared;
      },
      [&](Index a, Index b, float distanceSquared) {
        const Candidate found{distanceSquared, {std::min(a, b), std::max(a, b)}};
        for (const Index v : {a, b}) best[pieces_[v]] = std::min(best[pieces_[v]], found);
      });
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
