#include "limber/rigging/body/inside_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/shortest_paths.h"

namespace limber {

namespace {

constexpr double kMaxSlope = 0.6;  // depth gained for each step: beyond this a position is not in the middle
// Spacings outside the surface over which parts that nearly touch are connected: more where too little else is.
constexpr double kGaps[] = {1.2, 3, 6, 12, 24};
constexpr double kGapCost = 5;        // of a path there, times the spacings outside, against one inside
constexpr double kTogether = 0.9995;  // part of the inside that must be connected

}  // namespace

InsideGraph::InsideGraph(const SignedDistance& distance) : distance_(distance) {
  const auto& size = distance.size();
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        steps_.push_back((static_cast<std::ptrdiff_t>(z) * size[1] + y) * size[0] + x);
        lengths_.push_back(std::sqrt(static_cast<double>(x * x + y * y + z * z)));
      }
    }
  }
}

bool InsideGraph::medial(std::size_t node) const {
  for (std::size_t n = 0; n < steps_.size(); ++n) {
    const double gain = depth(node + steps_[n]) - depth(node);
    if (gain > kMaxSlope * lengths_[n] * distance_.spacing()) return false;
  }
  return true;
}

std::vector<std::size_t> InsideGraph::insideNodes() const {
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < distance_.nodeCount(); ++node) {
    if (inside(node)) nodes.push_back(node);
  }
  return nodes;
}

void InsideGraph::spread(const std::vector<std::size_t>& sources, std::vector<float>& distances,
                         std::vector<std::size_t>& from) const {
  for (const std::size_t node : sources) {
    distances[node] = 0;
    from[node] = node;
  }
  const auto forEachNeighbour = [&](std::size_t node, const auto& visit) {
    for (std::size_t n = 0; n < steps_.size(); ++n) {
      const std::size_t next = node + steps_[n];
      const double value = distance_.value(next);
      if (value > gap_ || !isOpen(next)) continue;
      const double cost = value < 0 ? 1 : kGapCost * std::max(1.0, value / distance_.spacing());
      visit(next, static_cast<float>(lengths_[n] * distance_.spacing() * cost));
    }
  };
  shortenPaths(std::span(sources), distances, forEachNeighbour,
               [&](std::size_t node, std::size_t next) { from[next] = node; });
}

void InsideGraph::spreadToAll(std::size_t source, const std::vector<std::size_t>& inside, std::vector<float>& distances,
                              std::vector<std::size_t>& from) {
  from.assign(distance_.nodeCount(), source);
  for (const double gap : kGaps) {
    gap_ = gap * distance_.spacing();
    distances.assign(distance_.nodeCount(), std::numeric_limits<float>::infinity());
    spread({source}, distances, from);
    const auto reached =
        std::count_if(inside.begin(), inside.end(), [&](std::size_t node) { return std::isfinite(distances[node]); });
    if (static_cast<double>(reached) >= kTogether * static_cast<double>(inside.size())) return;
  }
}

bool InsideGraph::isOpen(std::size_t node) const {
  const auto& size = distance_.size();
  const std::size_t index[3] = {node % size[0], node / size[0] % size[1], node / size[0] / size[1]};
  for (int axis = 0; axis < 3; ++axis) {
    if (index[axis] == 0 || index[axis] + 1 == size[axis]) return false;
  }
  return true;
}

}  // namespace limber
