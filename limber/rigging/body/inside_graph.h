// Shortest paths through the inside of a model.
#pragma once

#include <cstddef>
#include <vector>

#include "limber/geometry/mesh/signed_distance.h"

namespace limber {

// A grid as a graph of the nodes that are inside, or all but inside. The distance must outlive it.
class InsideGraph {
 public:
  explicit InsideGraph(const SignedDistance& distance);

  // The model keeps a margin to the grid's border, but the winding number of faces that lie on each other many times is
  // large out there, too.
  bool inside(std::size_t node) const { return distance_.value(node) < 0 && isOpen(node); }
  double depth(std::size_t node) const { return -distance_.value(node); }
  // Whether no neighbor is much deeper.
  bool medial(std::size_t node) const;

  // All nodes that are inside.
  std::vector<std::size_t> insideNodes() const;

  // Lowers `distances` (#nodes) to those from `sources`, and records in `from` (#nodes) the previous node of each path.
  void spread(const std::vector<std::size_t>& sources, std::vector<float>& distances,
              std::vector<std::size_t>& from) const;
  // The same from one source, with `distances` and `from` reset: gaps are allowed as wide as it takes to connect all
  // but a few of the inside nodes, for this and later calls.
  void spreadToAll(std::size_t source, const std::vector<std::size_t>& inside, std::vector<float>& distances,
                   std::vector<std::size_t>& from);

 private:
  bool isOpen(std::size_t node) const;

  const SignedDistance& distance_;
  std::vector<std::ptrdiff_t> steps_;  // to the 26 nodes round one
  std::vector<double> lengths_;        // of the steps, in spacings
  double gap_ = 0;
};

}  // namespace limber
