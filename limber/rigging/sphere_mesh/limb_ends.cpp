#include "limber/rigging/sphere_mesh/limb_ends.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "limber/core/disjoint_sets.h"
#include "limber/core/grouped.h"
#include "limber/core/shortest_paths.h"

namespace limber {

namespace {

constexpr int kFarSpheres = 16;          // that the mean distance is taken to
constexpr double kMinElongation = 1;     // length over thickness; corners of boxes and plates have less
constexpr double kMinThickness = 0.003;  // of the model's longest side: specks and wires are no limbs
constexpr double kForkPart = 0.5;        // of a limb's length: what is shorter and grows from it does not end it
constexpr double kOuterPart = 0.5;       // of a limb's length
constexpr double kMeasuredPart = 0.75;   // of a limb's own length, from its end on: its thickness is taken there

struct Neighbor {
  Index sphere = 0;
  float distance = 0;
};

// Works on all spheres, images too: legs meet their images between them, which a half of the model does not show.
class EndFinder {
 public:
  explicit EndFinder(const SphereGraph& graph) : graph_(graph) {
    for (Index node = 0; node < graph.centers.size(); ++node) addSphere(node, false);
    firstImage_ = static_cast<Index>(nodes_.size());
    imageOf_.assign(firstImage_, kNoIndex);
    for (Index node = 0; node < firstImage_; ++node) {
      if (graph.single[node]) continue;
      imageOf_[node] = static_cast<Index>(nodes_.size());
      addSphere(node, true);
      imageOf_.push_back(node);
    }
    neighbors_ = Grouped<Neighbor>(nodes_.size(), [&](const auto& visit) {
      const auto link = [&](Index a, Index b) {
        const float distance = (centers_[a] - centers_[b]).norm();
        visit(a, Neighbor{b, distance});
        visit(b, Neighbor{a, distance});
      };
      for (const GraphEdge& edge : graph.edges) {
        const Index a = edge.from, b = nodeOf(edge.to);
        const bool crosses = crossesOf(edge.to);
        if (a != b || crosses) link(a, crosses ? imageOf(b) : b);
        if (a != b && (imageOf(a) != a || imageOf(b) != b)) link(imageOf(a), crosses ? b : imageOf(b));
      }
    });
  }

  std::vector<LimbEnd> run() {
    measureHeights();
    findMaxima();
    std::vector<LimbEnd> ends;
    std::vector<std::uint8_t> isOfAnEnd(firstImage_, 0);
    for (const Part& part : parts_) {
      LimbEnd end = endOf(part);
      // Of two images the one that was complete first: the other goes on as part of what they grow from.
      if (!isLimb(end) || isOfAnEnd[end.nodes.front()]) continue;
      for (const Index node : end.nodes) isOfAnEnd[node] = 1;
      ends.push_back(std::move(end));
    }
    std::stable_sort(ends.begin(), ends.end(), [](const LimbEnd& a, const LimbEnd& b) { return a.length > b.length; });
    return ends;
  }

 private:
  // A sphere of a part, and the height from which down it is: its own, or where the part that it was of before ended.
  struct Member {
    Index sphere = 0;
    float joins = 0;
  };
  struct Branch {
    float base = 0;  // height at which it joins
    float length = 0;
  };
  // A maximum with what is around it, down to where that meets the part of a higher one.
  struct Part {
    Index top = 0;
    float base = 0;               // height there
    std::vector<Branch> limbs;    // that join it
    std::vector<Member> spheres;  // without those of other limbs
  };

  void addSphere(Index node, bool isImage) {
    nodes_.push_back(node);
    Vec3f center = graph_.centers[node];
    if (isImage) center.x() = -center.x();
    centers_.push_back(center);
  }
  Index imageOf(Index sphere) const { return imageOf_[sphere] == kNoIndex ? sphere : imageOf_[sphere]; }
  Index count() const { return static_cast<Index>(nodes_.size()); }

  std::vector<float> distancesFrom(Index source) const {
    std::vector<float> distances(count(), std::numeric_limits<float>::infinity());
    distances[source] = 0;
    const auto forEachNeighbor = [&](Index sphere, const auto& visit) {
      for (const Neighbor& next : neighbors_.of(sphere)) visit(next.sphere, next.distance);
    };
    shortenPaths(std::span<const Index>(&source, 1), distances, forEachNeighbor, [](Index, Index) {});
    return distances;
  }

  // From a sphere and from its image, whose sum is the same for two images to the last bit.
  void measureHeights() {
    heights_.assign(count(), 0);
    std::vector<float> nearest(count(), std::numeric_limits<float>::infinity());
    Index source = 0;
    int sources = 0;
    while (sources < kFarSpheres) {
      std::vector<float> distances = distancesFrom(source);
      for (Index sphere = 0; sphere < count(); ++sphere) nearest[sphere] = std::min(nearest[sphere], distances[sphere]);
      ++sources;
      if (imageOf(source) != source) {
        const std::vector<float> others = distancesFrom(imageOf(source));
        for (Index sphere = 0; sphere < count(); ++sphere) {
          nearest[sphere] = std::min(nearest[sphere], others[sphere]);
          distances[sphere] += others[sphere];
        }
        ++sources;
      }
      for (Index sphere = 0; sphere < count(); ++sphere) heights_[sphere] += distances[sphere];
      source = static_cast<Index>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    }
    for (float& height : heights_) height /= static_cast<float>(sources);
  }

  // Spheres come in from the highest down; where two parts meet, the one of the lower maximum is complete.
  void findMaxima() {
    std::vector<Index> order(count());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return heights_[a] > heights_[b]; });
    std::vector<Index> ranks(count());
    for (Index i = 0; i < count(); ++i) ranks[order[i]] = i;
    DisjointSets sets(count());
    std::vector<Index> partOf(count(), kNoIndex);  // per set's first sphere
    std::vector<std::uint8_t> isIn(count(), 0);
    std::vector<Part> open(count());  // by its top
    for (const Index sphere : order) {
      isIn[sphere] = 1;
      Index own = kNoIndex;
      for (const Neighbor& neighbor : neighbors_.of(sphere)) {
        if (!isIn[neighbor.sphere]) continue;
        const Index other = partOf[sets.find(neighbor.sphere)];
        if (own == kNoIndex || own == other) {
          own = other;
          continue;
        }
        const bool isHigher = ranks[open[other].top] < ranks[open[own].top];
        const Index higher = isHigher ? other : own, lower = isHigher ? own : other;
        complete(open[lower], open[higher], heights_[sphere]);
        own = higher;
        sets.unite(open[lower].top, open[higher].top);
        partOf[sets.find(open[higher].top)] = higher;
      }
      if (own == kNoIndex) {
        own = sphere;
        open[own].top = sphere;
      } else {
        sets.unite(sphere, open[own].top);
      }
      open[own].spheres.push_back({sphere, heights_[sphere]});
      partOf[sets.find(sphere)] = own;
    }
    Part& last = open[order.front()];
    last.base = heights_[order.back()];
    parts_.push_back(std::move(last));
  }

  // A limb keeps its outer part; the rest, and what is no limb, is of what it grows from.
  void complete(Part& lower, Part& higher, float height) {
    lower.base = height;
    const bool isOne = isLimb(endOf(lower));
    const float outer = isOne ? outerHeight(lower) : std::numeric_limits<float>::infinity();
    for (const Member& member : lower.spheres) {
      if (member.joins < outer) higher.spheres.push_back({member.sphere, height});
    }
    if (!isOne) return;
    higher.limbs.push_back({height, heights_[lower.top] - height});
    parts_.push_back(std::move(lower));
  }

  static bool isLimb(const LimbEnd& end) {
    return end.thickness > kMinThickness && end.ownLength > kMinElongation * end.thickness;
  }

  // Where the highest limb joins that is not short beside it.
  float ownBase(const Part& part) const {
    float base = part.base;
    for (const Branch& limb : part.limbs) {
      if (limb.length >= kForkPart * (heights_[part.top] - part.base)) base = std::max(base, limb.base);
    }
    return base;
  }
  float outerHeight(const Part& part) const {
    const float top = heights_[part.top];
    return std::max(ownBase(part), top - static_cast<float>(kOuterPart) * (top - part.base));
  }

  LimbEnd endOf(const Part& part) const {
    const float top = heights_[part.top], outer = outerHeight(part);
    LimbEnd end;
    end.length = top - part.base;
    end.ownLength = top - ownBase(part);
    const float measured = top - static_cast<float>(kMeasuredPart * end.ownLength);
    double area = 0;
    std::vector<std::uint8_t> isIn(firstImage_, 0);
    for (const Member& member : part.spheres) {
      const Index node = nodes_[member.sphere];
      if (member.joins >= measured) area += graph_.areas[node];
      if (member.joins < outer) continue;
      if (graph_.single[node] || isIn[node]) end.isOnPlane = true;  // with both of its sides
      if (!isIn[node]) end.nodes.push_back(node);
      isIn[node] = 1;
    }
    end.thickness = end.ownLength > 0 ? area / (std::numbers::pi * kMeasuredPart * end.ownLength) : 0;
    return end;
  }

  const SphereGraph& graph_;
  Index firstImage_ = 0;         // spheres from here on are images
  std::vector<Index> nodes_;     // per sphere: its node
  std::vector<Index> imageOf_;   // per sphere: its image, or kNoIndex
  std::vector<Vec3f> centers_;   // per sphere
  Grouped<Neighbor> neighbors_;  // per sphere
  std::vector<float> heights_;   // per sphere
  std::vector<Part> parts_;
};

}  // namespace

std::vector<LimbEnd> limbEnds(const SphereGraph& graph) {
  return EndFinder(graph).run();
}

}  // namespace limber
