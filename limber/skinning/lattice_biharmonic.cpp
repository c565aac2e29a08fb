#include "limber/skinning/lattice_biharmonic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber {

namespace {

constexpr Index kRound = 32;      // steps between looks at how much has changed
constexpr Index kWindow = 512;    // steps between looks at where there is something to change
constexpr int kReach = 4;         // edges that a window reaches beyond what may change
constexpr double kNoPull = 1e-7;  // gradients that let no node go from its bound

using Neighbors = std::array<Index, LatticeGraph::kDirections>;

// L x, where the last entry of x is the 0 that missing neighbors stand for.
void applyLaplacian(const std::vector<Neighbors>& neighbors, const std::vector<double>& degree, const double* x,
                    std::size_t rows, double* result) {
  for (std::size_t i = 0; i < rows; ++i) {
    const Neighbors& n = neighbors[i];
    result[i] = degree[i] * x[i] - ((x[n[0]] + x[n[1]]) + (x[n[2]] + x[n[3]]) + (x[n[4]] + x[n[5]]));
  }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// The quadratic problem of the nodes of one window, the others kept as they are, in values scaled by the diagonal.
class WindowProblem {
 public:
  // window  ascending; gradient  of the whole graph
  WindowProblem(const LatticeGraph& graph, const std::vector<Index>& window, std::span<const double> w,
                const std::vector<double>& gradient, std::vector<Index>& localOf);

  // Descends until nothing changes much. Returns the steps taken.
  Index descend(double tolerance, Index most);
  void write(std::span<double> w) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) w[nodes_[i]] = std::clamp(x_[i] * scale_[i], 0.0, 1.0);
  }

 private:
  std::size_t size() const { return nodes_.size(); }
  void apply(const std::vector<double>& x, std::vector<double>& result);
  void splitGradient();
  double longestStep(const std::vector<double>& direction) const;
  void move(double step, const std::vector<double>& direction);
  void expand();
  double changeSince(const std::vector<double>& before) const;

  std::vector<Index> nodes_;
  std::vector<Neighbors> neighbors_;  // of the window's nodes, then of their neighbors outside; local
  std::vector<double> degree_;
  std::vector<double> scale_, upper_;  // by node of the window: a value is x * scale, x in [0, upper]
  std::vector<double> x_, gradient_;
  std::vector<double> free_, chopped_;  // parts of the gradient: of nodes between bounds, and of those that leave them
  std::vector<double> direction_, image_;
  std::vector<double> padded_, laplacian_;  // scratch of apply()
  double fixedStep_ = 0;                    // a step of projected gradients that always descends
};

WindowProblem::WindowProblem(const LatticeGraph& graph, const std::vector<Index>& window, std::span<const double> w,
                             const std::vector<double>& gradient, std::vector<Index>& localOf)
    : nodes_(window) {
  std::vector<Index> all = window;
  for (std::size_t i = 0; i < all.size(); ++i) localOf[all[i]] = static_cast<Index>(i);
  for (std::size_t i = 0; i < window.size(); ++i) {
    for (const Index next : graph.neighbors[window[i]]) {
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
  for (std::size_t i = 0; i < size(); ++i) {
    const double diagonal = std::max(1.0, degree_[i] * degree_[i] + degree_[i]);
    scale_.push_back(1 / std::sqrt(diagonal));
    upper_.push_back(std::sqrt(diagonal));
    x_.push_back(w[nodes_[i]] * upper_[i]);
    gradient_.push_back(gradient[nodes_[i]] * scale_[i]);
    // Gershgorin's bound of L L by its rows, divided by the diagonal.
    double row = 2 * degree_[i] * degree_[i];
    for (const Index next : neighbors_[i]) row += next == none ? 0 : 2 * degree_[next];
    largest = std::max(largest, row / diagonal);
  }
  fixedStep_ = 1.9 / largest;
  padded_.assign(all.size() + 1, 0);
  laplacian_.assign(all.size() + 1, 0);
  image_.resize(size());
  direction_.resize(size());
  free_.resize(size());
  chopped_.resize(size());
}

void WindowProblem::apply(const std::vector<double>& x, std::vector<double>& result) {
  for (std::size_t i = 0; i < size(); ++i) padded_[i] = x[i] * scale_[i];
  applyLaplacian(neighbors_, degree_, padded_.data(), neighbors_.size(), laplacian_.data());
  applyLaplacian(neighbors_, degree_, laplacian_.data(), size(), result.data());
  for (std::size_t i = 0; i < size(); ++i) result[i] *= scale_[i];
}

void WindowProblem::splitGradient() {
  for (std::size_t i = 0; i < size(); ++i) {
    const double g = gradient_[i];
    const bool low = x_[i] <= 0, high = x_[i] >= upper_[i];
    free_[i] = low || high ? 0 : g;
    chopped_[i] = low ? std::min(g, 0.0) : high ? std::max(g, 0.0) : 0;
  }
}

// How far against a direction all values stay within bounds.
double WindowProblem::longestStep(const std::vector<double>& direction) const {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i) {
    if (direction[i] > 0) {
      step = std::min(step, x_[i] / direction[i]);
    } else if (direction[i] < 0) {
      step = std::min(step, (x_[i] - upper_[i]) / direction[i]);
    }
  }
  return step;
}

void WindowProblem::move(double step, const std::vector<double>& direction) {
  for (std::size_t i = 0; i < size(); ++i) {
    x_[i] = std::clamp(x_[i] - step * direction[i], 0.0, upper_[i]);
    gradient_[i] -= step * image_[i];
  }
}

// A step of fixed length along the projected gradient of the nodes between the bounds.
void WindowProblem::expand() {
  splitGradient();
  for (std::size_t i = 0; i < size(); ++i) {
    const double moved = std::clamp(x_[i] - fixedStep_ * free_[i], 0.0, upper_[i]);
    direction_[i] = moved - x_[i];
    x_[i] = moved;
  }
  apply(direction_, image_);
  for (std::size_t i = 0; i < size(); ++i) gradient_[i] += image_[i];
  splitGradient();
  direction_ = free_;
}

double WindowProblem::changeSince(const std::vector<double>& before) const {
  double most = 0;
  for (std::size_t i = 0; i < size(); ++i) most = std::max(most, std::abs(x_[i] - before[i]) * scale_[i]);
  return most;
}

Index WindowProblem::descend(double tolerance, Index most) {
  splitGradient();
  direction_ = free_;
  std::vector<double> before = x_;
  for (Index step = 0; step < most; ++step) {
    if (step > 0 && step % kRound == 0) {
      if (changeSince(before) < tolerance) return step;
      before = x_;
    }
    double reduced = 0;  // the free gradient, as far as a fixed step along it would stay within bounds
    for (std::size_t i = 0; i < size(); ++i) {
      const double g = free_[i];
      reduced += g * (g > 0 ? std::min(x_[i] / fixedStep_, g) : std::max((x_[i] - upper_[i]) / fixedStep_, g));
    }
    const double leaving = dot(chopped_, chopped_);
    if (!(reduced + leaving > 0)) return step;
    if (leaving > reduced) direction_ = chopped_;
    apply(direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > 0)) return step;
    const double wanted = dot(gradient_, direction_) / curvature, allowed = longestStep(direction_);
    if (wanted > allowed) {
      move(allowed, direction_);
      expand();
      continue;
    }
    move(wanted, direction_);
    splitGradient();
    if (leaving > reduced) {
      direction_ = free_;
      continue;
    }
    const double back = dot(free_, image_) / curvature;
    for (std::size_t i = 0; i < size(); ++i) direction_[i] = free_[i] - back * direction_[i];
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

// Nodes that may change, and those within a few edges of them; ascending.
std::vector<Index> windowOf(const LatticeGraph& graph, const std::vector<bool>& held, std::span<const double> w,
                            const std::vector<double>& gradient) {
  std::vector<char> inside(graph.nodeCount(), 0);
  std::vector<Index> window;
  for (Index i = 0; i < graph.nodeCount(); ++i) {
    if (held[i]) continue;
    if (w[i] <= 0 ? gradient[i] > -kNoPull : w[i] >= 1 && gradient[i] < kNoPull) continue;
    inside[i] = 1;
    window.push_back(i);
  }
  std::size_t from = 0;
  for (int ring = 0; ring < kReach; ++ring) {
    const std::size_t to = window.size();
    for (; from < to; ++from) {
      for (const Index next : graph.neighbors[window[from]]) {
        if (next == kNoIndex || held[next] || inside[next]) continue;
        inside[next] = 1;
        window.push_back(next);
      }
    }
  }
  std::sort(window.begin(), window.end());
  return window;
}

}  // namespace

Index minimizeBoundedBiharmonic(const LatticeGraph& graph, const std::vector<bool>& held, std::span<double> w,
                                const BiharmonicOptions& options) {
  std::vector<double> scratch(graph.nodeCount()), gradient(graph.nodeCount()), before;
  std::vector<Index> localOf(graph.nodeCount(), kNoIndex);
  Index steps = 0;
  while (steps < options.mostIterations) {
    gradientOf(graph, w, scratch, gradient);
    const std::vector<Index> window = windowOf(graph, held, w, gradient);
    if (window.empty()) break;
    before.assign(w.begin(), w.end());
    WindowProblem problem(graph, window, w, gradient, localOf);
    steps += std::max<Index>(1, problem.descend(options.tolerance, std::min(kWindow, options.mostIterations - steps)));
    problem.write(w);
    double change = 0;
    for (const Index node : window) change = std::max(change, std::abs(w[node] - before[node]));
    if (change < options.tolerance) break;
  }
  return steps;
}

}  // namespace limber
