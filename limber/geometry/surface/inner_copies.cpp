// Figures for 19 people of 1 to 81 components, most of them open, with a copy 1 % of the height within: joints off by
// up to (% of the height) / people within 0.5 %.
// - components each within one other, by its winding number: 22 / 6. That of an open component says little near its
//   openings, and small ones are not thicker than the copy is deep.
// - all components within the solid of all, by their common winding number: 19 / 9. Thin parts' copies come out of it,
//   and eyes, teeth and bodies under clothes lie in it.
// - pairs by shape alone, the nearest distances between them: 3.9 / 14.
// - pairs by the same triangles first (this file): 0 / 19.
#include "limber/geometry/surface/inner_copies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "limber/geometry/mesh/bvh.h"

namespace limber {

namespace {

constexpr std::size_t kMaxComponents = 1000;  // the largest
constexpr std::size_t kPairSamples = 50;      // triangles of a component
constexpr std::size_t kMaxTries = 8;          // pairs by shape that are looked at for one component
constexpr double kMaxDistance = 0.03;         // of the figure's size, of a copy from the surface
constexpr double kMinPaired = 0.8;            // of the surface's area
constexpr double kMinDiagonal = 2;            // of a component's box, in largest distances of a copy, to be evidence
constexpr double kMinAreaRatio = 0.25;        // of two components that are a pair by their shape
constexpr double kSameOrder = 0.9;            // of what tells outer from inner, for all to be in the same order

// Two components that may be a pair. Likelier ones are less.
struct Candidate {
  std::size_t a = 0, b = 0;
  int kind = 0;  // 0: the same triangles, 1: as many, 2: others
  double cost = 0;

  bool operator<(const Candidate& other) const { return std::pair(kind, cost) < std::pair(other.kind, other.cost); }
};

class Copies {
 public:
  Copies(const TriMesh& mesh, std::span<const SurfaceComponent> components)
      : mesh_(mesh), components_(components.first(std::min(kMaxComponents, components.size()))) {
    Box whole;
    for (const SurfaceComponent& component : components) {
      whole.add(component.box.min);
      whole.add(component.box.max);
      area_ += component.area;
    }
    size_ = whole.longestSide();
    maxDistance_ = kMaxDistance * size_;
    trees_.resize(components_.size());
  }

  std::vector<InnerCopy> find() {
    std::vector<Candidate> candidates = candidatesByBoxes();
    if (!isMax(candidates)) return {};
    rateSameTriangles(candidates);
    const std::vector<Candidate> pairs = bestPairs(candidates);
    if (!isMax(pairs)) return {};
    return withOuterFirst(pairs);
  }

 private:
  std::vector<Candidate> candidatesByBoxes() const {
    std::vector<Candidate> candidates;
    for (std::size_t b = 1; b < components_.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        const SurfaceComponent &first = components_[a], &second = components_[b];
        if ((first.box.min - second.box.min).cwiseAbs().maxCoeff() > maxDistance_) continue;
        if ((first.box.max - second.box.max).cwiseAbs().maxCoeff() > maxDistance_) continue;
        const bool areAsMany =
            first.vertices.size() == second.vertices.size() && first.triangles.size() == second.triangles.size();
        const double least = std::min(first.area, second.area), most = std::max(first.area, second.area);
        if (!areAsMany && least < kMinAreaRatio * most) continue;
        const int kind = !areAsMany ? 2 : haveSameTriangles(first, second) ? 0 : 1;
        candidates.push_back({a, b, kind, (first.box.center() - second.box.center()).norm()});
      }
    }
    return candidates;
  }

  // Whether the triangles join the same vertices, counted within each component.
  bool haveSameTriangles(const SurfaceComponent& a, const SurfaceComponent& b) const {
    const auto corners = [&](const SurfaceComponent& component, std::size_t i) {
      std::array<std::ptrdiff_t, 3> ranks{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = mesh_.triangles[component.triangles[i]][k];
        ranks[k] =
            std::lower_bound(component.vertices.begin(), component.vertices.end(), v) - component.vertices.begin();
      }
      std::sort(ranks.begin(), ranks.end());
      return ranks;
    };
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
      if (corners(a, i) != corners(b, i)) return false;
    }
    return true;
  }

  // Whether the components in any of the pairs are nearly all of the surface. Small ones, as leaves, have others of the
  // same shape near them without being copies.
  bool isMax(const std::vector<Candidate>& pairs) const {
    std::vector<bool> isIn(components_.size(), false);
    for (const Candidate& pair : pairs) isIn[pair.a] = isIn[pair.b] = true;
    double area = 0;
    for (std::size_t i = 0; i < isIn.size(); ++i) {
      if (isIn[i] && components_[i].box.diagonal() > kMinDiagonal * maxDistance_) area += components_[i].area;
    }
    return area >= kMinPaired * area_;
  }

  double moved(const Candidate& pair, std::size_t k) const {
    return (mesh_.position(components_[pair.a].vertices[k]) - mesh_.position(components_[pair.b].vertices[k])).norm();
  }

  // Of pairs of the same triangles those are likelier whose vertices are moved as far as most of the surface is.
  void rateSameTriangles(std::vector<Candidate>& candidates) const {
    std::vector<std::pair<double, double>> least(components_.size(), {size_, 0});  // distance, area
    for (Candidate& pair : candidates) {
      if (pair.kind != 0) continue;
      const std::size_t count = components_[pair.a].vertices.size();
      double sum = 0;
      for (std::size_t k = 0; k < count; ++k) sum += moved(pair, k);
      pair.cost = sum / static_cast<double>(count);
      for (const std::size_t i : {pair.a, pair.b}) least[i] = std::min(least[i], {pair.cost, components_[i].area});
    }
    const double usual = medianOf(least);
    for (Candidate& pair : candidates) {
      if (pair.kind != 0) continue;
      if (pair.cost > maxDistance_) {
        pair.kind = 1;
        continue;
      }
      const std::size_t count = components_[pair.a].vertices.size();
      double sum = 0;
      for (std::size_t k = 0; k < count; ++k) sum += std::abs(moved(pair, k) - usual);
      pair.cost = sum / static_cast<double>(count);
    }
  }

  // The first of each pair up to which a half of the second ones are.
  static double medianOf(std::vector<std::pair<double, double>> weighted) {
    std::sort(weighted.begin(), weighted.end());
    double all = 0, sum = 0;
    for (const auto& [value, weight] : weighted) all += weight;
    for (const auto& [value, weight] : weighted) {
      sum += weight;
      if (sum >= 0.5 * all) return value;
    }
    return 0;
  }

  std::vector<Candidate> bestPairs(std::vector<Candidate>& candidates) {
    std::stable_sort(candidates.begin(), candidates.end());
    std::vector<bool> isTaken(components_.size(), false);
    std::vector<std::size_t> tries(components_.size(), 0);
    std::vector<Candidate> pairs;
    for (const Candidate& pair : candidates) {
      if (isTaken[pair.a] || isTaken[pair.b]) continue;
      if (pair.kind != 0) {
        if (tries[pair.a]++ >= kMaxTries || tries[pair.b]++ >= kMaxTries) continue;
        if (distance(pair.a, pair.b) > maxDistance_ || distance(pair.b, pair.a) > maxDistance_) continue;
      }
      isTaken[pair.a] = isTaken[pair.b] = true;
      pairs.push_back(pair);
    }
    return pairs;
  }

  // Of one component from another one, in the mean.
  double distance(std::size_t from, std::size_t to) {
    if (!trees_[to]) trees_[to] = std::make_unique<Bvh>(mesh_, components_[to].triangles);
    double area = 0, sum = 0;
    for (const AreaSample& sample : areaSamplesOf(mesh_, components_[from], kPairSamples)) {
      area += sample.area;
      sum += sample.area * trees_[to]->nearestPoint(sample.position).distance;
    }
    return area > 0 ? sum / area : 0;
  }

  std::vector<InnerCopy> withOuterFirst(const std::vector<Candidate>& pairs) const {
    const Bvh all(mesh_);
    std::vector<double> leads;  // how much more of the first than of the second one is seen from the outside
    double storedFirst = 0, storedLast = 0;
    const auto isStoredFirst = [&](const Candidate& pair) {
      return components_[pair.a].vertices.front() < components_[pair.b].vertices.front();
    };
    for (const Candidate& pair : pairs) {
      leads.push_back(exposure(all, components_[pair.a]) - exposure(all, components_[pair.b]));
      const bool isOuterFirst = (leads.back() > 0) == isStoredFirst(pair);
      (isOuterFirst ? storedFirst : storedLast) += std::abs(leads.back()) * components_[pair.a].area;
    }
    const bool hasOrder = std::max(storedFirst, storedLast) > kSameOrder * (storedFirst + storedLast);
    std::vector<InnerCopy> copies;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool isOuter = hasOrder ? isStoredFirst(pairs[i]) == (storedFirst > storedLast) : leads[i] >= 0;
      const auto& [a, b, kind, cost] = pairs[i];
      copies.push_back({isOuter ? a : b, isOuter ? b : a, kind == 0});
    }
    return copies;
  }

  // How many of the rays from a component leave the model.
  double exposure(const Bvh& all, const SurfaceComponent& component) const {
    double area = 0, free = 0;
    for (const AreaSample& sample : areaSamplesOf(mesh_, component, kPairSamples)) {
      for (int ray = 0; ray < 27; ++ray) {
        if (ray == 13) continue;
        const Vec3 toward(ray % 3 - 0.987, ray / 3 % 3 - 0.993, ray / 9 - 1.011);  // along no axis
        area += sample.area;
        if (!all.segmentBlocked(sample.position, sample.position + 4 * size_ * toward, 1e-5 * size_)) {
          free += sample.area;
        }
      }
    }
    return area > 0 ? free / area : 0;
  }

  const TriMesh& mesh_;
  std::span<const SurfaceComponent> components_;
  double area_ = 0, size_ = 0, maxDistance_ = 0;
  std::vector<std::unique_ptr<Bvh>> trees_;
};

}  // namespace

std::vector<InnerCopy> innerCopies(const TriMesh& mesh, std::span<const SurfaceComponent> components) {
  return components.size() < 2 ? std::vector<InnerCopy>() : Copies(mesh, components).find();
}

}  // namespace limber
