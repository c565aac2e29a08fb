#include "limber/skinning/lattice_biharmonic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber {

namespace {

constexpr Index kRound = 64;        // steps between looks at how much has changed
constexpr int kReach = 6;           // edges that a window reaches beyond what may change
constexpr double kNoPull = 1e-5;    // gradients that let no node go from its bound
constexpr int kMostWindows = 8;     // the last ones add next to nothing
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

  // Descends until nothing changes much. Returns the steps taken.
  Index descend(double tolerance, Index most);
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
  void look();
  bool staysWithin(double step) const;
  double longestStep() const;
  void move(double step);
  void expand();
  double changeSince(const std::vector<double>& before) const;

  std::vector<Index> nodes_;
  std::vector<Neighbors> neighbors_;  // of the window's nodes, then of their neighbors outside; local
  std::vector<double> degree_;
  std::vector<double> scale_;         // by node of the window: 1 / diagonal of L L
  std::vector<double> x_, gradient_;  // likewise
  std::vector<double> image_;         // L L direction
  std::vector<double> direction_;     // 0 from the window's nodes on, where the last stands for missing neighbors
  std::vector<double> once_;          // L direction, likewise
  double curvature_ = 0, slope_ = 0;  // direction^T L L direction, and its product with the gradient
  double reduced_ = 0, leaving_ = 0;  // squares of the gradient: between the bounds, as far as a fixed step along it
                                      // would stay within them; and of the nodes that leave their bounds
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

// A step of fixed length along the projected gradient of the nodes between the bounds.
void WindowProblem::expand() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double moved = std::clamp(x_[i] - fixedStep_ * between(i), 0.0, 1.0);
    direction_[i] = x_[i] - moved;
    x_[i] = moved;
  }
  applyToDirection();
  for (std::size_t i = 0; i < x_.size(); ++i) gradient_[i] -= image_[i];
}

double WindowProblem::changeSince(const std::vector<double>& before) const {
  double most = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) most = std::max(most, std::abs(x_[i] - before[i]));
  return most;
}

Index WindowProblem::descend(double tolerance, Index most) {
  std::vector<double> before = x_;
  bool conjugate = false;  // whether the direction, and its image, is the last step's
  look();
  for (Index step = 0; step < most; ++step) {
    if (step > 0 && step % kRound == 0) {
      if (changeSince(before) < tolerance) return step;
      before = x_;
    }
    if (!(reduced_ + leaving_ > 0)) return step;
    const bool release = leaving_ > reduced_;
    double back = 0;
    if (conjugate && !release) {
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
    conjugate = !release && staysWithin(wanted);
    if (conjugate || (release && staysWithin(wanted))) {
      move(wanted);
    } else {
      move(std::min(wanted, longestStep()));
      expand();
    }
    look();
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
std::vector<Index> pulledNodes(const LatticeGraph& graph, const std::vector<bool>& held, std::span<const double> w,
                               const std::vector<double>& gradient) {
  std::vector<Index> pulled;
  for (Index i = 0; i < graph.nodeCount(); ++i) {
    if (held[i] || (w[i] <= 0 ? gradient[i] > -kNoPull : w[i] >= 1 && gradient[i] < kNoPull)) continue;
    pulled.push_back(i);
  }
  return pulled;
}

// Those nodes and all within a few edges, ascending; marks them.
std::vector<Index> widened(const LatticeGraph& graph, const std::vector<bool>& held, std::vector<Index> nodes,
                           std::vector<char>& inside) {
  std::fill(inside.begin(), inside.end(), 0);
  for (const Index node : nodes) inside[node] = 1;
  std::size_t from = 0;
  for (int ring = 0; ring < kReach; ++ring) {
    const std::size_t to = nodes.size();
    for (; from < to; ++from) {
      for (const Index next : graph.neighbors[nodes[from]]) {
        if (next == kNoIndex || held[next] || inside[next]) continue;
        inside[next] = 1;
        nodes.push_back(next);
      }
    }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

Index minimizeBoundedBiharmonic(const LatticeGraph& graph, const std::vector<bool>& held, std::span<double> w,
                                const BiharmonicOptions& options) {
  std::vector<double> scratch(graph.nodeCount()), gradient(graph.nodeCount());
  std::vector<char> inWindow(graph.nodeCount(), 0);
  std::vector<Index> localOf(graph.nodeCount(), kNoIndex);
  Index steps = 0;
  for (int round = 0; round < kMostWindows && steps < options.mostIterations; ++round) {
    gradientOf(graph, w, scratch, gradient);
    const std::vector<Index> pulled = pulledNodes(graph, held, w, gradient);
    const bool isNew = std::any_of(pulled.begin(), pulled.end(), [&](Index node) { return !inWindow[node]; });
    if (!isNew) break;
    const std::vector<Index> window = widened(graph, held, pulled, inWindow);
    WindowProblem problem(graph, window, w, gradient, localOf);
    steps += problem.descend(options.tolerance, options.mostIterations - steps);
    problem.write(w);
  }
  return steps;
}

}  // namespace limber
