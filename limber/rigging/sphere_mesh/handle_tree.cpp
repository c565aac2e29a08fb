#include "limber/rigging/sphere_mesh/handle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "limber/core/disjoint_sets.h"

namespace limber {

namespace {

// Works on orbits: a handle with its image, named by the first of the two.
class TreeMaker {
 public:
  explicit TreeMaker(const SphereMeshLevel& level)
      : level_(level),
        sets_(level.spheres.size()),
        besidePlane_(level.spheres.size()),
        planeOf_(level.spheres.size(), kNoIndex),
        neighbors_(level.spheres.size()) {}

  HandleTree run() {
    joinNeighbors();
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
  double gap(Index a, Index b) const;
  double conductance(Index a, Index b, double border) const;

  void connect(Index a, Index b) {
    neighbors_[a].push_back(b);
    neighbors_[b].push_back(a);
  }
  std::vector<VertexPair> closestFirst() const;
  // The handle on the plane that `handle` is linked to through others beside it, at most one; itself if on the plane.
  Index onPlaneNear(Index handle) { return onPlane(handle) ? handle : planeOf_[besidePlane_.find(orbitOf(handle))]; }

  void joinNeighbors();
  void joinSides();
  std::vector<double> rootWeights() const;
  Index findRoot() const;
  HandleTree hangFrom(Index root) const;
  void spread(Index root, std::vector<Index>& order, std::vector<Index>& parents) const;
  double volume(Index h) const { return level_.weights[h] * (level_.spheres[h].radius + 1e-9) + 1e-15; }

  const SphereMeshLevel& level_;
  DisjointSets sets_;           // of orbits
  DisjointSets besidePlane_;    // of those of them that are not on the plane
  std::vector<Index> planeOf_;  // per such set, by its first: the handle on the plane that it is linked to
  std::vector<std::vector<Index>> neighbors_;  // of the tree, per handle
};

// Between the spheres, and a part of the distance, so that of touching spheres the nearest are linked.
double TreeMaker::gap(Index a, Index b) const {
  const Sphere &s = level_.spheres[a], &t = level_.spheres[b];
  const double distance = (s.center - t.center).norm();
  return std::max(0.0, distance - s.radius - t.radius) + 0.25 * distance;
}

// As of a rod from one to the other: its cross section, about the border by how thick the two are, over its length.
double TreeMaker::conductance(Index a, Index b, double border) const {
  const Sphere &s = level_.spheres[a], &t = level_.spheres[b];
  const double flat = 0.01 * (s.center - t.center).norm();  // such parts are thin, not nothing
  return border * (std::sqrt(s.radius * t.radius) + flat) / std::max(gap(a, b), 1e-9);
}

// The edges by how well they conduct, the best first; what has no border by the gaps, the narrowest first. Of an edge
// and its image the one that begins at an orbit's first handle.
std::vector<VertexPair> TreeMaker::closestFirst() const {
  struct Link {
    double conductance = 0, gap = 0;
    VertexPair ends;
  };
  std::vector<Link> links;
  links.reserve(level_.edges.size());
  for (std::size_t e = 0; e < level_.edges.size(); ++e) {
    auto [a, b] = level_.edges[e];
    if (orbitOf(a) == orbitOf(b)) continue;
    if (orbitOf(a) != a) {
      if (orbitOf(b) != b) continue;
      std::swap(a, b);
    }
    const double border = level_.borders.empty() ? 0 : level_.borders[e];
    links.push_back({conductance(a, b, border), gap(a, b), {a, b}});
  }
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::tuple(-a.conductance, a.gap, a.ends) < std::tuple(-b.conductance, b.gap, b.ends);
  });
  std::vector<VertexPair> edges;
  edges.reserve(links.size());
  for (const Link& link : links) edges.push_back(link.ends);
  return edges;
}

// Two trees that both have handles on the plane are joined there: a handle on the plane that was the child of one of a
// pair would have to be the other's child too.
void TreeMaker::joinNeighbors() {
  for (const auto& [a, b] : closestFirst()) {
    if (!sets_.unite(orbitOf(a), orbitOf(b))) continue;
    const Index planeA = onPlaneNear(a), planeB = onPlaneNear(b);
    if (planeA != kNoIndex && planeB != kNoIndex) {
      connect(planeA, planeB);
      continue;
    }
    connect(a, b);
    const bool mirrored = imageOf(a) != a || imageOf(b) != b;
    if (mirrored && !hasLostImage(a) && !hasLostImage(b)) connect(imageOf(a), imageOf(b));
    if (!onPlane(a) && !onPlane(b)) besidePlane_.unite(orbitOf(a), orbitOf(b));
    const Index beside = onPlane(a) ? b : a;
    planeOf_[besidePlane_.find(orbitOf(beside))] = planeA != kNoIndex ? planeA : planeB;
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
    const double c = gap(h, imageOf(h));
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

// How much each handle draws the root towards it: its fraction of the volume, and of all tips of the tree together as
// much as 0.3 of that. By volume alone a large head or abdomen would be the root of all limbs.
std::vector<double> TreeMaker::rootWeights() const {
  constexpr double kTips = 0.3;
  double whole = 0, tips = 0;
  const auto isTip = [&](Index h) { return neighbors_[h].size() == 1; };
  for (Index h = 0; h < neighbors_.size(); ++h) {
    whole += volume(h);
    tips += isTip(h) ? 1 : 0;
  }
  std::vector<double> weights(neighbors_.size());
  for (Index h = 0; h < weights.size(); ++h) weights[h] = volume(h) / whole + (isTip(h) ? kTips / tips : 0);
  return weights;
}

// The weighted median of the tree, by sums over subtrees and one pass down.
Index TreeMaker::findRoot() const {
  std::vector<Index> order, parents;
  spread(0, order, parents);
  const auto length = [&](Index a, Index b) { return (level_.spheres[a].center - level_.spheres[b].center).norm(); };
  std::vector<double> below = rootWeights(), sum(order.size(), 0);
  const double total = std::accumulate(below.begin(), below.end(), 0.0);
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
