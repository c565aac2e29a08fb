#include "limber/preview/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limber/core/grouped.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr Index kManyFaces = 64;

bool lessPosition(const Vec3f& a, const Vec3f& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// The number of each vertex's position, counted over distinct positions.
std::vector<Index> positionNumbers(std::span<const Vec3f> positions, Index& count) {
  std::vector<Index> order(positions.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return lessPosition(positions[a], positions[b]); });
  std::vector<Index> number(positions.size());
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && lessPosition(positions[order[i - 1]], positions[order[i]])) ++count;
    number[order[i]] = count;
  }
  ++count;
  return number;
}

Vec3 faceNormal(std::span<const Vec3f> positions, const Triangle& triangle) {
  const Vec3 a = positions[triangle[0]].cast<double>();
  const Vec3 normal = (positions[triangle[1]].cast<double>() - a).cross(positions[triangle[2]].cast<double>() - a);
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

double cornerAngle(std::span<const Vec3f> positions, const Triangle& triangle, int corner) {
  const Vec3 p = positions[triangle[corner]].cast<double>();
  const Vec3 a = positions[triangle[(corner + 1) % 3]].cast<double>() - p;
  const Vec3 b = positions[triangle[(corner + 2) % 3]].cast<double>() - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Writes the normals of all corners at one position.
void smoothRound(std::span<const Index> corners, std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                 std::span<const Vec3> normals, double cosCrease, std::vector<Vec3f>& result) {
  std::vector<Vec3> weighted(corners.size());
  Vec3 all = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Index face = corners[i] / 3;
    weighted[i] = normals[face] * cornerAngle(positions, triangles[face], static_cast<int>(corners[i] % 3));
    all += weighted[i];
  }
  for (const Index corner : corners) {
    const Vec3& own = normals[corner / 3];
    Vec3 sum = all;
    if (corners.size() <= kManyFaces) {
      sum.setZero();
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (normals[corners[i] / 3].dot(own) >= cosCrease) sum += weighted[i];
      }
    }
    const double length = sum.norm();
    result[corner] = (length > 1e-12 ? Vec3(sum / length) : own).cast<float>();
  }
}

}  // namespace

std::vector<Vec3f> cornerNormals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                 double cosCrease) {
  Index positionCount = 0;
  const std::vector<Index> number = positionNumbers(positions, positionCount);

  const Grouped<Index> cornersAt(positionCount, [&](const auto& visit) {
    for (Index corner = 0; corner < 3 * triangles.size(); ++corner) {
      visit(number[triangles[corner / 3][corner % 3]], corner);
    }
  });
  std::vector<Vec3> normals;
  for (const Triangle& triangle : triangles) normals.push_back(faceNormal(positions, triangle));

  std::vector<Vec3f> result(triangles.size() * 3, Vec3f::Zero());
  parallelFor(positionCount, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      smoothRound(cornersAt.of(p), positions, triangles, normals, cosCrease, result);
    }
  });
  return result;
}

}  // namespace limber
