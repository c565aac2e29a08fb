#include "limber/rigging/shape/plan_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr PlanKind kKinds[] = {
    {"dinosaur", "an animal on two legs with a long tail", BodyPlan::kTwoLegs, 1, 1},
    {"crawler", "a low animal on four legs, as lizards and tortoises", BodyPlan::kFourLegs, 2, 2},
    {"dragon", "a winged animal on four legs, or on two with a long tail", BodyPlan::kFourLegs, 1, 2, true},
    {"insect", "an animal on six legs", BodyPlan::kManyLegs, 3, 3},
    {"spider", "an animal on eight legs and more", BodyPlan::kManyLegs, 4, 16},
    {"fish", "a fish or whale, with fins where it has some", BodyPlan::kSwimming, 0, 16},
    {"serpent", "a snake or worm: a chain of 12 joints", BodyPlan::kCrawling, 0, 16},
};

constexpr double kLow = 0.16, kHigh = 0.2;  // of the trunk's length that the hips are up: crawlers, and others
constexpr double kShortTail = 0.12;         // of the trunk's length behind the hips: no tail
constexpr double kShortestFront = 0.2;      // of the trunk's length before the hips: so that no bone has no length
constexpr double kEvenSegments = 0.1;       // weight of equal lengths against following the curve

class PlanBuilder {
 public:
  PlanBuilder(const PlanKind& kind, const ShapeReading& reading) : kind_(kind), reading_(reading) {
    fit_.skeleton.name = std::string(kind.name);
    fit_.skeleton.summary = std::string(kind.summary);
    fit_.frame = reading.frame;
  }

  TemplateFit build() {
    switch (kind_.plan) {
      case BodyPlan::kSwimming:
        swim();
        break;
      case BodyPlan::kCrawling:
        crawl();
        break;
      default:
        walk();
    }
    fit_.pins.resize(fit_.skeleton.joints.size());
    fit_.embedding.costs.assign(fit_.skeleton.joints.size(), 0.0);
    fit_.limbs = limbChains(fit_.skeleton);
    return std::move(fit_);
  }

 private:
  Vec3 trunkAt(double along) const {
    const std::vector<double>& distances = reading_.along;
    const auto after = std::lower_bound(distances.begin(), distances.end(), along);
    if (after == distances.begin()) return reading_.trunk().points.front().position;
    if (after == distances.end()) return reading_.trunk().end();
    const auto p = static_cast<std::size_t>(after - distances.begin());
    const Vec3 &a = reading_.trunk().points[p - 1].position, &b = reading_.trunk().points[p].position;
    return a + (along - distances[p - 1]) / std::max(distances[p] - distances[p - 1], 1e-12) * (b - a);
  }

  Index add(const std::string& name, std::optional<Index> parent, const Vec3& position, bool isTip = false) {
    TemplateJoint joint;
    joint.name = name;
    joint.parent = parent;
    joint.position = position / reading_.frame.height;
    joint.role = isTip ? TemplateRole::kTip : TemplateRole::kPlaced;
    fit_.embedding.positions.push_back(joint.position);
    fit_.skeleton.joints.push_back(std::move(joint));
    return fit_.skeleton.jointCount() - 1;
  }

  // Joints of that name along the trunk; the last.
  Index addAlong(std::string_view name, Index parent, std::initializer_list<double> along) {
    std::size_t number = 0;
    for (const double at : along) {
      parent = add(number == 0 ? std::string(name) : fmt::format("{}{}", name, number), parent, trunkAt(at));
      ++number;
    }
    return parent;
  }
  void addTip(Index parent, double along) {
    add(fit_.skeleton.joints[parent].name + "Tip", parent, trunkAt(along), true);
  }

  // On both sides; names without the side.
  template <std::size_t N>
  void addLimb(Index parent, const std::array<std::string, N>& names, const std::array<Vec3, N + 1>& positions) {
    std::array<std::array<Index, N + 1>, 2> joints;
    for (const std::size_t side : {0u, 1u}) {
      Index above = parent;
      for (std::size_t i = 0; i <= N; ++i) {
        const std::string name = (side == 0 ? "left" : "right") + (i < N ? names[i] : names[N - 1] + "Tip");
        const Vec3 position = side == 0 ? positions[i] : Vec3(positions[i].cwiseProduct(Vec3(-1, 1, 1)));
        above = joints[side][i] = add(name, above, position, i == N);
      }
    }
    for (std::size_t i = 0; i <= N; ++i) {
      fit_.skeleton.joints[joints[0][i]].mirror = joints[1][i];
      fit_.skeleton.joints[joints[1][i]].mirror = joints[0][i];
    }
  }

  // A limb in three bones from its root: two bends where three straight bones follow it best.
  std::array<Vec3, 4> bonesOf(const PairedLimb& limb) const {
    const std::vector<BodyCurve::Point>& points = reading_.curves[limb.curve].points;
    std::vector<Vec3> positions;
    for (std::size_t p = 1; p < points.size(); ++p) positions.push_back(points[p].position);
    positions.insert(positions.begin(), reading_.curves[limb.curve].root());
    while (positions.size() < 4)
      positions.insert(positions.end() - 1, 0.5 * (positions[positions.size() - 2] + positions.back()));
    const std::size_t last = positions.size() - 1;
    std::array<std::size_t, 2> bends = {1, 2};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i + 1 < last; ++i) {
      for (std::size_t j = i + 1; j < last; ++j) {
        const double cost = strayed(positions, 0, i) + strayed(positions, i, j) + strayed(positions, j, last) +
                            uneven({(positions[i] - positions[0]).norm(), (positions[j] - positions[i]).norm(),
                                    (positions[last] - positions[j]).norm()});
        if (cost >= least) continue;
        least = cost;
        bends = {i, j};
      }
    }
    return {positions[0], positions[bends[0]], positions[bends[1]], positions[last]};
  }

  // Squared distances to the straight bone from one position to another.
  static double strayed(const std::vector<Vec3>& positions, std::size_t from, std::size_t to) {
    double sum = 0;
    for (std::size_t p = from + 1; p < to; ++p) {
      const double far = distanceToBone(positions[p], positions[from], positions[to]);
      sum += far * far;
    }
    return sum;
  }
  static double uneven(const std::array<double, 3>& lengths) {
    const double mean = (lengths[0] + lengths[1] + lengths[2]) / 3;
    double sum = 0;
    for (const double length : lengths) sum += (length - mean) * (length - mean);
    return kEvenSegments * sum;
  }

  void walk() {
    const std::vector<PairedLimb> legs = reading_.legs();
    const double hind = std::max(reading_.along[legs.back().at], kShortestFront);
    const std::optional<PairedLimb> wings = reading_.wings();
    std::optional<PairedLimb> arms = wings;
    if (!arms && kind_.plan == BodyPlan::kTwoLegs) arms = armsBefore(hind);
    double fore = 0.5 * hind;
    if (legs.size() > 1) {
      fore = reading_.along[legs.front().at];
    } else if (arms) {
      fore = reading_.along[arms->at];
    }
    fore = std::clamp(fore, 0.5 * kShortestFront, 0.9 * hind);
    const Index hips = add("hips", {}, trunkAt(hind));
    const Index spine = add("spine", hips, trunkAt(0.5 * (hind + fore)));
    const Index chest = add("chest", spine, trunkAt(fore));
    const Index head = addAlong("head", addAlong("neck", chest, {0.6 * fore}), {0.3 * fore});
    addTip(head, 0);
    if (1 - hind > kShortTail) {
      const auto behind = [&](double part) { return hind + part * (1 - hind); };
      addTip(addAlong("tail", hips, {behind(0.25), behind(0.5), behind(0.75)}), 1);
    }
    if (arms) {
      addLimb<3>(chest,
                 wings ? std::array<std::string, 3>{"UpperWing", "LowerWing", "WingHand"}
                       : std::array<std::string, 3>{"UpperArm", "LowerArm", "Hand"},
                 bonesOf(*arms));
    }
    for (std::size_t pair = 0; pair < legs.size(); ++pair) {
      const double at = reading_.along[legs[pair].at];
      const Index carrier = std::abs(at - hind) < std::abs(at - fore) || legs.size() == 1 ? hips : chest;
      std::array<std::string, 3> names = {"UpperLeg", "LowerLeg", "Foot"};
      for (std::string& name : names) {
        if (legs.size() == 2) name.insert(0, pair == 0 ? "Front" : "Hind");
        if (legs.size() > 2 && pair > 0) name += std::to_string(pair);
      }
      addLimb<3>(carrier, names, bonesOf(legs[pair]));
    }
  }

  // The longest pair of limbs before the hips that are no legs, and nothing at the head.
  std::optional<PairedLimb> armsBefore(double hips) const {
    std::optional<PairedLimb> arms;
    for (const PairedLimb& limb : reading_.limbs) {
      const double at = reading_.along[limb.at], length = reading_.curves[limb.curve].length;
      if (limb.isLeg || at < kHeadFraction || at > hips) continue;
      if (!arms || length > reading_.curves[arms->curve].length) arms = limb;
    }
    return arms;
  }

  // The root is before the middle, as artists have it: head and tail are told apart by what hangs there.
  void swim() {
    const Index chest = add("chest", {}, trunkAt(0.3));
    addTip(addAlong("head", chest, {0.15}), 0);
    const Index tail = addAlong("tail", addAlong("spine", chest, {0.42}), {0.56, 0.7, 0.84});
    addTip(tail, 1);
    std::size_t number = 0;
    for (const PairedLimb& limb : reading_.limbs) {
      if (number == 2) break;
      const BodyCurve& curve = reading_.curves[limb.curve];
      const Vec3 root = curve.points[1].position;
      addLimb<1>(reading_.along[limb.at] < 0.5 ? chest : tail,
                 {number == 0 ? std::string("Fin") : fmt::format("Fin{}", number)}, {root, curve.end()});
      ++number;
    }
  }

  void crawl() {
    const Index chest = add("chest", {}, trunkAt(0.19));
    addTip(addAlong("head", addAlong("neck", chest, {0.12}), {0.06}), 0);
    addTip(addAlong("tail", addAlong("spine", chest, {0.26, 0.34, 0.42, 0.5}), {0.58, 0.66, 0.74, 0.82, 0.9}), 1);
  }

  const PlanKind& kind_;
  const ShapeReading& reading_;
  TemplateFit fit_;
};

}  // namespace

std::span<const PlanKind> planKinds() {
  return kKinds;
}

const PlanKind* findPlanKind(std::string_view name) {
  const auto found =
      std::find_if(std::begin(kKinds), std::end(kKinds), [&](const PlanKind& k) { return k.name == name; });
  return found == std::end(kKinds) ? nullptr : &*found;
}

double likelihood(const PlanKind& kind, const ShapeReading& reading) {
  const std::vector<PairedLimb> legs = reading.legs();
  const bool isOfPlan = kind.plan == reading.plan || (kind.hasWings && reading.plan == BodyPlan::kTwoLegs);
  const bool mayHaveWings = kind.hasWings || (kind.plan != BodyPlan::kTwoLegs && kind.plan != BodyPlan::kFourLegs);
  if (!isOfPlan || (kind.hasWings && !reading.wings()) || (!mayHaveWings && reading.wings())) return 0;
  if (legs.size() < kind.fewestLegs || legs.size() > kind.maxLegs) return 0;
  if (kind.hasWings || kind.plan != BodyPlan::kFourLegs) return reading.confidence;
  const double up = reading.trunk().points[legs.back().at].position.y() / reading.trunk().length;
  return reading.confidence * std::clamp((kHigh - up) / (kHigh - kLow), 0.0, 1.0);
}

TemplateFit fitPlan(const PlanKind& kind, const ShapeReading& reading) {
  const std::size_t legs = reading.legs().size();
  if (legs < kind.fewestLegs || legs > kind.maxLegs) {
    throw Error(ErrorCode::kUnsupported,
                fmt::format("needs {}{} pairs of legs, and the model has {}", kind.fewestLegs,
                            kind.maxLegs > kind.fewestLegs ? fmt::format(" to {}", kind.maxLegs) : "", legs),
                std::string(kind.name), "`template: auto` takes what suits the model");
  }
  return PlanBuilder(kind, reading).build();
}

}  // namespace limber
