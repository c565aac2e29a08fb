// Ways through the inside of a model.
#pragma once

#include <cstddef>
#include <utility>
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

  // Nodes that are taken for outside from now on, and that no way crosses; #nodes.
  void block(std::vector<bool> nodes) { blocked_ = std::move(nodes); }
  // All nodes that are inside.
  std::vector<std::size_t> insideNodes() const;
  // The 26 round an inside node, as steps to them.
  const std::vector<std::ptrdiff_t>& steps() const { return steps_; }

  // Lowers `way` (#nodes) to the shortest way from `sources`, and remembers whence in `from` (#nodes).
  void spread(const std::vector<std::size_t>& sources, std::vector<float>& distances,
              std::vector<std::size_t>& from) const;
  // The same from one source, with `way` and `from` begun anew: gaps are allowed as wide as it takes for all but a few
  // of the inside nodes to hang together, for this and what follows.
  void spreadToAll(std::size_t source, const std::vector<std::size_t>& inside, std::vector<float>& distances,
                   std::vector<std::size_t>& from);

 private:
  bool isOpen(std::size_t node) const;

  const SignedDistance& distance_;
  std::vector<std::ptrdiff_t> steps_;
  std::vector<double> lengths_;  // of the steps, in spacings
  std::vector<bool> blocked_;    // none: all are open
  double gap_ = 0;
};

}  // namespace limber
