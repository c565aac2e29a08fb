#include "limber/adapters/space_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

// Of the model's longest side. Blender rounds positions to floats in other units, and programs that remove triangles
// move corners a little; axes and units differ by far more.
constexpr double kSameBox = 0.02;
// Joints of wings, skirts and tails may lie beside the surface; control joints a little farther.
constexpr double kJointsBeside = 0.25;
// A joint is about half a bone from the middle of what it moves: with the right axes that is all, with others limbs
// are where there are none.
constexpr double kClearlyNearer = 4;
constexpr std::size_t kFewestJoints = 3;  // that tell axes apart
// Of the longest offset: what texts with three digits round off and more; units and axes differ by far more.
constexpr double kSameOffset = 0.01;

constexpr std::string_view kAxes = "xyz";

bool isSameSize(const Vec3& a, const Vec3& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kSameBox * b.maxCoeff();
}

// The order of a's sides in which they are b's.
std::optional<std::array<int, 3>> swappedAxes(const Vec3& a, const Vec3& b) {
  std::array<int, 3> order = {0, 1, 2};
  while (std::next_permutation(order.begin(), order.end())) {
    if (isSameSize(Vec3(a[order[0]], a[order[1]], a[order[2]]), b)) return order;
  }
  return std::nullopt;
}

// A permutation of the axes with signs: `axis[i]` of what it is applied to becomes axis i.
struct AxisMap {
  std::array<int, 3> axis;
  Vec3 sign;

  Vec3 of(const Vec3& p) const { return Vec3(sign[0] * p[axis[0]], sign[1] * p[axis[1]], sign[2] * p[axis[2]]); }
  bool isIdentity() const { return axis == std::array<int, 3>{0, 1, 2} && sign == Vec3::Ones(); }
};

std::vector<AxisMap> allAxisMaps() {
  std::vector<AxisMap> maps;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      maps.push_back({order, Vec3(signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1)});
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return maps;
}

std::string axesText(const AxisMap& map) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("{}{}{}", i == 0 ? "" : ", ", map.sign[i] < 0 ? "-" : "", kAxes[map.axis[i]]);
  }
  return text;
}

struct Anchor {
  Vec3 joint, moved;  // where it is, and the middle of what it moves
};

std::vector<Anchor> anchorsOf(const Skeleton& skeleton, const TriMesh& surface, const SkinWeights& weights) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<Vec3> sum(globals.size(), Vec3::Zero());
  std::vector<double> total(globals.size(), 0);
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const double weight = weights.weightsOf(v)[slot];
      sum[weights.jointsOf(v)[slot]] += weight * surface.position(v);
      total[weights.jointsOf(v)[slot]] += weight;
    }
  }
  std::vector<Anchor> anchors;
  for (std::size_t j = 0; j < globals.size(); ++j) {
    if (total[j] > 0) anchors.push_back({globals[j].translation(), sum[j] / total[j]});
  }
  return anchors;
}

double squaredDistance(const std::vector<Anchor>& anchors, const AxisMap& map) {
  double sum = 0;
  for (const Anchor& anchor : anchors) sum += (map.of(anchor.joint) - anchor.moved).squaredNorm();
  return sum;
}

void checkAxes(const std::vector<Anchor>& anchors, const std::string& where) {
  if (anchors.size() < kFewestJoints) return;
  double asItIs = 0, least = 0;
  std::optional<AxisMap> nearest;
  for (const AxisMap& map : allAxisMaps()) {
    const double distance = squaredDistance(anchors, map);
    if (map.isIdentity()) asItIs = distance;
    if (!nearest || distance < least) {
      nearest = map;
      least = distance;
    }
  }
  if (asItIs <= kClearlyNearer * least || nearest->isIdentity()) return;
  throw Error(ErrorCode::kBadData,
              fmt::format("the joints lie in swapped axes: the model's x, y, z are its {}", axesText(*nearest)), where,
              "set \"up\" in the adapter's \"output\" (or \"input\")");
}

// The joint that is farthest off when the returned offsets are mapped and scaled, and by how much.
std::pair<std::size_t, double> worstOffset(const std::vector<JointOffset>& offsets, const AxisMap& map, double scale) {
  std::pair<std::size_t, double> worst = {0, 0};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double apart = (scale * map.of(offsets[i].returned) - offsets[i].own).norm();
    if (!(apart <= worst.second)) worst = {i, apart};
  }
  return worst;
}

}  // namespace

void checkSameBox(const Box& returned, const Box& own, const std::string& where) {
  const Vec3 a = returned.size(), b = own.size();
  const double scale = a.maxCoeff() / b.maxCoeff();
  if (isSameSize(a, b)) {
    const double apart = (returned.center() - own.center()).norm();
    if (apart <= kSameBox * b.maxCoeff()) return;
    throw Error(
        ErrorCode::kBadData,
        fmt::format("the surface lies {:.3g} times the model's longest side from where it was", apart / b.maxCoeff()),
        where, "set \"may_rescale\": true in the adapter's \"output\" where the program moves what it is given");
  }
  if (scale > 0 && isSameSize(a / scale, b)) {
    throw Error(ErrorCode::kBadData, fmt::format("the surface is {:.4g} times as large as what was handed over", scale),
                where, "set \"may_rescale\": true in the adapter's \"output\"");
  }
  if (const auto order = scale > 0 ? swappedAxes(a / scale, b) : std::nullopt) {
    throw Error(ErrorCode::kBadData,
                fmt::format("the surface has its axes swapped: the model's x, y, z are its {}, {}, {}",
                            kAxes[(*order)[0]], kAxes[(*order)[1]], kAxes[(*order)[2]]),
                where, "set \"up\" in the adapter's \"output\" (or \"input\")");
  }
  throw Error(
      ErrorCode::kBadData,
      fmt::format("the surface is not the model's: {:.3g} x {:.3g} x {:.3g} in place of {:.3g} x {:.3g} x {:.3g}",
                  a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
      where);
}

void checkJointSpace(const Skeleton& skeleton, const TriMesh& surface, const SkinWeights* weights,
                     const std::string& where) {
  if (weights != nullptr) checkAxes(anchorsOf(skeleton, surface, *weights), where);
  const Box box = surfaceBox(surface);
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (std::size_t j = 0; j < globals.size(); ++j) {
    const Vec3 position = globals[j].translation();
    const double outside = (position - position.cwiseMax(box.min).cwiseMin(box.max)).norm() / box.longestSide();
    if (outside <= kJointsBeside) continue;
    throw Error(ErrorCode::kBadData,
                fmt::format("the joint '{}' lies outside the model, by {:.3g} of its longest side",
                            skeleton.joints[j].name, outside),
                where, "the program has another unit, or other axes: set \"size\" or \"up\" in the adapter");
  }
}

void checkSameOffsets(const std::vector<JointOffset>& offsets, const std::string& where) {
  const AxisMap same{{0, 1, 2}, Vec3::Ones()};
  double longest = 0, own = 0, returned = 0;
  for (const JointOffset& offset : offsets) {
    longest = std::max(longest, offset.own.norm());
    own += offset.own.norm();
    returned += offset.returned.norm();
  }
  const auto [worst, apart] = worstOffset(offsets, same, 1);
  if (apart <= kSameOffset * longest) return;
  const double larger = own > 0 ? returned / own : 0;
  const bool isSameLength = std::abs(larger - 1) <= kSameOffset;
  for (const AxisMap& map : allAxisMaps()) {
    if (!(larger > 0) || worstOffset(offsets, map, 1 / larger).second > kSameOffset * longest) continue;
    const std::string axes =
        map.isIdentity() ? "" : fmt::format("in swapped axes: the character's x, y, z are its {}", axesText(map));
    if (isSameLength) {
      throw Error(ErrorCode::kBadData, "the skeleton stands " + axes, where,
                  "set \"up\" in the adapter's \"output\" (or \"input\")");
    }
    throw Error(ErrorCode::kBadData,
                fmt::format("the skeleton is {:.4g} times as large as what was handed over{}{}", larger,
                            axes.empty() ? "" : ", and ", axes),
                where, "set \"metres_per_unit\" in the adapter's \"output\"");
  }
  const Vec3 &a = offsets[worst].returned, &b = offsets[worst].own;
  throw Error(ErrorCode::kBadData,
              fmt::format("the joint '{}' has another offset: {:.4g} {:.4g} {:.4g} in place of {:.4g} {:.4g} {:.4g}",
                          offsets[worst].name, a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
              where, "the program must keep the skeleton that it is given");
}

}  // namespace limber
