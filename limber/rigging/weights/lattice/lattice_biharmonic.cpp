#include "limber/rigging/weights/lattice/lattice_biharmonic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCore>

#include "limber/geometry/solve/sparse_cholesky.h"

namespace limber {

namespace {

// Conjugate gradients alone need steps by the square of a sheet's width: 9,000 for one of 40 x 40 x 2 from nothing.

constexpr Index kRound = 64;        // steps between looks at how much has changed
constexpr Index kPatience = 4;      // rounds, from which on each begins with the minimum of all that is free
constexpr int kReach = 6;           // edges that a window reaches beyond what may change
constexpr double kNoPull = 1e-5;    // gradients that let no node go from its bound
constexpr int kMaxWindows = 8;      // the last ones add next to nothing
constexpr double kOfLongest = 1.9;  // of 2, from which on a step along the gradient need not descend

using Neighbors = std::array<Index, LatticeGraph::kDirections>;

// Four sums side by side, so that they need not wait for each other; always in the same order.
class Sum {
 public:
  void add(std::size_t i, double value) { parts_[i % 4] += value; }
  double total() const { return (parts_[0] + parts_[1]) + (parts_[2] + parts_[3]); }

 private:
  std::array<double, 4> parts_ = {};
};

// The quadratic problem of the nodes of one window, the others kept as they are.
class WindowProblem {
 public:
  // window  ascending; gradient  of the whole graph; localOf  scratch, #N of kNoIndex, and so again afterwards
  WindowProblem(const LatticeGraph& graph, const std::vector<Index>& window, std::span<const double> w,
                const std::vector<double>& gradient, std::vector<Index>& localOf);

  // Descends until nothing changes much, or there are `most` steps with those before it. Returns how many there are.
  Index descend(double tolerance, Index steps, Index most);
  void write(std::span<double> w) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) w[nodes_[i]] = x_[i];
  }

 private:
  double laplacian(const std::vector<double>& x, std::size_t i) const {
    const Neighbors& n = neighbors_[i];
    return degree_[i] * x[i] - ((x[n[0]] + x[n[1]]) + (x[n[2]] + x[n[3]]) + (x[n[4]] + x[n[5]]));
  }
  double between(std::size_t i) const { return x_[i] > 0 && x_[i] < 1 ? scale_[i] * gradient_[i] : 0; }
  double leaving(std::size_t i) const {
    const double g = scale_[i] * gradient_[i];
    return x_[i] <= 0 ? std::min(g, 0.0) : x_[i] >= 1 ? std::max(g, 0.0) : 0;
  }
  void applyToDirection();
  Eigen::SparseMatrix<double> freeEnergy(const std::vector<Index>& free, const std::vector<Index>& freeOf) const;
  void minimizeFree();
  bool keepIfBelow(const std::vector<double>& x, const std::vector<double>& gradient);
  Index descendRound(Index most);
  void look();
  bool staysWithin(double step) const;
  double longestStep() const;
  void move(double step);
  void moveWithin();
  void expand();
  double changeSince(const std::vector<double>& before) const;

  std::vector<Index> nodes_;
  std::vector<Neighbors> neighbors_;  // of the window's nodes, then of their neighbors outside; local
  std::vector<double> degree_;
  std::vector<double> scale_;         // by node of the window: 1 / diagonal of L L
  std::vector<double> x_, gradient_;  // likewise
  std::vector<double> image_;         // L L direction
  std::vector<double> direction_;     // 0 from the window's nodes on, where the last represents missing neighbors
  std::vector<double> once_;          // L direction, likewise
  double curvature_ = 0, slope_ = 0;  // direction^T L L direction, and its product with the gradient
  double reduced_ = 0, leaving_ = 0;  // squares of the gradient: between the bounds, as far as a fixed step along it
                                      // would stay within them; and of the nodes that leave their bounds
  bool conjugate_ = false;            // whether the direction, and its image, is that of the last step of a descent
  double fixedStep_ = 0;              // of scaled gradients: always descends
};

WindowProblem::WindowProblem(const LatticeGraph& graph, const std::vector<Index>& window, std::span<const double> w,
                             const std::vector<double>& gradient, std::vector<Index>& localOf)
    : nodes_(window) {
  std::vector<Index> all = window;
  for (std::size_t i = 0; i < all.size(); ++i) localOf[all[i]] = static_cast<Index>(i);
  for (const Index node : window) {
    for (const Index next : graph.neighbors[node]) {
      if (next == kNoIndex || localOf[next] != kNoIndex) continue;
      localOf[next] = static_cast<Index>(all.size());
      all.push_back(next);
    }
  }
  const auto none = static_cast<Index>(all.size());
  for (const Index node : all) {
    Neighbors local;
    double degree = 0;
    for (int d = 0; d < LatticeGraph::kDirections; ++d) {
      const Index next = graph.neighbors[node][d];
      local[d] = next == kNoIndex || localOf[next] == kNoIndex ? none : localOf[next];
      degree += next != kNoIndex;
    }
    neighbors_.push_back(local);
    degree_.push_back(degree);
  }
  for (const Index node : all) localOf[node] = kNoIndex;
  double largest = 1;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double diagonal = std::max(1.0, degree_[i] * degree_[i] + degree_[i]);
    scale_.push_back(1 / diagonal);
    x_.push_back(w[nodes_[i]]);
    gradient_.push_back(gradient[nodes_[i]]);
    // Gershgorin's bound of L L by its rows, divided by the diagonal.
    double row = 2 * degree_[i] * degree_[i];
    for (const Index next : neighbors_[i]) row += next == none ? 0 : 2 * degree_[next];
    largest = std::max(largest, row / diagonal);
  }
  fixedStep_ = kOfLongest / largest;
  direction_.assign(all.size() + 1, 0);
  once_.assign(all.size() + 1, 0);
  image_.resize(nodes_.size());
}

void WindowProblem::applyToDirection() {
  for (std::size_t i = 0; i < neighbors_.size(); ++i) once_[i] = laplacian(direction_, i);
  Sum curvature, slope;
  for (std::size_t i = 0; i < image_.size(); ++i) {
    image_[i] = laplacian(once_, i);
    curvature.add(i, direction_[i] * image_[i]);
    slope.add(i, direction_[i] * gradient_[i]);
  }
  curvature_ = curvature.total();
  slope_ = slope.total();
}

void WindowProblem::look() {
  Sum reduced, leavingSum;
  const double perStep = 1 / fixedStep_;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double free = between(i), away = leaving(i);
    reduced.add(i, gradient_[i] * std::clamp(free, (x_[i] - 1) * perStep, x_[i] * perStep));
    leavingSum.add(i, gradient_[i] * away);
  }
  reduced_ = reduced.total();
  leaving_ = leavingSum.total();
}

bool WindowProblem::staysWithin(double step) const {
  double low = 0, high = 1;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double moved = x_[i] - step * direction_[i];
    low = std::min(low, moved);
    high = std::max(high, moved);
  }
  return low >= 0 && high <= 1;
}

// How far against the direction all values stay within bounds.
double WindowProblem::longestStep() const {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (direction_[i] == 0) continue;
    step = std::min(step, (x_[i] - (direction_[i] > 0 ? 0 : 1)) / direction_[i]);
  }
  return step;
}

void WindowProblem::move(double step) {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = std::clamp(x_[i] - step * direction_[i], 0.0, 1.0);
    gradient_[i] -= step * image_[i];
  }
}

// Against the direction, each value as far as it stays within bounds.
void WindowProblem::moveWithin() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double moved = std::clamp(x_[i] - direction_[i], 0.0, 1.0);
    direction_[i] = x_[i] - moved;
    x_[i] = moved;
  }
  applyToDirection();
  for (std::size_t i = 0; i < x_.size(); ++i) gradient_[i] -= image_[i];
}

// A step of fixed length along the projected gradient of the nodes between the bounds.
void WindowProblem::expand() {
  for (std::size_t i = 0; i < x_.size(); ++i) direction_[i] = fixedStep_ * between(i);
  moveWithin();
}

// The lower triangle of L L between some nodes.
//   freeOf  by node of the window and its neighbors, and one more: which of `free` it is, kNoIndex where it is none
Eigen::SparseMatrix<double> WindowProblem::freeEnergy(const std::vector<Index>& free,
                                                      const std::vector<Index>& freeOf) const {
  const auto count = static_cast<int>(free.size());
  Eigen::SparseMatrix<double> lower(count, count);
  lower.reserve(free.size() * 13);  // of 25 entries a row
  std::vector<double> sums(free.size());
  std::vector<int> lastColumn(free.size(), -1);
  std::vector<Index> rows;
  for (int column = 0; column < count; ++column) {
    const Index node = free[column];
    const auto add = [&](Index to, double entry) {
      const Index row = freeOf[to];
      if (row == kNoIndex || row < static_cast<Index>(column)) return;
      if (lastColumn[row] != column) {
        lastColumn[row] = column;
        rows.push_back(row);
        sums[row] = 0;
      }
      sums[row] += entry;
    };
    const auto addColumn = [&](Index of, double factor) {
      add(of, factor * degree_[of]);
      for (const Index next : neighbors_[of]) add(next, -factor);
    };
    rows.clear();
    addColumn(node, degree_[node]);
    for (const Index next : neighbors_[node]) {
      if (next < neighbors_.size()) addColumn(next, -1);
    }
    std::sort(rows.begin(), rows.end());
    lower.startVec(column);
    for (const Index row : rows) lower.insertBack(static_cast<int>(row), column) = sums[row];
  }
  lower.finalize();
  return lower;
}

// Moves all free values to their minimum if no bound is met before that, and back within bounds.
void WindowProblem::minimizeFree() {
  std::vector<Index> free, freeOf(direction_.size(), kNoIndex);
  for (Index i = 0; i < x_.size(); ++i) {
    if (x_[i] <= 0 ? gradient_[i] > -kNoPull : x_[i] >= 1 && gradient_[i] < kNoPull) continue;
    freeOf[i] = static_cast<Index>(free.size());
    free.push_back(i);
  }
  if (free.empty()) return;
  const Eigen::SparseMatrix<double> energy = freeEnergy(free, freeOf);
  SparseCholesky cholesky(energy);
  cholesky.factorize(energy);
  std::vector<double> solution(free.size() * SparseCholesky::kColumns, 0);
  const auto at = [&](Index i) -> double& {
    return solution[cholesky.rowOf(i) * std::size_t{SparseCholesky::kColumns}];
  };
  for (Index i = 0; i < free.size(); ++i) at(i) = gradient_[free[i]];
  cholesky.solve(solution.data(), 1);
  std::fill(direction_.begin(), direction_.end(), 0.0);
  for (Index i = 0; i < free.size(); ++i) direction_[free[i]] = at(i);
  moveWithin();
  conjugate_ = false;
}

// Goes back to other values, whose gradient is given, unless these have less energy.
bool WindowProblem::keepIfBelow(const std::vector<double>& x, const std::vector<double>& gradient) {
  Sum difference;
  for (std::size_t i = 0; i < x_.size(); ++i) difference.add(i, (x_[i] - x[i]) * (gradient_[i] + gradient[i]));
  if (difference.total() < 0) return true;
  x_ = x;
  gradient_ = gradient;
  conjugate_ = false;
  return false;
}

double WindowProblem::changeSince(const std::vector<double>& before) const {
  double most = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) most = std::max(most, std::abs(x_[i] - before[i]));
  return most;
}

// Up to `most` steps of MPRGP, fewer where there is nothing left to do. Returns how many.
Index WindowProblem::descendRound(Index most) {
  look();
  for (Index step = 0; step < most; ++step) {
    if (!(reduced_ + leaving_ > 0)) return step;
    const bool release = leaving_ > reduced_;
    double back = 0;
    if (conjugate_ && !release) {
      Sum along;
      for (std::size_t i = 0; i < x_.size(); ++i) along.add(i, between(i) * image_[i]);
      back = along.total() / curvature_;
    }
    for (std::size_t i = 0; i < x_.size(); ++i) {
      direction_[i] = release ? leaving(i) : between(i) - back * direction_[i];
    }
    applyToDirection();
    if (!(curvature_ > 0)) return step;
    const double wanted = slope_ / curvature_;
    conjugate_ = !release && staysWithin(wanted);
    if (conjugate_ || (release && staysWithin(wanted))) {
      move(wanted);
    } else {
      move(std::min(wanted, longestStep()));
      expand();
    }
    look();
  }
  return most;
}

Index WindowProblem::descend(double tolerance, Index steps, Index most) {
  std::vector<double> before, gradientBefore;
  bool leaps = true;  // unless the last leap led nowhere
  while (steps < most) {
    before = x_;
    gradientBefore = gradient_;
    const bool leap = leaps && steps >= kPatience * kRound;
    if (leap) minimizeFree();
    const Index round = std::min(kRound, most - steps), taken = descendRound(round);
    steps += taken;
    if (taken < round || changeSince(before) < tolerance) return steps;
    leaps = !leap || keepIfBelow(before, gradientBefore);
  }
  return most;
}

// Half the energy's gradient, L L w, of all nodes.
void gradientOf(const LatticeGraph& graph, std::span<const double> w, std::vector<double>& scratch,
                std::vector<double>& gradient) {
  const auto apply = [&](const auto& from, std::vector<double>& to) {
    for (Index i = 0; i < graph.nodeCount(); ++i) {
      double sum = 0;
      for (const Index next : graph.neighbors[i]) sum += next == kNoIndex ? 0 : from[i] - from[next];
      to[i] = sum;
    }
  };
  apply(w, scratch);
  apply(scratch, gradient);
}

// Nodes that may change.
std::vector<Index> pulledNodes(const LatticeGraph& graph, const std::vector<bool>& pinned, std::span<const double> w,
                               const std::vector<double>& gradient) {
  std::vector<Index> pulled;
  for (Index i = 0; i < graph.nodeCount(); ++i) {
    if (pinned[i] || (w[i] <= 0 ? gradient[i] > -kNoPull : w[i] >= 1 && gradient[i] < kNoPull)) continue;
    pulled.push_back(i);
  }
  return pulled;
}

// Those nodes and all within a few edges, ascending; marks them.
std::vector<Index> widened(const LatticeGraph& graph, const std::vector<bool>& pinned, std::vector<Index> nodes,
                           std::vector<char>& inside) {
  std::fill(inside.begin(), inside.end(), 0);
  for (const Index node : nodes) inside[node] = 1;
  std::size_t from = 0;
  for (int ring = 0; ring < kReach; ++ring) {
    const std::size_t to = nodes.size();
    for (; from < to; ++from) {
      for (const Index next : graph.neighbors[nodes[from]]) {
        if (next == kNoIndex || pinned[next] || inside[next]) continue;
        inside[next] = 1;
        nodes.push_back(next);
      }
    }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

Index minimizeBoundedBiharmonic(const LatticeGraph& graph, const std::vector<bool>& pinned, std::span<double> w,
                                const BiharmonicOptions& options) {
  std::vector<double> scratch(graph.nodeCount()), gradient(graph.nodeCount());
  std::vector<char> inWindow(graph.nodeCount(), 0);
  std::vector<Index> localOf(graph.nodeCount(), kNoIndex);
  Index steps = 0;
  for (int round = 0; round < kMaxWindows && steps < options.maxIterations; ++round) {
    gradientOf(graph, w, scratch, gradient);
    const std::vector<Index> pulled = pulledNodes(graph, pinned, w, gradient);
    const bool isNew = std::any_of(pulled.begin(), pulled.end(), [&](Index node) { return !inWindow[node]; });
    if (!isNew) break;
    const std::vector<Index> window = widened(graph, pinned, pulled, inWindow);
    WindowProblem problem(graph, window, w, gradient, localOf);
    steps = problem.descend(options.tolerance, steps, options.maxIterations);
    problem.write(w);
  }
  return steps;
}

}  // namespace limber
