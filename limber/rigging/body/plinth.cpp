#include "limber/rigging/body/plinth.h"

#include <algorithm>
#include <vector>

namespace limber {

namespace {

constexpr double kBottom = 0.1;      // of the height, where a plinth is widest
constexpr double kHighest = 0.3;     // of the height, of its top
constexpr double kAbove = 0.6;       // most of its area that the body takes above it
constexpr double kMinFill = 0.6;     // of the rectangle round it: two feet fill less
constexpr double kMinBreadth = 0.6;  // of the rectangle round all of the body

// A level cut through a body, in nodes and their extent along two level axes.
struct Layer {
  std::size_t nodes = 0;
  Box extent;

  void add(const Vec3& position) {
    ++nodes;
    extent.add(position);
  }
  double rectangle(double spacing) const {
    return nodes == 0 ? 0 : (extent.size().x() + spacing) * (extent.size().z() + spacing);
  }
};

}  // namespace

std::optional<double> plinthTop(const BodyVolume& body, const Vec3& up) {
  const SignedDistance& distance = *body.distance;
  const double spacing = distance.spacing();
  Mat3 axes;
  axes.row(0) = up.unitOrthogonal().transpose();
  axes.row(1) = up.transpose();
  axes.row(2) = axes.row(0).cross(axes.row(1));
  std::vector<Vec3> inside;
  Layer all;
  for (std::size_t node = 0; node < distance.nodeCount(); ++node) {
    if (distance.value(node) >= 0) continue;
    inside.push_back(axes * distance.position(node));
    all.add(inside.back());
  }
  if (inside.empty()) return {};
  const double low = all.extent.min.y(), height = all.extent.size().y();
  std::vector<Layer> layers(static_cast<std::size_t>(height / spacing + 0.5) + 1);
  for (const Vec3& position : inside)
    layers[static_cast<std::size_t>((position.y() - low) / spacing + 0.5)].add(position);
  const auto upTo = [&](double fraction) {
    return layers.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(layers.size() - 1)) + 1;
  };
  const auto widest =
      std::max_element(layers.begin(), upTo(kBottom), [](const Layer& a, const Layer& b) { return a.nodes < b.nodes; });
  const double area = static_cast<double>(widest->nodes) * spacing * spacing, rectangle = widest->rectangle(spacing);
  if (area < kMinFill * rectangle || rectangle < kMinBreadth * all.rectangle(spacing)) return {};
  const auto above = std::find_if(widest, upTo(kHighest), [&](const Layer& layer) {
    return static_cast<double>(layer.nodes) < kAbove * static_cast<double>(widest->nodes);
  });
  if (above == upTo(kHighest)) return {};
  return low + (static_cast<double>(above - layers.begin()) - 0.5) * spacing;
}

}  // namespace limber
