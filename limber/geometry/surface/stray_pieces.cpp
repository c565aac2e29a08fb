#include "limber/geometry/surface/stray_pieces.h"

#include <algorithm>
#include <utility>

#include "limber/core/disjoint_sets.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/surface/piece_links.h"

namespace limber {

namespace {

constexpr double kTiny = 0.02;  // of the area of the largest piece in what a stray cluster floats beside

// Clusters as a forest: each is a piece, or what two clusters became. Parents come after their children.
struct Cluster {
  double area = 0;
  double largest = 0;   // area of a piece in it
  double fraction = 1;  // within its parent
  Index parent = kNoIndex;
};

class ClusterForest {
 public:
  ClusterForest(std::span<const double> areas, std::span<const VertexPair> edges)
      : sets_(areas.size()), clusterOf_(areas.size(), kNoIndex), pieceOf_(areas.size()) {
    for (const auto& [a, b] : edges) sets_.unite(a, b);
    for (Index v = 0; v < areas.size(); ++v) {
      Index& cluster = clusterOf_[sets_.find(v)];
      if (cluster == kNoIndex) {
        cluster = static_cast<Index>(clusters_.size());
        clusters_.emplace_back();
      }
      clusters_[cluster].area += areas[v];
      pieceOf_[v] = cluster;
    }
    for (Cluster& piece : clusters_) piece.largest = piece.area;
  }

  void join(Index a, Index b, double distanceSquared) {
    const Index first = clusterOf_[sets_.find(a)], second = clusterOf_[sets_.find(b)];
    if (!sets_.unite(a, b)) return;
    const Index joined = static_cast<Index>(clusters_.size());
    const bool firstIsSmaller = clusters_[first].area < clusters_[second].area;
    Cluster& small = clusters_[firstIsSmaller ? first : second];
    const Cluster& large = clusters_[firstIsSmaller ? second : first];
    if (small.area < kTiny * large.largest && small.area < distanceSquared) {
      const double nearness = small.area / distanceSquared;
      small.fraction = nearness * nearness;
    }
    const Cluster both = {small.area + large.area, std::max(small.largest, large.largest), 1, kNoIndex};
    clusters_[first].parent = clusters_[second].parent = joined;
    clusters_.push_back(both);
    clusterOf_[sets_.find(a)] = joined;
  }

  std::vector<double> fractionsOfPoints() {
    for (std::size_t c = clusters_.size(); c-- > 0;) {
      if (clusters_[c].parent != kNoIndex) clusters_[c].fraction *= clusters_[clusters_[c].parent].fraction;
    }
    std::vector<double> fractions(pieceOf_.size());
    for (std::size_t v = 0; v < fractions.size(); ++v) fractions[v] = clusters_[pieceOf_[v]].fraction;
    return fractions;
  }

 private:
  DisjointSets sets_;
  std::vector<Index> clusterOf_;  // at the name of each set
  std::vector<Index> pieceOf_;    // per point: the cluster that it began in
  std::vector<Cluster> clusters_;
};

}  // namespace

std::vector<double> strayFractions(std::span<const Vec3f> points, std::span<const double> areas,
                                   std::span<const VertexPair> edges, std::span<const VertexPair> links) {
  ClusterForest forest(areas, edges);
  std::vector<std::pair<double, VertexPair>> byLength;
  byLength.reserve(links.size());
  for (const auto& [a, b] : links) {
    byLength.push_back({(points[a] - points[b]).cast<double>().squaredNorm(), {a, b}});
  }
  std::sort(byLength.begin(), byLength.end());
  for (const auto& [distanceSquared, link] : byLength) forest.join(link[0], link[1], distanceSquared);
  return forest.fractionsOfPoints();
}

std::optional<TriMesh> withoutStrays(const TriMesh& mesh) {
  constexpr double kStray = 0.5;  // fraction below which a triangle is left out
  Index pieces = 0;
  vertexComponents(mesh, &pieces);
  if (pieces < 2) return std::nullopt;
  const SurfaceEdges surface = surfaceEdges(mesh);
  const std::vector<double> fractions =
      strayFractions(mesh.positions, vertexAreas(mesh), surface.edges, pieceLinks(mesh.positions, surface.edges));
  TriMesh kept{mesh.positions, {}};
  for (const Triangle& t : mesh.triangles) {
    if (fractions[t[0]] >= kStray) kept.triangles.push_back(t);
  }
  if (kept.triangleCount() == mesh.triangleCount()) return std::nullopt;
  return kept;
}

}  // namespace limber
