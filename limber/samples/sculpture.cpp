#include "limber/samples/sculpture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber {

namespace {

// The smaller of both, rounded where they are within `width` of each other (a cubic, so twice differentiable).
double smoothMin(double a, double b, double width) {
  const double lesser = std::min(a, b);
  const double overlap = width - std::abs(a - b);
  if (overlap <= 0) return lesser;
  const double h = overlap / width;
  return lesser - h * h * h * width / 6;
}

// The point of the axis whose sphere is nearest lies where a line along the cone's normal meets the axis.
double coneDistance(const Vec3& a, double ra, const Vec3& b, double rb, const Vec3& point) {
  const Vec3 axis = b - a, local = point - a;
  const double length = axis.norm();
  const double slope = length > 0 ? (ra - rb) / length : 2;
  if (std::abs(slope) >= 1) return ra >= rb ? local.norm() - ra : (point - b).norm() - rb;
  const double along = local.dot(axis) / length;
  const double across = std::sqrt(std::max(0.0, local.squaredNorm() - along * along));
  const double t = std::clamp((along - across * slope / std::sqrt(1 - slope * slope)) / length, 0.0, 1.0);
  return (local - t * axis).norm() - (ra + t * (rb - ra));
}

// First order: the implicit function over the length of its gradient.
double ellipsoidDistance(const Solid& s, const Vec3& point) {
  const Vec3 local = s.axes * (point - s.a), radii(s.ra, s.rb, s.rc);
  const Vec3 scaled = local.cwiseQuotient(radii);
  const double level = scaled.norm(), slope = scaled.cwiseQuotient(radii).norm();
  if (slope == 0) return -radii.minCoeff();
  return level * (level - 1) / slope;
}

double plateDistance(const Solid& s, const Vec3& point) {
  const Vec3 ab = s.b - s.a, ac = s.c - s.a, local = point - s.a;
  const double aa = ab.dot(ab), cc = ac.dot(ac), bc = ab.dot(ac);
  const double pb = local.dot(ab), pc = local.dot(ac);
  const double area = aa * cc - bc * bc;
  const double v = (cc * pb - bc * pc) / area, w = (aa * pc - bc * pb) / area;
  if (v >= 0 && w >= 0 && v + w <= 1) {
    return (local - v * ab - w * ac).norm() - ((1 - v - w) * s.ra + v * s.rb + w * s.rc);
  }
  // The nearest point lies on an edge that the point is beyond.
  double nearest = 1e30;
  if (w < 0) nearest = std::min(nearest, coneDistance(s.a, s.ra, s.b, s.rb, point));
  if (v < 0) nearest = std::min(nearest, coneDistance(s.c, s.rc, s.a, s.ra, point));
  if (v + w > 1) nearest = std::min(nearest, coneDistance(s.b, s.rb, s.c, s.rc, point));
  return nearest;
}

// A power of two. Finer cells have shorter lists and take longer to make.
constexpr std::uint32_t kCellsAlong = 32;

Vec3 mirrored(const Vec3& point) {
  return {-point.x(), point.y(), point.z()};
}

}  // namespace

double Solid::distance(const Vec3& point) const {
  switch (kind) {
    case Kind::kRoundCone:
      return coneDistance(a, ra, b, rb, point);
    case Kind::kEllipsoid:
      return ellipsoidDistance(*this, point);
    case Kind::kPlate:
      return plateDistance(*this, point);
  }
  return 0;
}

Solid roundCone(const Vec3& a, double ra, const Vec3& b, double rb) {
  Solid solid;
  solid.kind = Solid::Kind::kRoundCone;
  solid.a = a;
  solid.b = b;
  solid.ra = ra;
  solid.rb = rb;
  return solid;
}

Solid ellipsoid(const Vec3& center, const Vec3& radii, const Vec3& forward) {
  Solid solid;
  solid.kind = Solid::Kind::kEllipsoid;
  solid.a = center;
  solid.ra = radii.x();
  solid.rb = radii.y();
  solid.rc = radii.z();
  const Vec3 z = forward.normalized();
  const Vec3 helper = std::abs(z.y()) < 0.99 ? Vec3::UnitY() : Vec3(-Vec3::UnitZ());
  solid.axes.row(0) = helper.cross(z).normalized();
  solid.axes.row(1) = z.cross(Vec3(solid.axes.row(0)));
  solid.axes.row(2) = z;
  return solid;
}

Solid plate(const Vec3& a, double ra, const Vec3& b, double rb, const Vec3& c, double rc) {
  Solid solid;
  solid.kind = Solid::Kind::kPlate;
  solid.a = a;
  solid.b = b;
  solid.c = c;
  solid.ra = ra;
  solid.rb = rb;
  solid.rc = rc;
  return solid;
}

void Sculpture::add(const Solid& solid, double blend) {
  Step step;
  step.solid = solid;
  step.blend = blend;
  const bool bridge = solid.kind == Solid::Kind::kRoundCone && solid.a == mirrored(solid.b) && solid.ra == solid.rb;
  step.mirrored = !bridge && (solid.a.x() != 0 || solid.b.x() != 0 || solid.c.x() != 0);
  if (solid.kind == Solid::Kind::kEllipsoid) {
    step.center = solid.a;
    step.reach = std::max({solid.ra, solid.rb, solid.rc});
  } else {
    const bool flat = solid.kind == Solid::Kind::kPlate;
    step.center = flat ? Vec3((solid.a + solid.b + solid.c) / 3) : Vec3((solid.a + solid.b) / 2);
    step.reach = std::max((solid.a - step.center).norm() + solid.ra, (solid.b - step.center).norm() + solid.rb);
    if (flat) step.reach = std::max(step.reach, (solid.c - step.center).norm() + solid.rc);
  }
  all_.push_back(static_cast<std::uint32_t>(steps_.size()));
  steps_.push_back(step);
  cells_ = {};
}

void Sculpture::carve(const Solid& solid, double blend) {
  add(solid, blend);
  steps_.back().carved = true;
}

void Sculpture::cutBelow(double height, double blend) {
  floor_ = height;
  floorBlend_ = blend;
}

// Is the point less than `within` away from the ball round the step's solid?
bool Sculpture::near(const Vec3& point, const Step& step, double within) {
  const double limit = within + step.reach;
  return limit > 0 && (point - step.center).squaredNorm() < limit * limit;
}

// Of the step's solid and its mirror image, anywhere in the cube of that middle and half side.
Sculpture::Range Sculpture::rangeOf(const Step& step, const Vec3& middle, double half) {
  const double reach = std::sqrt(3.0) * half;
  const auto of = [&](const Vec3& at) -> Range {
    const Solid& s = step.solid;
    if (s.kind == Solid::Kind::kEllipsoid) {
      // (level - 1) times level / slope, which lies between the least and the greatest radius.
      const Vec3 radii(s.ra, s.rb, s.rc), scaled = (s.axes * (at - s.a)).cwiseQuotient(radii);
      const double least = radii.minCoeff(), most = radii.maxCoeff();
      const double level = scaled.norm(), slope = scaled.cwiseQuotient(radii).norm();
      const Range levels{std::max(0.0, level - reach / least), level + reach / least};
      const Range slopes{slope - reach / (least * least), slope + reach / (least * least)};
      const Range ratio{std::max(least, levels.low / slopes.high),
                        slopes.low > 0 ? std::min(most, levels.high / slopes.low) : most};
      const double low = levels.low - 1, high = levels.high - 1;
      return {low * (low < 0 ? ratio.high : ratio.low), high * (high < 0 ? ratio.low : ratio.high)};
    }
    const double distance = s.distance(at);
    if (s.kind == Solid::Kind::kRoundCone) return {distance - reach, distance + reach};
    // Not quite a distance: its slope is a little steeper than 1, and it jumps by up to a difference of its radii.
    const double error = 1.1 * reach + std::max({s.ra, s.rb, s.rc}) - std::min({s.ra, s.rb, s.rc});
    return {distance - error, distance + error};
  };
  const Range one = of(middle);
  if (!step.mirrored) return one;
  const Range other = of(mirrored(middle));
  return {std::min(one.low, other.low) - step.blend / 6, std::min(one.high, other.high)};
}

// The steps `among` those that change anything anywhere in the cube: all but those that are too far from the surface
// that there is before them, and those before a solid that the cube lies so deep in, or that is so much nearer than all
// before it, that it alone counts.
std::vector<std::uint32_t> Sculpture::mattering(std::span<const std::uint32_t> among, const Vec3& middle,
                                                double half) const {
  std::vector<std::uint32_t> kept;
  Range result{1e30, 1e30};
  for (const std::uint32_t number : among) {
    const Step& step = steps_[number];
    const Range d = rangeOf(step, middle, half);
    if (step.carved) {
      if (d.low >= -result.low + step.blend) continue;
      result = {std::max(result.low, -d.high), std::max(result.high, -d.low) + step.blend / 6};
    } else {
      if (d.low >= result.high + step.blend) continue;
      if (d.high + step.blend <= result.low) {
        kept.clear();
        result = d;
      } else {
        result = {std::min(result.low, d.low) - step.blend / 6, std::min(result.high, d.high)};
      }
    }
    kept.push_back(number);
  }
  return kept;
}

void Sculpture::prepare() {
  const Box box = bounds();
  const double side = box.size().maxCoeff();
  Cells cells;
  cells.origin = 0.5 * (box.min + box.max) - Vec3::Constant(0.5 * side);
  cells.size = side / kCellsAlong;
  std::vector<std::vector<std::uint32_t>> lists(std::size_t{kCellsAlong} * kCellsAlong * kCellsAlong);
  const auto cut = [&](const auto& self, std::span<const std::uint32_t> among, const std::array<std::uint32_t, 3>& low,
                       std::uint32_t width) -> void {
    const double half = 0.5 * width * cells.size;
    const Vec3 middle = cells.origin + cells.size * Vec3(low[0], low[1], low[2]) + Vec3::Constant(half);
    std::vector<std::uint32_t> here = mattering(among, middle, half);
    if (width == 1) {
      lists[(std::size_t{low[2]} * kCellsAlong + low[1]) * kCellsAlong + low[0]] = std::move(here);
      return;
    }
    const std::uint32_t step = width / 2;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      self(self, here, {low[0] + step * (corner & 1), low[1] + step * (corner >> 1 & 1), low[2] + step * (corner >> 2)},
           step);
    }
  };
  cut(cut, all_, {0, 0, 0}, kCellsAlong);
  for (const std::vector<std::uint32_t>& list : lists) {
    cells.first.push_back(static_cast<std::uint32_t>(cells.steps.size()));
    cells.steps.insert(cells.steps.end(), list.begin(), list.end());
  }
  cells.first.push_back(static_cast<std::uint32_t>(cells.steps.size()));
  cells_ = std::move(cells);
}

// Those that matter there: all of them outside the cells.
std::span<const std::uint32_t> Sculpture::stepsAt(const Vec3& point) const {
  if (cells_.first.empty()) return all_;
  const auto side = static_cast<double>(kCellsAlong);
  const Vec3 at = (point - cells_.origin) / cells_.size;
  if (at.minCoeff() < 0 || at.maxCoeff() >= side) return all_;
  const auto x = static_cast<std::size_t>(at.x()), y = static_cast<std::size_t>(at.y()),
             z = static_cast<std::size_t>(at.z());
  const std::size_t cell = (z * kCellsAlong + y) * kCellsAlong + x;
  return {cells_.steps.data() + cells_.first[cell], cells_.first[cell + 1] - cells_.first[cell]};
}

double Sculpture::distance(const Vec3& point) const {
  const Vec3 across = mirrored(point);
  double result = 1e30;
  for (const std::uint32_t number : stepsAt(point)) {
    const Step& step = steps_[number];
    const double within = (step.carved ? -result : result) + step.blend;  // farther away it changes nothing
    double d = 1e30;
    if (near(point, step, within)) d = step.solid.distance(point);
    if (step.mirrored && near(across, step, within + step.blend)) {
      d = smoothMin(d, step.solid.distance(across), step.blend);
    }
    result = step.carved ? -smoothMin(-result, d, step.blend) : smoothMin(result, d, step.blend);
  }
  return floorBlend_ > 0 ? -smoothMin(-result, point.y() - floor_, floorBlend_) : result;
}

Vec3 Sculpture::gradient(const Vec3& point) const {
  constexpr double kStep = 1e-4;
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 ahead = point, behind = point;
    ahead[axis] += kStep;
    behind[axis] -= kStep;
    result[axis] = (distance(ahead) - distance(behind)) / (2 * kStep);
  }
  return result;
}

Vec3 Sculpture::slope(const Vec3& point, double distanceThere) const {
  constexpr double kStep = 1e-5;
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = (distance(point + kStep * Vec3::Unit(axis)) - distanceThere) / kStep;
  return result;
}

Box Sculpture::bounds() const {
  Box box;
  for (const Step& step : steps_) {
    if (step.carved) continue;
    const Vec3 margin = Vec3::Constant(step.reach + step.blend);
    for (const Vec3& center : {step.center, mirrored(step.center)}) {
      box.add(center - margin);
      box.add(center + margin);
    }
  }
  return box;
}

}  // namespace limber
