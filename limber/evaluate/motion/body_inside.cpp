#include "limber/evaluate/motion/body_inside.h"

#include <limits>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

namespace {

constexpr double kInsideAbove = 0.5;    // winding number
constexpr double kStepAcross = 1e-5;    // of the longest side
constexpr int kMaxSurfacesWithin = 64;  // that a ray crosses

}  // namespace

BodyInside::BodyInside(const TriMesh& mesh) : surface_(mesh), winding_(mesh), step_(kStepAcross * longestSide(mesh)) {}

bool BodyInside::contains(const Vec3& point) const {
  return winding_.at(point) > kInsideAbove;
}

std::optional<double> BodyInside::exitFrom(const Vec3& point, const Vec3& direction) const {
  double gone = 0;
  for (int i = 0; i < kMaxSurfacesWithin; ++i) {
    const auto hit = surface_.firstHit(point + gone * direction, direction, std::numeric_limits<double>::infinity());
    if (!hit) return std::nullopt;
    const double at = gone + hit->distance;
    gone = at + step_;
    if (!contains(point + gone * direction)) return at;
  }
  return std::nullopt;
}

}  // namespace limber
