#include "limber/skeleton/ik/solvers/jacobian_iteration.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/core/small_solve.h"
#include "limber/skeleton/ik/ik_task_rows.h"

namespace limber {

namespace {

constexpr double kLongestTurn = kPi / 4;  // of a joint in one iteration
constexpr int kLimitPasses = 4;
constexpr int kTries = 10;                    // shorter and shorter steps before giving up
constexpr double kEnough = 0.1;               // of what a step promises to first order
constexpr Index kJacobianPatience = 10;       // iterations after which there must have been
constexpr double kJacobianProgress = 0.9995;  // this factor on the cost
constexpr int kStepBits = 28;                 // of a step that count, so that rounding does not tell left from right
constexpr double kSettled = 1e-5;             // fractional change of the distance to the reference pose

}  // namespace

std::vector<double> freedomsOf(const IkSystem& system) {
  std::vector<double> gains;
  for (const IkSystem::Node& node : system.nodes) gains.push_back(node.freedom);
  return gains;
}

JacobianIteration::JacobianIteration(const IkSystem& system) : JacobianIteration(system, freedomsOf(system)) {}

JacobianIteration::JacobianIteration(const IkSystem& system, std::vector<double> gains)
    : jacobian_(system, std::move(gains)),
      before_(system.makeState()),
      gained_(before_),
      rowsOf_(system.nodes.size()),
      masksRows_(system.tasks() != nullptr) {
  const Eigen::Index rows = jacobian_.rows(), columns = jacobian_.maxColumns();
  for (int n = 0; n < system.nodeCount(); ++n) {
    std::vector<Eigen::Index>& list = rowsOf_[static_cast<std::size_t>(n)];
    for (const int below : system.effectorsBelow(n)) {
      const auto e = static_cast<std::size_t>(below);
      for (int k = 0; k < jacobian_.rowCount[e]; ++k) list.push_back(jacobian_.rowBegin[e] + k);
    }
    for (Eigen::Index r = 0; system.tasks() && r < rows; ++r) list.push_back(r);
    std::sort(list.begin(), list.end());
  }
  reduced_.resize(rows, columns);
  projected_.resize(rows, columns);
  basis_.resize(rows, columns);
  gram_.resize(rows, rows);
  error_.resize(rows);
  y_.resize(rows);
  fixed_.resize(columns);
  step_.resize(columns);
  secondary_.resize(columns);
}

Index JacobianIteration::run(IkSystem& system, Index budget) {
  const bool hasSecondary = system.options().referenceGain > 0;
  double checked = system.cost();
  caution_ = 1;
  for (Index i = 0; i < budget; ++i) {
    iteration_ = i;
    const bool reached = system.allReached();
    if (reached && !hasSecondary) return i;
    const double distance = hasSecondary ? referenceDistance(system) : 0;
    if (!improve(system)) return i + 1;
    if (reached) {
      if (!(referenceDistance(system) < distance * (1 - kSettled))) return i + 1;
    } else if (i % kJacobianPatience == kJacobianPatience - 1) {
      const double cost = system.cost();
      if (!(cost < kJacobianProgress * checked)) return i + 1;
      checked = cost;
    }
  }
  return budget;
}

// One step that gains: on the cost, or where all targets are reached and stay so, on the secondary task. A step to the
// other side of a valley gains next to nothing, and so would all the steps to and fro after it: a shorter one is tried
// then, and the better of the two taken.
bool JacobianIteration::improve(IkSystem& system) {
  const double cost = system.cost();
  const bool reached = system.allReached();
  const double distance = reached ? referenceDistance(system) : 0;
  jacobian_.build(system);
  jacobian_.residual(system, error_);
  system.save(before_);
  double least = cost;
  for (int i = 0; i < kTries; ++i) {
    findStep(system);
    apply(system);
    const double now = system.cost();
    const bool gained = reached ? system.allReached() && referenceDistance(system) < distance : now < least;
    if (gained && (reached || cost - now >= kEnough * firstOrderGain(system))) {
      becomeBolder();
      return true;
    }
    if (!gained && least < cost) break;
    if (gained) {
      least = now;
      system.save(gained_);
    }
    system.restore(before_);
    caution_ = 4 * std::max(caution_, 0.25);
  }
  if (!(least < cost)) return false;
  system.restore(gained_);
  becomeBolder();
  return true;
}

void JacobianIteration::becomeBolder() {
  caution_ = std::max(heedsCaution() ? 1e-3 : 1.0, caution_ / 4);
}

int JacobianIteration::servedLevels(const IkSystem& system) const {
  return system.tasks() ? static_cast<int>(system.tasks()->servedLevels()) : jacobian_.levels();
}

// What the step would take off the cost, were the effectors to go on as they begin. The cost of tasks is that of the
// last priority served.
double JacobianIteration::firstOrderGain(const IkSystem& system) const {
  Eigen::Index begin = 0, end = jacobian_.rows();
  if (system.tasks()) {
    const auto last = static_cast<std::size_t>(servedLevels(system));
    begin = jacobian_.levelBegin[last - 1];
    end = jacobian_.levelBegin[last];
  }
  double sum = 0;
  for (Eigen::Index c = 0; c < jacobian_.columns(); ++c) {
    sum += step_[c] * jacobian_.matrix.col(c).segment(begin, end - begin).dot(error_.segment(begin, end - begin));
  }
  return 2 * sum;
}

// Inequalities that the step would violate become active, and the step is found anew.
void JacobianIteration::findStep(const IkSystem& system) {
  findStepOfActive(system);
  while (system.tasks() && system.tasks()->activate(jacobian_.matrix, step_, jacobian_.columns())) {
    jacobian_.residual(system, error_);
    findStepOfActive(system);
  }
}

void JacobianIteration::findStepOfActive(const IkSystem& system) {
  const Eigen::Index columns = jacobian_.columns();
  const int levels = servedLevels(system);
  reduced_.leftCols(columns) = jacobian_.matrix.leftCols(columns);
  for (Eigen::Index r = 0; system.tasks() && r < jacobian_.rows(); ++r) {
    if (!system.tasks()->active(r)) reduced_.row(r).setZero();
  }
  fixed_.head(columns).setZero();
  for (int pass = 0; pass < kLimitPasses; ++pass) {
    step_.head(columns) = fixed_.head(columns);
    basisRows_ = 0;
    for (int level = 0; level < levels; ++level) addLevel(level, level + 1 == levels);
    if (system.options().referenceGain > 0) addSecondary(system);
    shorten();
    if (!system.limited() || !blockLimits(system)) break;
  }
}

// Adds what one priority asks for, in directions that do not disturb the higher ones.
void JacobianIteration::addLevel(int level, bool last) {
  const auto l = static_cast<std::size_t>(level);
  const Eigen::Index begin = jacobian_.levelBegin[l], end = jacobian_.levelBegin[l + 1], rows = end - begin;
  const Eigen::Index columns = jacobian_.columns();
  const bool first = level == 0;
  auto y = y_.segment(begin, rows);
  y = error_.segment(begin, rows);
  for (Eigen::Index c = 0; c < columns; ++c) {
    if (step_[c] != 0) y -= step_[c] * jacobian_.matrix.col(c).segment(begin, rows);
  }
  for (Eigen::Index r = 0; masksRows_ && r < rows; ++r) {
    if (reduced_.row(begin + r).head(columns).isZero(0)) y[r] = 0;  // out of play: not to count as left to go
  }
  if (!first) projectLevel(begin, end);
  const Eigen::MatrixXd& matrix = first ? reduced_ : projected_;
  gramOfRows(begin, end, matrix, !first);
  auto gram = gram_.topLeftCorner(rows, rows);
  weighRows({matrix.block(begin, 0, rows, columns), gram, begin, iteration_, caution_}, y);
  for (Eigen::Index c = 0; c < columns; ++c) step_[c] += matrix.col(c).segment(begin, rows).dot(y);
  if (!last) extendBasis(begin, end);
}

void JacobianIteration::projectLevel(Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index columns = jacobian_.columns();
  for (Eigen::Index r = begin; r < end; ++r) {
    auto row = projected_.row(r).head(columns);
    row = reduced_.row(r).head(columns);
    for (Eigen::Index b = 0; b < basisRows_; ++b) {
      row -= row.dot(basis_.row(b).head(columns)) * basis_.row(b).head(columns);
    }
  }
}

// Modified Gram-Schmidt, each row twice for accuracy; rows that add no direction of their own are left out.
void JacobianIteration::extendBasis(Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index columns = jacobian_.columns();
  for (Eigen::Index r = begin; r < end; ++r) {
    auto row = basis_.row(basisRows_).head(columns);
    row = reduced_.row(r).head(columns);
    const double length = row.norm();
    for (int twice = 0; twice < 2; ++twice) {
      for (Eigen::Index b = 0; b < basisRows_; ++b) {
        row -= row.dot(basis_.row(b).head(columns)) * basis_.row(b).head(columns);
      }
    }
    const double left = row.norm();
    if (left <= 1e-9 * length || left == 0) continue;
    row /= left;
    ++basisRows_;
  }
}

// The Gram matrix of rows begin to end in the corner of gram_. Only effectors below a node have entries in its columns,
// unless the rows have been projected.
void JacobianIteration::gramOfRows(Eigen::Index begin, Eigen::Index end, const Eigen::MatrixXd& matrix, bool dense) {
  const Eigen::Index rows = end - begin;
  auto gram = gram_.topLeftCorner(rows, rows);
  gram.setZero();
  for (std::size_t n = 0; n < rowsOf_.size(); ++n) {
    for (int c = jacobian_.nodeBegin[n]; c < jacobian_.nodeBegin[n + 1]; ++c) {
      if (dense) {
        for (Eigen::Index s = begin; s < end; ++s) {
          const double factor = matrix(s, c);
          for (Eigen::Index r = s; r < end; ++r) gram(r - begin, s - begin) += factor * matrix(r, c);
        }
        continue;
      }
      for (std::size_t j = 0; j < rowsOf_[n].size(); ++j) {
        const Eigen::Index s = rowsOf_[n][j];
        if (s < begin || s >= end) continue;
        const double factor = matrix(s, c);
        for (std::size_t i = j; i < rowsOf_[n].size() && rowsOf_[n][i] < end; ++i) {
          gram(rowsOf_[n][i] - begin, s - begin) += factor * matrix(rowsOf_[n][i], c);
        }
      }
    }
  }
  for (Eigen::Index s = 0; s < rows; ++s) {
    for (Eigen::Index r = 0; r < s; ++r) gram(r, s) = gram(s, r);
  }
}

// Moves towards the reference pose as far as no row notices (to first order).
void JacobianIteration::addSecondary(const IkSystem& system) {
  const Eigen::Index columns = jacobian_.columns(), rows = jacobian_.rows();
  const double fraction = system.options().referenceGain;
  for (Eigen::Index c = 0; c < columns; ++c) {
    const IkJacobian::Freedom& freedom = jacobian_.freedoms[static_cast<std::size_t>(c)];
    const auto n = static_cast<std::size_t>(freedom.node);
    const double gain = jacobian_.gain(freedom.node) * (freedom.slides ? jacobian_.slideLength() : 1);
    const Vec3 displacement = freedom.slides ? Vec3(system.referenceOffsets[n] - system.offsets[n])
                                             : toRotationVector(system.locals[n].conjugate() * system.references[n]);
    secondary_[c] = fraction / gain * displacement.dot(freedom.axis);
  }
  gramOfRows(0, rows, reduced_, false);
  y_.setZero();
  for (Eigen::Index c = 0; c < columns; ++c) y_ += secondary_[c] * reduced_.col(c);
  solveCholesky(gram_, 1e-12 * gram_.diagonal().sum(), y_);
  for (Eigen::Index c = 0; c < columns; ++c) step_[c] += secondary_[c] - reduced_.col(c).dot(y_);
}

// No joint turns further than kLongestTurn at once, where what is linear here would mean nothing.
void JacobianIteration::shorten() {
  double longest = 0;
  const int nodes = static_cast<int>(rowsOf_.size());
  for (int n = 0; n < nodes; ++n) longest = std::max(longest, jacobian_.turnOf(n, step_).norm());
  double factor = longest > kLongestTurn ? kLongestTurn / longest : 1;
  if (!heedsCaution()) factor /= caution_;
  step_.head(jacobian_.columns()) *= factor;
  roundTogether(kStepBits, step_.head(jacobian_.columns()));
}

// Finds joints that the step takes beyond their limits, fixes what they can do of it and takes the blocked directions
// out of the Jacobian, so that other joints do the rest. False where no joint is newly blocked.
bool JacobianIteration::blockLimits(const IkSystem& system) {
  bool blocked = false;
  for (int n = 0; n < system.nodeCount(); ++n) {
    if (system.nodes[static_cast<std::size_t>(n)].limit) blocked = blockNode(system, n) || blocked;
  }
  return blocked;
}

bool JacobianIteration::blockNode(const IkSystem& system, int node) {
  const auto n = static_cast<std::size_t>(node);
  const int begin = jacobian_.nodeBegin[n], end = jacobian_.nodeBegin[n + 1];
  const Vec3 wanted = jacobian_.turnOf(node, step_);
  const double size = wanted.norm();
  if (size < 1e-12) return false;
  const Quat turned = (system.locals[n] * fromRotationVector(wanted)).normalized();
  const Quat allowed = nearestAllowed(*system.nodes[n].limit, turned);
  if (allowed.coeffs() == turned.coeffs()) return false;
  const Vec3 possible = toRotationVector(system.locals[n].conjugate() * allowed);

  // In the coordinates of the node's axes; what only leaves the curved surface of allowed rotations does not count.
  Vec3 excess = Vec3::Zero(), done = Vec3::Zero(), fixed = Vec3::Zero();
  int count = 0;
  for (int c = begin; c < end; ++c) {
    const IkJacobian::Freedom& freedom = jacobian_.freedoms[static_cast<std::size_t>(c)];
    if (freedom.slides) continue;
    excess[count] = freedom.axis.dot(wanted - possible);
    done[count] = freedom.axis.dot(possible) / jacobian_.gain(node);
    fixed[count++] = fixed_[c];
  }
  if (excess.norm() <= 1e-2 * size) return false;
  const Vec3 direction = excess.normalized();
  const double stays = direction.dot(done - fixed);
  for (int k = 0; k < count; ++k) fixed_[begin + k] += stays * direction[k];
  for (const Eigen::Index r : rowsOf_[n]) {
    double along = 0;
    for (int k = 0; k < count; ++k) along += direction[k] * reduced_(r, begin + k);
    for (int k = 0; k < count; ++k) reduced_(r, begin + k) -= along * direction[k];
  }
  return true;
}

void JacobianIteration::apply(IkSystem& system) const {
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (jacobian_.nodeBegin[i] == jacobian_.nodeBegin[i + 1]) continue;
    system.locals[i] = (system.locals[i] * fromRotationVector(jacobian_.turnOf(n, step_))).normalized();
    if (system.nodes[i].slides) system.offsets[i] += jacobian_.slideOf(n, step_);
    system.limitNode(n);
  }
  system.forward();
}

double JacobianIteration::referenceDistance(const IkSystem& system) const {
  double sum = 0;
  for (std::size_t n = 0; n < system.nodes.size(); ++n) {
    const double angle = angleBetween(system.locals[n], system.references[n]);
    sum += angle * angle;
    if (!system.nodes[n].slides) continue;
    sum += (system.offsets[n] - system.referenceOffsets[n]).squaredNorm() /
           (jacobian_.slideLength() * jacobian_.slideLength());
  }
  return std::sqrt(sum);
}

}  // namespace limber
