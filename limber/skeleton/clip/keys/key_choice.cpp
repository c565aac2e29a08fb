#include "limber/skeleton/clip/keys/key_choice.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr double kStraight = 1 - 1e-7;  // of a dot product: so near that a line is as good as an arc

// Distances of rotations are chords of the unit sphere, half the angle where it is small.
class RotationLine {
 public:
  RotationLine(const Quat& from, const Quat& to) : from_(from.coeffs()), to_(to.coeffs()) {
    double dot = from_.dot(to_);
    if (dot < 0) to_ = -to_, dot = -dot;
    if (dot >= kStraight) return;
    angle_ = std::acos(dot);
    perSine_ = 1 / std::sin(angle_);
  }

  double squaredDistance(double u, const Quat& value) const {
    const double a = angle_ > 0 ? std::sin((1 - u) * angle_) * perSine_ : 1 - u;
    const double b = angle_ > 0 ? std::sin(u * angle_) * perSine_ : u;
    const Vec4 at = a * from_ + b * to_;
    return std::min((at - value.coeffs()).squaredNorm(), (at + value.coeffs()).squaredNorm());
  }

 private:
  Vec4 from_, to_;
  double angle_ = 0, perSine_ = 0;
};

class StraightLine {
 public:
  StraightLine(const Vec3& from, const Vec3& to) : from_(from), step_(to - from) {}
  double squaredDistance(double u, const Vec3& value) const { return (from_ + u * step_ - value).squaredNorm(); }

 private:
  Vec3 from_, step_;
};

Vec3 difference(const Quat& to, const Quat& from) {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  return 2 * turn.vec();  // the rotation vector where it is small
}
Vec3 difference(const Vec3& to, const Vec3& from) {
  return to - from;
}
Quat between(const Quat& a, const Quat& b, double u) {
  return a.slerp(u, b);
}
Vec3 between(const Vec3& a, const Vec3& b, double u) {
  return a + u * (b - a);
}
Quat moved(const Quat& value, const Vec3& by) {
  Quat turn;
  turn.vec() = 0.5 * by;
  turn.w() = 1;
  return (turn.normalized() * value).normalized();
}
Vec3 moved(const Vec3& value, const Vec3& by) {
  return value + by;
}

template <typename Value>
std::vector<Value> fit(std::span<const double> times, std::span<const Value> values, std::span<const Index> kept) {
  const std::size_t count = kept.size();
  std::vector<Value> result;
  for (const Index frame : kept) result.push_back(values[frame]);
  // Normal equations of hat functions: sums over the frames of hat * hat and of hat * residual. Frames at keys are met
  // by their own hat alone.
  std::vector<double> diagonal(count, 1), above(count, 0);
  std::vector<Vec3> right(count, Vec3::Zero());
  for (std::size_t k = 0; k + 1 < count; ++k) {
    const double span = times[kept[k + 1]] - times[kept[k]];
    for (Index i = kept[k] + 1; i < kept[k + 1]; ++i) {
      const double u = (times[i] - times[kept[k]]) / span;
      const Vec3 off = difference(values[i], between(values[kept[k]], values[kept[k + 1]], u));
      diagonal[k] += (1 - u) * (1 - u), diagonal[k + 1] += u * u, above[k] += u * (1 - u);
      right[k] += (1 - u) * off, right[k + 1] += u * off;
    }
  }
  // Without the first and the last, which stay.
  for (std::size_t k = 2; k + 1 < count; ++k) {
    const double factor = above[k - 1] / diagonal[k - 1];
    diagonal[k] -= factor * above[k - 1];
    right[k] -= factor * right[k - 1];
  }
  Vec3 next = Vec3::Zero();
  for (std::size_t k = count - 1; k-- > 1;) {
    next = (right[k] - above[k] * next) / diagonal[k];
    result[k] = moved(result[k], next);
  }
  return result;
}

template <typename Line, typename Value>
std::vector<Index> choose(std::span<const double> times, std::span<const Value> values, double tolerance) {
  const auto last = static_cast<Index>(values.size() - 1);
  const double most = tolerance * tolerance;
  const auto reaches = [&](Index from, Index to) {
    const Line line(values[from], values[to]);
    const double span = times[to] - times[from];
    for (Index i = from + 1; i < to; ++i) {
      if (line.squaredDistance((times[i] - times[from]) / span, values[i]) > most) return false;
    }
    return true;
  };
  std::vector<Index> kept = {0};
  while (kept.back() < last) {
    const Index from = kept.back();
    Index good = from + 1, step = 1;
    while (good < last && reaches(from, std::min(good + step, last))) {
      good = std::min(good + step, last);
      step *= 2;
    }
    for (; step > 1; step /= 2) {
      const Index middle = good + step / 2;
      if (middle <= last && reaches(from, middle)) good = middle;
    }
    kept.push_back(good);
  }
  return kept;
}

}  // namespace

std::vector<Index> chooseKeys(std::span<const double> times, std::span<const Quat> values, double tolerance) {
  return choose<RotationLine>(times, values, tolerance / 2);
}

std::vector<Index> chooseKeys(std::span<const double> times, std::span<const Vec3> values, double tolerance) {
  return choose<StraightLine>(times, values, tolerance);
}

std::vector<Quat> fitKeys(std::span<const double> times, std::span<const Quat> values, std::span<const Index> kept) {
  return fit(times, values, kept);
}

std::vector<Vec3> fitKeys(std::span<const double> times, std::span<const Vec3> values, std::span<const Index> kept) {
  return fit(times, values, kept);
}

}  // namespace limber
