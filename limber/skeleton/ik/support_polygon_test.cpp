#include "limber/skeleton/ik/support_polygon.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "random_values.h"

namespace limber {
namespace {

using Point = Eigen::Vector2d;

// Of all segments between two points those that have all others on one side are the hull's edges.
double distanceByAllSegments(const Point& point, const std::vector<Point>& corners) {
  double outside = 1e300, inside = -1e300;
  bool isInside = false;
  for (const Point& a : corners) {
    for (const Point& b : corners) {
      const double weight = nearestOnSegment(point, a, b);
      outside = std::min(outside, (point - (a + weight * (b - a))).norm());
      const Point line = b - a;
      if (!(line.norm() > 0)) continue;
      const Point normal = Point(line.y(), -line.x()).normalized();
      double highest = -1e300, lowest = 1e300;
      for (const Point& corner : corners) {
        highest = std::max(highest, normal.dot(corner - a));
        lowest = std::min(lowest, normal.dot(corner - a));
      }
      if (highest > 1e-9 * line.norm() || lowest > -1e-6 * line.norm()) continue;
      isInside = true;
      inside = std::max(inside, normal.dot(point - a));
    }
  }
  return isInside && inside <= 0 ? inside : outside;
}

TEST(SupportPolygon, DistancesAreThoseByAllSegments) {
  testing::RandomValues random(5);
  int inside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const auto count = 1 + static_cast<std::size_t>(random.below(12));
    std::vector<Point> corners;
    for (std::size_t i = 0; i < count; ++i) {
      Point corner(random.uniform(-1, 1), random.uniform(-1, 1));
      if (trial % 5 == 1) corner = (4 * corner).array().round() / 4;  // many on one line, some twice
      if (trial % 5 == 2) corner.y() = 0.5 * corner.x();
      if (trial % 5 == 3 && i > 0) corner = corners[0];
      corners.push_back(corner);
    }
    for (int k = 0; k < 10; ++k) {
      const Point point(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
      const HullPoint onHull = nearestOnHull(point, corners);
      EXPECT_NEAR(onHull.distance, distanceByAllSegments(point, corners), 1e-8) << trial;
      ASSERT_TRUE(onHull.a < count && onHull.b < count);
      const Point nearest = corners[onHull.a] + onHull.weight * (corners[onHull.b] - corners[onHull.a]);
      EXPECT_NEAR(onHull.out.norm(), 1, 1e-9);
      EXPECT_LT((nearest + onHull.distance * onHull.out - point).norm(), 1e-8) << trial;
      inside += onHull.distance < 0;
    }
  }
  EXPECT_GT(inside, 200);
}

TEST(SupportPolygon, OnePointHasNoInside) {
  const std::vector<Point> corners = {Point(1, 2)};
  const HullPoint nearest = nearestOnHull(Point(1, 2), corners);
  EXPECT_EQ(nearest.distance, 0);
  EXPECT_EQ(nearestOnHull(Point(4, 6), corners).distance, 5);
}

}  // namespace
}  // namespace limber
