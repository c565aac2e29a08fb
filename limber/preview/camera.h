// Where a picture is taken from.
#pragma once

#include <span>
#include <string_view>

#include "limber/core/types.h"

namespace limber {

// Degrees. Azimuth 0 looks at the model's front (its +Z side), 90 at its left (+X); elevation 90 looks straight down.
struct ViewDirection {
  double azimuth = 35, elevation = 14;
};

// "front", "side", "back", "top", "three-quarter", or "azimuth,elevation" in degrees. Throws Error kBadArgument that
// lists the names there are.
ViewDirection parseView(std::string_view text);

// A pinhole camera. Pixel (0, 0) is the upper left corner of the picture.
struct Camera {
  Mat3 axes = Mat3::Identity();  // rows: right, up, towards the viewer
  Vec3 eye = Vec3::Zero();
  double focal = 1;  // pixels
  int width = 1, height = 1;

  // Pixel x and y, and the distance along the view axis (positive in front of the camera).
  Vec3 project(const Vec3& point) const {
    const Vec3 local = axes * (point - eye);
    const double depth = -local.z();
    return {0.5 * width + focal * local.x() / depth, 0.5 * height - focal * local.y() / depth, depth};
  }
  // From the eye through a pixel position; its component along the view axis is 1.
  Vec3 ray(double x, double y) const {
    return axes.transpose() * Vec3((x - 0.5 * width) / focal, (0.5 * height - y) / focal, -1);
  }
};

// The nearest camera in that direction that has all points in the picture, inside a margin. `points` is not empty.
Camera frameCamera(std::span<const Vec3f> points, const ViewDirection& direction, int width, int height);

}  // namespace limber
