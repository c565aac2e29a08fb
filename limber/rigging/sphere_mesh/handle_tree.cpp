#include "limber/rigging/sphere_mesh/handle_tree.h"

#include <algorithm>

#include "limber/core/disjoint_sets.h"
#include "limber/geometry/surface/piece_links.h"

namespace limber {

namespace {

// Works on orbits: a handle with its image, named by the first of the two.
class TreeMaker {
 public:
  explicit TreeMaker(const SphereMeshLevel& level)
      : level_(level), sets_(level.spheres.size()), neighbors_(level.spheres.size()) {}

  HandleTree run() {
    joinPlane();
    joinOrbits();
    joinSides();
    const Index root = findRoot();
    return hangFrom(root);
  }

 private:
  Index imageOf(Index h) const { return level_.images.empty() || level_.images[h] == kNoIndex ? h : level_.images[h]; }
  Index orbitOf(Index h) const { return std::min(h, imageOf(h)); }
  // On the plane; without symmetry every handle counts as such. A handle that has lost its image does not.
  bool onPlane(Index h) const { return level_.images.empty() || level_.images[h] == h; }
  bool hasLostImage(Index h) const { return !level_.images.empty() && level_.images[h] == kNoIndex; }
  double cost(Index a, Index b) const;

  void connect(Index a, Index b) {
    neighbors_[a].push_back(b);
    neighbors_[b].push_back(a);
  }
  std::vector<VertexPair> byCost(std::vector<VertexPair> edges) const;

  void joinPlane();
  void joinOrbits();
  void joinSides();
  Index findRoot() const;
  HandleTree hangFrom(Index root) const;
  void spread(Index root, std::vector<Index>& order, std::vector<Index>& parents) const;
  double volume(Index h) const { return level_.weights[h] * (level_.spheres[h].radius + 1e-9) + 1e-15; }

  const SphereMeshLevel& level_;
  DisjointSets sets_;                          // of orbits
  std::vector<std::vector<Index>> neighbors_;  // of the tree, per handle
};

// The gap between the spheres, and a part of the distance, so that of touching spheres the nearest are linked.
double TreeMaker::cost(Index a, Index b) const {
  const Sphere &s = level_.spheres[a], &t = level_.spheres[b];
  const double distance = (s.center - t.center).norm();
  return std::max(0.0, distance - s.radius - t.radius) + 0.25 * distance;
}

std::vector<VertexPair> TreeMaker::byCost(std::vector<VertexPair> edges) const {
  std::vector<std::pair<double, VertexPair>> costs;
  costs.reserve(edges.size());
  for (const VertexPair& edge : edges) costs.push_back({cost(edge[0], edge[1]), edge});
  std::sort(costs.begin(), costs.end());
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = costs[i].second;
  return edges;
}

// The handles on the plane hang together by edges between them or, where these do not suffice, by the shortest links:
// one that hung on a handle beside the plane would have to hang on its image as well.
void TreeMaker::joinPlane() {
  std::vector<Index> plane;
  std::vector<Index> indices(level_.spheres.size(), kNoIndex);
  for (Index h = 0; h < level_.spheres.size(); ++h) {
    if (!onPlane(h)) continue;
    indices[h] = static_cast<Index>(plane.size());
    plane.push_back(h);
  }
  std::vector<VertexPair> within;
  for (const VertexPair& edge : level_.edges) {
    if (onPlane(edge[0]) && onPlane(edge[1])) within.push_back(edge);
  }
  std::vector<VertexPair> joined;
  for (const auto& [a, b] : byCost(within)) {
    if (!sets_.unite(a, b)) continue;
    connect(a, b);
    joined.push_back({indices[a], indices[b]});
  }
  if (joined.size() + 1 >= plane.size()) return;
  std::vector<Vec3f> centers;
  for (const Index h : plane) centers.push_back(level_.spheres[h].center.cast<float>());
  std::vector<VertexPair> links = pieceLinks(centers, joined);
  for (auto& [a, b] : links) {
    a = plane[a];
    b = plane[b];
  }
  for (const auto& [a, b] : byCost(links)) {
    if (sets_.unite(a, b)) connect(a, b);
  }
}

void TreeMaker::joinOrbits() {
  std::vector<VertexPair> edges;
  for (const auto& [a, b] : level_.edges) {
    // Of an edge and its image the one is taken that begins at an orbit's first handle.
    if (orbitOf(a) == a) {
      edges.push_back({a, b});
    } else if (orbitOf(b) == b) {
      edges.push_back({b, a});
    }
  }
  for (const auto& [a, b] : byCost(edges)) {
    if (!sets_.unite(orbitOf(a), orbitOf(b))) continue;
    connect(a, b);
    const bool mirrored = imageOf(a) != a || imageOf(b) != b;
    if (mirrored && !hasLostImage(a) && !hasLostImage(b)) connect(imageOf(a), imageOf(b));
  }
}

// Without a handle on the plane there are now two trees, one the image of the other.
void TreeMaker::joinSides() {
  if (level_.images.empty()) return;
  Index best = kNoIndex;
  double bestCost = 0;
  for (Index h = 0; h < level_.spheres.size(); ++h) {
    if (onPlane(h)) return;
    if (level_.images[h] == kNoIndex || imageOf(h) < h) continue;
    const double c = cost(h, imageOf(h));
    if (best == kNoIndex || c < bestCost) {
      best = h;
      bestCost = c;
    }
  }
  connect(best, imageOf(best));
}

void TreeMaker::spread(Index root, std::vector<Index>& order, std::vector<Index>& parents) const {
  order.assign(1, root);
  parents.assign(neighbors_.size(), kNoIndex);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const Index next : neighbors_[order[i]]) {
      if (next == parents[order[i]]) continue;
      parents[next] = order[i];
      order.push_back(next);
    }
  }
}

// The weighted median of the tree, by sums over subtrees and one pass down.
Index TreeMaker::findRoot() const {
  std::vector<Index> order, parents;
  spread(0, order, parents);
  const auto length = [&](Index a, Index b) { return (level_.spheres[a].center - level_.spheres[b].center).norm(); };
  std::vector<double> below(order.size()), sum(order.size(), 0);
  double total = 0;
  for (Index h = 0; h < below.size(); ++h) total += below[h] = volume(h);
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    const Index h = order[i], parent = parents[h];
    below[parent] += below[h];
    sum[parent] += sum[h] + below[h] * length(h, parent);
  }
  const bool anyOnPlane = [&] {
    for (Index h = 0; h < order.size(); ++h) {
      if (onPlane(h)) return true;
    }
    return false;
  }();
  Index best = kNoIndex;
  for (const Index h : order) {
    if (parents[h] != kNoIndex) sum[h] = sum[parents[h]] + (total - 2 * below[h]) * length(h, parents[h]);
    if (anyOnPlane ? !onPlane(h) : orbitOf(h) != h) continue;
    if (best == kNoIndex || sum[h] < sum[best] || (sum[h] == sum[best] && h < best)) best = h;
  }
  return best;
}

HandleTree TreeMaker::hangFrom(Index root) const {
  std::vector<Index> order, parents;
  spread(root, order, parents);
  std::vector<double> below(order.size());
  for (Index h = 0; h < below.size(); ++h) below[h] = volume(h);
  for (std::size_t i = order.size() - 1; i > 0; --i) below[parents[order[i]]] += below[order[i]];

  HandleTree tree;
  std::vector<Index> joints(order.size(), kNoIndex);
  const auto addJoint = [&](Index h) {
    if (joints[h] != kNoIndex) return;
    joints[h] = static_cast<Index>(tree.order.size());
    tree.order.push_back(h);
    tree.parents.push_back(parents[h] == kNoIndex ? std::nullopt : std::optional<Index>(joints[parents[h]]));
  };
  addJoint(root);
  if (imageOf(root) != root) addJoint(imageOf(root));
  for (std::size_t i = 0; i < tree.order.size(); ++i) {
    std::vector<Index> children;
    for (const Index next : neighbors_[tree.order[i]]) {
      if (joints[next] == kNoIndex) children.push_back(next);
    }
    std::sort(children.begin(), children.end(), [&](Index a, Index b) {
      const Index orbitA = orbitOf(a), orbitB = orbitOf(b);
      if (below[orbitA] != below[orbitB]) return below[orbitA] > below[orbitB];
      return orbitA != orbitB ? orbitA < orbitB : a < b;
    });
    for (const Index child : children) {
      addJoint(child);
      // The image's parent is the image of this parent: it has been placed with it.
      if (imageOf(child) != child) addJoint(imageOf(child));
    }
  }
  return tree;
}

}  // namespace

HandleTree handleTree(const SphereMeshLevel& level) {
  return TreeMaker(level).run();
}

}  // namespace limber
