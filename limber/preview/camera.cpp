#include "limber/preview/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/text/parse_number.h"

namespace limber {

namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kFieldOfView = 28 * kDegree;  // of the shorter side: long enough to keep proportions true
constexpr double kMargin = 0.84;               // part of the picture that the model may fill

constexpr std::array<std::pair<std::string_view, ViewDirection>, 5> kViews = {{
    {"three-quarter", {35, 14}},
    {"front", {0, 6}},
    {"side", {90, 6}},
    {"back", {180, 6}},
    {"top", {0, 90}},
}};

Mat3 viewAxes(const ViewDirection& direction) {
  const double azimuth = direction.azimuth * kDegree, elevation = direction.elevation * kDegree;
  const Vec3 right(std::cos(azimuth), 0, -std::sin(azimuth));
  const Vec3 back(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                  std::cos(azimuth) * std::cos(elevation));
  Mat3 axes;
  axes.row(0) = right;
  axes.row(1) = back.cross(right);
  axes.row(2) = back;
  return axes;
}

}  // namespace

ViewDirection parseView(std::string_view text) {
  for (const auto& [name, view] : kViews) {
    if (name == text) return view;
  }
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos) {
    const auto azimuth = finiteNumber(text.substr(0, comma));
    const auto elevation = finiteNumber(text.substr(comma + 1));
    if (azimuth && elevation && std::abs(*elevation) <= 90) return {*azimuth, *elevation};
  }
  throw Error(ErrorCode::kBadArgument, "there is no view \"" + std::string(text) + "\"", "",
              "use front, side, back, top, three-quarter, or azimuth,elevation in degrees such as 30,15");
}

// A point p is inside the picture where |p.right - x| <= t (d - p.back) for the eye at x right + d back, and likewise
// upwards. Each side of the picture is thus one linear bound on (x, d), met by the extreme point along right +- t back.
Camera frameCamera(std::span<const Vec3f> points, const ViewDirection& direction, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.axes = viewAxes(direction);
  camera.focal = 0.5 * std::min(width, height) / std::tan(0.5 * kFieldOfView);
  const double tx = kMargin * 0.5 * width / camera.focal, ty = kMargin * 0.5 * height / camera.focal;

  constexpr double kLowest = -std::numeric_limits<double>::infinity();
  double right = kLowest, left = kLowest, top = kLowest, bottom = kLowest, nearest = kLowest;
  for (const Vec3f& point : points) {
    const Vec3 local = camera.axes * point.cast<double>();
    right = std::max(right, local.x() + tx * local.z());
    left = std::max(left, -local.x() + tx * local.z());
    top = std::max(top, local.y() + ty * local.z());
    bottom = std::max(bottom, -local.y() + ty * local.z());
    nearest = std::max(nearest, local.z());
  }
  double distance = std::max((right + left) / (2 * tx), (top + bottom) / (2 * ty));
  if (distance <= nearest) distance = nearest + 1;  // a single point has no size to frame
  camera.eye = camera.axes.transpose() * Vec3(0.5 * (right - left), 0.5 * (top - bottom), distance);
  return camera;
}

}  // namespace limber
