#include "limber/motion/limbs/body/skin_tube.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

struct TubeSamples {
  std::size_t minSamples = 12;  // samples; 4 to 60; that a joint needs for a tube; set by hand
  // Sectors; 0 to 1, but no simple fraction; the skin of a limb that was made regular lies on no edge between two,
  // where the last bit of an angle, which compilers' libraries give differently, would tell to which it belongs;
  // rounding only.
  double offEdges = 0.13;
  double outermost = 0.9;  // fraction; 0.5 to 1; of the samples of one side within its radius; set by hand
};
constexpr TubeSamples kTubeSamples;

}  // namespace

std::optional<SkinTube> SkinTube::about(Index joint, const BodySkin& skin) {
  std::vector<Vec3> positions;
  Vec3 middle = Vec3::Zero();
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    if (skin.joints[i] != joint) continue;
    positions.push_back(skin.positions[i]);
    middle += skin.positions[i];
  }
  if (positions.size() < kTubeSamples.minSamples) return std::nullopt;
  middle /= static_cast<double>(positions.size());
  if (!(middle.norm() > 0)) return std::nullopt;
  SkinTube tube;
  tube.joint_ = joint;
  tube.axis_ = middle.normalized();
  tube.side_ = tube.axis_.unitOrthogonal();
  tube.ahead_ = tube.axis_.cross(tube.side_);
  std::vector<double> along;
  for (const Vec3& position : positions) along.push_back(position.dot(tube.axis_));
  const auto [first, last] = std::minmax_element(along.begin(), along.end());
  tube.begin_ = *first;
  tube.end_ = *last;
  if (!(tube.end_ > tube.begin_)) return std::nullopt;
  std::array<std::vector<double>, kCells> found;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double x = positions[i].dot(tube.side_), z = positions[i].dot(tube.ahead_);
    const int ring =
        std::min(static_cast<int>(kRings * (along[i] - tube.begin_) / (tube.end_ - tube.begin_)), kRings - 1);
    const int sector = static_cast<int>(std::floor(sectorAt(x, z) + 0.5)) % kSectors;
    found[static_cast<std::size_t>(ring * kSectors + sector)].push_back(std::sqrt(x * x + z * z));
  }
  for (std::size_t cell = 0; cell < found.size(); ++cell) {
    std::vector<double>& radii = found[cell];
    if (radii.empty()) continue;
    std::sort(radii.begin(), radii.end());
    tube.radius_[cell] =
        radii[static_cast<std::size_t>(kTubeSamples.outermost * static_cast<double>(radii.size() - 1))];
  }
  // Where there is no skin, as much as beside it.
  for (int pass = 0; pass < kSectors; ++pass) {
    for (int cell = 0; cell < kRings * kSectors; ++cell) {
      double& radius = tube.radius_[static_cast<std::size_t>(cell)];
      if (radius > 0) continue;
      const int ring = cell / kSectors, sector = cell % kSectors;
      const auto at = [&](int r, int s) {
        return tube
            .radius_[static_cast<std::size_t>(std::clamp(r, 0, kRings - 1) * kSectors + (s + kSectors) % kSectors)];
      };
      double least = 0;
      for (const double beside :
           {at(ring, sector - 1), at(ring, sector + 1), at(ring - 1, sector), at(ring + 1, sector)}) {
        if (beside > 0) least = least > 0 ? std::min(least, beside) : beside;
      }
      radius = least;
    }
  }
  return tube;
}

double SkinTube::sectorAt(double x, double z) {
  return kSectors * (std::atan2(z, x) / (2 * kPi) + 1) + kTubeSamples.offEdges;
}

double SkinTube::radiusAt(double along, double sector) const {
  const double ring = std::clamp(kRings * (along - begin_) / (end_ - begin_) - 0.5, 0.0, kRings - 1.0);
  const int r = std::min(static_cast<int>(ring), kRings - 2), s = static_cast<int>(std::floor(sector));
  const double up = ring - r, round = sector - s;
  const auto at = [&](int row, int column) {
    return radius_[static_cast<std::size_t>(row * kSectors + column % kSectors)];
  };
  const auto mix = [&](int row) { return at(row, s) + round * (at(row, s + 1) - at(row, s)); };
  return mix(r) + up * (mix(r + 1) - mix(r));
}

std::optional<SkinTube::Depth> SkinTube::depthOf(const Vec3& point, const BodyFrame& frame) const {
  const Quat& turn = frame.rotations[joint_];
  const Vec3 position = turn.conjugate() * (point - frame.positions[joint_]);
  const double along = position.dot(axis_), x = position.dot(side_), z = position.dot(ahead_),
               away = std::sqrt(x * x + z * z);
  if (along < begin_ || along > end_ || !(away > 0)) return std::nullopt;
  // Thinner towards the ends, so that nothing jumps there.
  const double inner = std::min(along - begin_, end_ - along) / (end_ - begin_);
  const double radius = radiusAt(along, sectorAt(x, z)) * std::min(1.0, inner / 0.1);
  return Depth{radius - away, turn * (x * side_ + z * ahead_) / away};
}

double SkinTube::thickness() const {
  double sum = 0;
  for (const double radius : radius_) sum += radius;
  return sum / static_cast<double>(radius_.size());
}

}  // namespace limber
