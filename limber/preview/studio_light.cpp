#include "limber/preview/studio_light.h"

#include <algorithm>
#include <cmath>

#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr double kGoldenAngle = 2.39996322972865332;
constexpr int kMapSize = 448;
constexpr int kGroundSize = 192;
constexpr double kGroundExtent = 2.2;  // half side of the ground map, in radii of the model
constexpr double kBiasTexels = 1.6;    // a surface is lifted by this along its normal before it asks for its shadow
constexpr float kNothing = -1e30f;

Vec3 direction(double azimuth, double elevation) {
  const double a = azimuth * kDegree, e = elevation * kDegree;
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

Mat3 axesAround(const Vec3& towards) {
  const Vec3 helper = std::abs(towards.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  Mat3 axes;
  axes.row(0) = helper.cross(towards).normalized();
  axes.row(1) = towards.cross(Vec3(axes.row(0)));
  axes.row(2) = towards;
  return axes;
}

// A round lamp: `count` directions spread evenly over a disc of that angular radius.
void addLamp(std::vector<DirectionalLight>& lights, const Vec3& middle, double radiusDegrees, int count,
             const Vec3& color) {
  const Mat3 axes = axesAround(middle);
  const double spread = std::tan(radiusDegrees * kDegree);
  for (int i = 0; i < count; ++i) {
    const double r = spread * std::sqrt((i + 0.5) / count), turn = i * kGoldenAngle;
    const Vec3 towards = middle + r * (std::cos(turn) * axes.row(0) + std::sin(turn) * axes.row(1)).transpose();
    DirectionalLight light;
    light.axes = axesAround(towards.normalized());
    light.color = color / count;
    lights.push_back(std::move(light));
  }
}

// The ceiling and walls: directions spread over the upper hemisphere and a little below the horizon.
void addSky(std::vector<DirectionalLight>& lights, int count, const Vec3& color) {
  constexpr double kLowest = -0.35;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (1 - kLowest) * (i + 0.5) / count, r = std::sqrt(1 - y * y), turn = i * kGoldenAngle;
    DirectionalLight light;
    light.axes = axesAround(Vec3(r * std::cos(turn), y, r * std::sin(turn)));
    light.color = color * ((0.55 + 0.45 * y) * 2 / count);
    light.castsOnGround = y > 0.15;
    lights.push_back(std::move(light));
  }
}

// A linear function of x that has to be positive or zero narrows the range.
void narrow(double atZero, double slope, double& from, double& to) {
  if (slope > 0) {
    from = std::max(from, -atZero / slope);
  } else if (slope < 0) {
    to = std::min(to, -atZero / slope);
  } else if (atZero < 0) {
    to = from - 1;
  }
}

// One triangle into an orthographic depth map; x and y in texels. Row by row, from its left edge to its right one.
void drawDepth(std::vector<float>& depth, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (area == 0) return;
  const int y0 = std::max(0, int(std::ceil(std::min({a.y(), b.y(), c.y()}) - 0.5)));
  const int y1 = std::min(kMapSize - 1, int(std::floor(std::max({a.y(), b.y(), c.y()}) - 0.5)));
  const double scale = 1 / area;
  const double ubx = (c.y() - a.y()) * scale, uby = (a.x() - c.x()) * scale;  // gradient of b's coordinate
  const double ucx = (a.y() - b.y()) * scale, ucy = (b.x() - a.x()) * scale;  // and of c's
  const double dz = ubx * (b.z() - a.z()) + ucx * (c.z() - a.z());
  for (int y = y0; y <= y1; ++y) {
    const double py = y + 0.5 - a.y(), px = 0.5 - a.x();
    const double u = ubx * px + uby * py, v = ucx * px + ucy * py;  // at x = 0
    double from = 0, to = kMapSize - 1;
    narrow(u, ubx, from, to);
    narrow(v, ucx, from, to);
    narrow(1 - u - v, -ubx - ucx, from, to);
    if (!(from <= to)) continue;
    const int x0 = int(std::ceil(from)), x1 = int(std::floor(to));
    const float z0 = float(a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z())), step = float(dz);
    float* row = depth.data() + std::size_t(y) * kMapSize;
    for (int x = x0; x <= x1; ++x) row[x] = std::max(row[x], z0 + step * float(x));
  }
}

void blurRows(const std::vector<float>& from, std::vector<float>& to, int reach) {
  for (int y = 0; y < kGroundSize; ++y) {
    for (int x = 0; x < kGroundSize; ++x) {
      float sum = 0;
      for (int k = -reach; k <= reach; ++k) {
        sum += from[std::size_t(y * kGroundSize + std::clamp(x + k, 0, kGroundSize - 1))];
      }
      to[std::size_t(x * kGroundSize + y)] = sum / float(2 * reach + 1);  // transposed: two passes blur both axes
    }
  }
}

}  // namespace

StudioLight::StudioLight(std::span<const Vec3f> positions, std::span<const Triangle> triangles, double azimuth,
                         double groundHeight)
    : groundHeight_(groundHeight) {
  Box box;
  for (const Vec3f& p : positions) box.add(p.cast<double>());
  center_ = box.center();
  radius_ = 0;
  for (const Vec3f& p : positions) radius_ = std::max(radius_, (p.cast<double>() - center_).norm());
  if (radius_ == 0) radius_ = 1;
  texelsPerUnit_ = 0.5 * (kMapSize - 4) / radius_;

  addLamp(lights_, direction(azimuth - 38, 46), 9, 18, Vec3(1.00, 0.965, 0.91) * 1.45);  // key, upper left
  addLamp(lights_, direction(azimuth + 62, 18), 12, 6, Vec3(0.86, 0.93, 1.00) * 0.30);   // fill, right
  addLamp(lights_, direction(azimuth + 160, 38), 8, 6, Vec3(0.95, 0.98, 1.00) * 0.80);   // rim, behind
  addSky(lights_, 40, Vec3(0.95, 0.98, 1.00) * 0.52);

  parallelFor(lights_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) renderDepth(lights_[i], positions, triangles);
  });
  bakeGround();
}

void StudioLight::renderDepth(DirectionalLight& light, std::span<const Vec3f> positions,
                              std::span<const Triangle> triangles) const {
  light.depth.assign(std::size_t{kMapSize} * kMapSize, kNothing);
  std::vector<Vec3> projected(positions.size());
  const Vec3 shift(0.5 * kMapSize, 0.5 * kMapSize, 0), scale(texelsPerUnit_, texelsPerUnit_, 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    projected[i] = (light.axes * (positions[i].cast<double>() - center_)).cwiseProduct(scale) + shift;
  }
  for (const Triangle& t : triangles) drawDepth(light.depth, projected[t[0]], projected[t[1]], projected[t[2]]);
}

double StudioLight::visibility(const DirectionalLight& light, const Vec3& point) const {
  const Vec3 local = light.axes * (point - center_);
  const double x = local.x() * texelsPerUnit_ + 0.5 * kMapSize - 0.5,
               y = local.y() * texelsPerUnit_ + 0.5 * kMapSize - 0.5;
  const double floorX = std::floor(x), floorY = std::floor(y);
  if (!(floorX >= 0 && floorY >= 0 && floorX < kMapSize - 1 && floorY < kMapSize - 1)) return 1;
  const float* row = light.depth.data() + std::size_t(floorY) * kMapSize + std::size_t(floorX);
  const double fx = x - floorX, fy = y - floorY;
  const float z = float(local.z());
  const double near = (row[0] <= z ? 1 - fx : 0) + (row[1] <= z ? fx : 0);
  const double far = (row[kMapSize] <= z ? 1 - fx : 0) + (row[kMapSize + 1] <= z ? fx : 0);
  return near * (1 - fy) + far * fy;
}

StudioLight::Shade StudioLight::shade(const Vec3& point, const Vec3& normal, const Vec3& toViewer) const {
  Shade result;
  const Vec3 lifted = point + normal * (kBiasTexels / texelsPerUnit_);
  for (const DirectionalLight& light : lights_) {
    const Vec3 towards = light.axes.row(2);
    const double cosine = normal.dot(towards);
    if (cosine <= 0) continue;
    const double visible = visibility(light, lifted);
    if (visible <= 0) continue;
    result.diffuse += light.color * (cosine * visible);
    const double half = normal.dot((towards + toViewer).normalized());
    const double h4 = half * half * half * half, h16 = h4 * h4 * h4 * h4;
    result.specular += light.color * (visible * cosine * h16 * h16 * h4);
  }
  // What the floor throws back, which no shadow map covers.
  result.diffuse += Vec3(0.98, 0.97, 0.95) * (0.07 * (1 - 0.6 * normal.y()));
  return result;
}

StudioLight::Shade StudioLight::shadeUnshadowed(const Vec3& normal, const Vec3& toViewer) const {
  Shade result;
  for (const DirectionalLight& light : lights_) {
    const Vec3 towards = light.axes.row(2);
    const double cosine = normal.dot(towards);
    if (cosine <= 0) continue;
    result.diffuse += light.color * cosine;
    const double half = normal.dot((towards + toViewer).normalized());
    const double h4 = half * half * half * half, h16 = h4 * h4 * h4 * h4;
    result.specular += light.color * (cosine * h16 * h16 * h16);
  }
  result.diffuse += Vec3::Constant(0.07 * (1 - 0.6 * normal.y()));
  return result;
}

void StudioLight::bakeGround() {
  double total = 0;
  for (const DirectionalLight& light : lights_) {
    if (light.castsOnGround) total += light.color.mean() * std::max(0.0, light.axes(2, 1));
  }
  ground_.resize(std::size_t{kGroundSize} * kGroundSize);
  parallelFor(kGroundSize, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < kGroundSize; ++x) {
        const double across = (2 * (double(x) + 0.5) / kGroundSize - 1) * kGroundExtent * radius_;
        const double along = (2 * (double(y) + 0.5) / kGroundSize - 1) * kGroundExtent * radius_;
        const Vec3 point(center_.x() + across, groundHeight_, center_.z() + along);
        double lit = 0;
        for (const DirectionalLight& light : lights_) {
          if (!light.castsOnGround || light.axes(2, 1) <= 0) continue;
          lit += light.color.mean() * light.axes(2, 1) * visibility(light, point);
        }
        ground_[y * kGroundSize + x] = float(lit / total);
      }
    }
  });
  // Two box blurs along each axis: the lamps' separate directions melt into one soft shadow.
  std::vector<float> other(ground_.size());
  for (int pass = 0; pass < 2; ++pass) {
    blurRows(ground_, other, 2);
    blurRows(other, ground_, 2);
  }
}

double StudioLight::groundLight(const Vec3& point) const {
  const double perUnit = 0.5 * kGroundSize / (kGroundExtent * radius_);
  const double x = (point.x() - center_.x()) * perUnit + 0.5 * kGroundSize - 0.5;
  const double y = (point.z() - center_.z()) * perUnit + 0.5 * kGroundSize - 0.5;
  const double floorX = std::floor(x), floorY = std::floor(y);
  if (!(floorX >= 0 && floorY >= 0 && floorX < kGroundSize - 1 && floorY < kGroundSize - 1)) return 1;
  const float* row = ground_.data() + std::size_t(floorY) * kGroundSize + std::size_t(floorX);
  const double fx = x - floorX, fy = y - floorY;
  return (row[0] * (1 - fx) + row[1] * fx) * (1 - fy) + (row[kGroundSize] * (1 - fx) + row[kGroundSize + 1] * fx) * fy;
}

}  // namespace limber
