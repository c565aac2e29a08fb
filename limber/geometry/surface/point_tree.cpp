#include "limber/geometry/surface/point_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

namespace limber {

namespace {

constexpr int kBitsPerAxis = 10;
constexpr std::size_t kCrowd = 256;  // points of one cell: more only where a model lies in a small part of its box

std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

std::vector<std::uint32_t> mortonCodes(std::span<const Vec3f> points) {
  Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  for (const Vec3f& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const float side = (high - low).maxCoeff();
  const float cells = static_cast<float>(1 << kBitsPerAxis);
  const float scale = side > 0 ? cells / side : 0;
  const auto cell = [&](float x) { return static_cast<std::uint32_t>(std::clamp(x * scale, 0.0f, cells - 1)); };
  std::vector<std::uint32_t> codes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f p = points[i] - low;
    codes[i] = spread(cell(p.x())) | spread(cell(p.y())) << 1 | spread(cell(p.z())) << 2;
  }
  return codes;
}

// Points of one cell, in the order of a curve through their own box.
void orderCrowd(std::span<const Vec3f> points, std::span<Index> crowd) {
  std::vector<Vec3f> own;
  for (const Index i : crowd) own.push_back(points[i]);
  if (std::all_of(own.begin(), own.end(), [&](const Vec3f& p) { return p == own.front(); })) return;
  std::vector<Index> ordered;
  for (const Index i : mortonOrder(own)) ordered.push_back(crowd[i]);
  std::copy(ordered.begin(), ordered.end(), crowd.begin());
}

}  // namespace

std::vector<Index> mortonOrder(std::span<const Vec3f> points) {
  const std::vector<std::uint32_t> codes = mortonCodes(points);
  std::vector<Index> order(points.size()), next(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  constexpr int kDigit = 10;
  for (int shift = 0; shift < 3 * kBitsPerAxis; shift += kDigit) {
    std::array<Index, (1 << kDigit) + 1> begin{};
    const auto digit = [&](Index i) { return codes[i] >> shift & ((1u << kDigit) - 1); };
    for (const Index i : order) ++begin[digit(i) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const Index i : order) next[begin[digit(i)]++] = i;
    order.swap(next);
  }
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && codes[order[end]] == codes[order[begin]]) ++end;
    if (end - begin > kCrowd) orderCrowd(points, {&order[begin], end - begin});
  }
  return order;
}

PointTree::PointTree(std::span<const Vec3f> points) : points_(points), order_(mortonOrder(points)) {
  leaves_ = std::bit_ceil((points.size() + kLeafSize - 1) / kLeafSize);
  boxes_.resize(2 * leaves_);
  for (Part leaf = leaves_; leaf < 2 * leaves_; ++leaf) boundLeaf(leaf);
  for (Part part = leaves_ - 1; part > 0; --part) boundInner(part);
}

void PointTree::boundLeaf(Part leaf) {
  Box3 box;
  for (std::size_t i = beginOf(leaf); i < beginOf(leaf + 1); ++i) {
    if (order_[i] == kNoIndex) continue;
    box.min = box.min.cwiseMin(points_[order_[i]]);
    box.max = box.max.cwiseMax(points_[order_[i]]);
  }
  boxes_[leaf] = box;
}

void PointTree::boundInner(Part part) {
  boxes_[part].min = boxes_[2 * part].min.cwiseMin(boxes_[2 * part + 1].min);
  boxes_[part].max = boxes_[2 * part].max.cwiseMax(boxes_[2 * part + 1].max);
}

Index PointTree::nearest(const Vec3f& p, float radius) const {
  struct Visit {
    Part part = 0;
    float distance = 0;
  };
  std::array<Visit, 64> visits;  // the tree is at most 32 deep
  std::size_t count = 0;
  Index best = kNoIndex;
  float least = radius * radius;
  const auto add = [&](Part part, float distance) {
    if (distance <= least) visits[count++] = {part, distance};
  };
  add(1, distanceSquared(1, p));
  while (count > 0) {
    const Visit visit = visits[--count];
    if (visit.distance > least) continue;
    if (visit.part < leaves_) {
      Part closer = 2 * visit.part, farther = closer + 1;
      float toCloser = distanceSquared(closer, p), toFarther = distanceSquared(farther, p);
      if (toFarther < toCloser) {
        std::swap(closer, farther);
        std::swap(toCloser, toFarther);
      }
      add(farther, toFarther);
      add(closer, toCloser);
      continue;
    }
    for (std::size_t i = beginOf(visit.part); i < beginOf(visit.part + 1); ++i) {
      const Index point = order_[i];
      if (point == kNoIndex) continue;
      const float apart = (points_[point] - p).squaredNorm();
      if (apart > least || (apart == least && point > best)) continue;
      best = point;
      least = apart;
    }
  }
  return best;
}

void PointTree::takeOut(Index point) {
  if (slotOf_.empty()) {
    slotOf_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) slotOf_[order_[i]] = static_cast<Index>(i);
  }
  const std::size_t slot = slotOf_[point];
  order_[slot] = kNoIndex;
  Part part = leaves_ + slot / kLeafSize;
  boundLeaf(part);
  while ((part /= 2) > 0) boundInner(part);
}

void PointTree::setPieces(std::span<const Index> pieces) {
  pieces_ = pieces;
  uniform_.assign(2 * leaves_, kNoIndex);
  std::vector<std::uint8_t> empty(2 * leaves_, 1);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::size_t leaf = leaves_ + i / kLeafSize;
    const Index piece = pieces[order_[i]];
    uniform_[leaf] = empty[leaf] || uniform_[leaf] == piece ? piece : kNoIndex;
    empty[leaf] = 0;
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    const std::size_t left = 2 * node, right = left + 1;
    empty[node] = empty[left] && empty[right];
    uniform_[node] = empty[right] || uniform_[left] == uniform_[right] ? uniform_[left] : kNoIndex;
  }
}

std::vector<float> PointTree::largestOf(std::span<const float> values) const {
  std::vector<float> largest(2 * leaves_, 0);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    float& leaf = largest[leaves_ + i / kLeafSize];
    leaf = std::max(leaf, values[order_[i]]);
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    largest[node] = std::max(largest[2 * node], largest[2 * node + 1]);
  }
  return largest;
}

}  // namespace limber
