#include "limber/rigging/shape/shape_reading.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

// What speaks for a reading: nothing at `bad`, all at `good`, in between in proportion. Set on the split `tune` and the
// earlier shared models; lengths are in longest sides of the model.
struct Margin {
  double bad, good;
  double of(double value) const { return std::clamp((value - bad) / (good - bad), 0.0, 1.0); }
};
// Of a leg.
constexpr Margin kOnGround = {0.13, 0.07};   // height of its lowest point
constexpr Margin kRound = {3.2, 2.4};        // times as wide as thick
constexpr Margin kSolid = {0.005, 0.008};    // mean radius: what is one grid cell thick may be a sheet
constexpr Margin kSticksOut = {0.65, 1.15};  // length, in radii of the trunk where it hangs
constexpr Margin kComesDown = {0.5, 0.8};    // of the height where it hangs, how far down it reaches
constexpr Margin kLegLength = {0.08, 0.15};  // length
// Of a trunk.
constexpr Margin kUpright = {0.5, 0.9};        // cosine between the up of the frame and that of the anatomy
constexpr Margin kLevelOnFour = {0.5, 0.8};    // cosine to the level: on four legs
constexpr Margin kLevelOnTwo = {0.6, 0.85};    // on two
constexpr Margin kLevelAfloat = {0.85, 0.95};  // swimming
constexpr Margin kLegsApart = {0.05, 0.15};    // of its length between two pairs of legs
constexpr Margin kLegsLow = {0.6, 0.75};       // of its length from the head to the legs: upright
constexpr Margin kRises = {0.6, 0.85};         // cosine to the up, from the legs to the head: upright
constexpr Margin kLeansOver = {0.95, 0.8};     // the same: trunk across
constexpr Margin kTail = {0.15, 0.3};          // of its length behind the legs
constexpr Margin kOverFeet = {0.2, 0.12};      // of its length between its mass and the feet
constexpr Margin kSlenderOnTwo = {3, 4.5};     // times as long as thick: with a long tail
constexpr Margin kSlenderFish = {2, 3}, kThickFish = {7.5, 6.5}, kSlenderSnake = {6.5, 7.5};  // likewise
constexpr Margin kFewFins = {1.3, 0.9};   // length of all that hangs on it, over its own: swimming
constexpr Margin kNoLimbs = {0.5, 0.25};  // of paired limbs, likewise: crawling

constexpr double kThinnest = 0.0025;   // mean radius of what is no part, but hair or a crease
constexpr double kShortest = 0.1;      // of a part
constexpr double kSameEnd = 0.08;      // between the ends of two curves in one and the same part
constexpr double kLongLeg = 0.25;      // of a leg that does not reach the ground
constexpr double kLooksLikeLeg = 0.8;  // probability that such are legs where there are three pairs
constexpr double kArm = 0.2;           // of arms at least
constexpr double kWing = 0.3;          // of wings at least
constexpr double kBeforeLegs = 0.1;    // of the trunk, that wings are before the front legs at most: not ears
constexpr double kArmless = 0.1;       // of the confidence that is left where no arms are seen: chicks, busts
constexpr double kUsualFront = 0.85;   // of files show the front: what speaks against it has to be surer
constexpr int kTrunkBones = 8;         // of the skeleton that is laid along the curves
constexpr double kThickest = 0.8;      // quantile of the trunk's radii that it is slender by
constexpr double kLimbParts[] = {0, 0.34, 0.67, 1};  // of a limb's length, where that skeleton has joints

Vec3 lowest(const BodyCurve& curve) {
  return std::min_element(curve.points.begin(), curve.points.end(),
                          [](const auto& a, const auto& b) { return a.position.y() < b.position.y(); })
      ->position;
}

double drop(const BodyCurve& curve) {
  return curve.points.front().position.y() - lowest(curve).y();
}

// Legs reach the ground, span most of the height down to it, and are no fins or sheets.
double legLikeness(const BodyCurve& curve) {
  const BodyCurve::Point& root = curve.points.front();
  return kOnGround.of(lowest(curve).y()) * kRound.of(curve.flatness()) * kSolid.of(curve.meanRadius()) *
         kSticksOut.of(curve.length / std::max(root.radius, 1e-9)) *
         kComesDown.of(drop(curve) / std::max(root.position.y(), 1e-9)) * kLegLength.of(curve.length);
}

// The position at `part` of the curve's length from its second point on: the first lies in the middle of its carrier.
Vec3 pointAlong(const BodyCurve& curve, double part) {
  double left = 0;
  for (std::size_t p = 2; p < curve.points.size(); ++p) {
    left += (curve.points[p].position - curve.points[p - 1].position).norm();
  }
  left *= part;
  for (std::size_t p = 2; p < curve.points.size(); ++p) {
    const Vec3 step = curve.points[p].position - curve.points[p - 1].position;
    if (left <= step.norm()) return curve.points[p - 1].position + left / std::max(step.norm(), 1e-12) * step;
    left -= step.norm();
  }
  return curve.end();
}

class ShapeReader {
 public:
  ShapeReader(const BodyVolume& body, const AnatomicalFrame& frame) {
    reading_.frame = frame;
    reading_.curves = bodyCurves(body, frame);
  }

  std::optional<ShapeReading> read(bool isFrontGiven) {
    if (reading_.curves.empty() || reading_.trunk().points.size() < 4) return {};
    layOutTrunk();
    findLimbs();
    laySkeleton();
    const Anatomy anatomy = readAnatomy(skeleton_, {false, {}});
    const bool isTurned = !isFrontGiven && anatomy.axes.front.z() < -0.5 && anatomy.confidence > kUsualFront;
    reading_.frame.isFrontRead = anatomy.confidence > kUsualFront;
    for (PairedLimb& limb : reading_.limbs) {
      const Index end = ends_[static_cast<std::size_t>(&limb - reading_.limbs.data())];
      if (const std::optional<std::size_t> part = anatomy.partOf[end]) limb.kind = anatomy.parts[*part].kind;
    }
    if (isTurned) turnAbout();
    headFirst();
    std::stable_sort(reading_.limbs.begin(), reading_.limbs.end(),
                     [](const PairedLimb& a, const PairedLimb& b) { return a.at < b.at; });
    findLegs();
    findPlan(anatomy);
    return std::move(reading_);
  }

 private:
  void layOutTrunk() {
    const std::vector<BodyCurve::Point>& points = reading_.trunk().points;
    reading_.along.assign(points.size(), 0.0);
    for (std::size_t p = 1; p < points.size(); ++p) {
      reading_.along[p] = reading_.along[p - 1] + (points[p].position - points[p - 1].position).norm();
    }
    for (double& pathLength : reading_.along) pathLength /= std::max(reading_.along.back(), 1e-12);
  }

  // Limbs that hang on the trunk, or on what goes off it between left and right, as legs that touch each other do.
  void findLimbs() {
    for (std::size_t c = 1; c < reading_.curves.size(); ++c) {
      const BodyCurve& curve = reading_.curves[c];
      const BodyCurve& carrier = reading_.curves[*curve.carrier];
      if (!curve.isPaired || carrier.isPaired) continue;
      if (curve.meanRadius() < kThinnest || curve.length < kShortest) continue;
      const auto isSame = [&](const PairedLimb& other) {
        return (reading_.curves[other.curve].end() - curve.end()).norm() < kSameEnd;
      };
      if (std::any_of(reading_.limbs.begin(), reading_.limbs.end(), isSame)) continue;
      PairedLimb limb;
      limb.curve = c;
      limb.at = curve.at;
      for (std::size_t on = *curve.carrier; on != 0; on = *reading_.curves[on].carrier)
        limb.at = reading_.curves[on].at;
      limb.legLike = legLikeness(curve);
      reading_.limbs.push_back(limb);
    }
  }

  Index addJoint(const Vec3& position, std::optional<Index> parent) {
    Joint joint;
    joint.parent = parent;
    joint.rest.translation = parent ? Vec3(position - positions_[*parent]) : position;
    positions_.push_back(position);
    skeleton_.joints.push_back(std::move(joint));
    return skeleton_.jointCount() - 1;
  }

  // As an artist might: the root where the body is thickest, few joints along the trunk, four along a limb.
  void laySkeleton() {
    const std::vector<BodyCurve::Point>& trunk = reading_.trunk().points;
    const auto thickest =
        std::max_element(trunk.begin(), trunk.end(), [](const auto& a, const auto& b) { return a.area < b.area; });
    const auto root = static_cast<std::size_t>(thickest - trunk.begin());
    std::vector<std::pair<std::size_t, Index>> along = {{root, addJoint(trunk[root].position, {})}};
    for (const bool ahead : {true, false}) {
      std::pair<std::size_t, Index> last = along.front();
      for (std::size_t p = root; ahead ? p + 1 < trunk.size() : p > 0;) {
        p = ahead ? p + 1 : p - 1;
        const bool isEnd = ahead ? p + 1 == trunk.size() : p == 0;
        const double step = std::abs(reading_.along[p] - reading_.along[last.first]);
        if (step < 1.0 / kTrunkBones && !isEnd) continue;
        last = {p, addJoint(trunk[p].position, last.second)};
        along.push_back(last);
      }
    }
    for (const PairedLimb& limb : reading_.limbs) {
      const auto nearest = std::min_element(along.begin(), along.end(), [&](const auto& a, const auto& b) {
        const double at = reading_.along[limb.at];
        return std::abs(reading_.along[a.first] - at) < std::abs(reading_.along[b.first] - at);
      });
      const BodyCurve& curve = reading_.curves[limb.curve];
      for (const double side : {1.0, -1.0}) {
        Index joint = nearest->second;
        for (const double part : kLimbParts) {
          Vec3 position = part == 0 ? curve.root() : pointAlong(curve, part);
          position.x() *= side;
          joint = addJoint(position, joint);
        }
        if (side > 0) ends_.push_back(joint);
      }
    }
  }

  // The front where the back was. Curves are the left side's as before: both sides are alike.
  void turnAbout() {
    reading_.frame.axes.row(0) *= -1;
    reading_.frame.axes.row(2) *= -1;
    for (BodyCurve& curve : reading_.curves) {
      for (BodyCurve::Point& point : curve.points) point.position.z() *= -1;
    }
  }

  // The head is in front, or on top.
  void headFirst() {
    const Vec3 first = reading_.trunk().points.front().position, last = reading_.trunk().end();
    if (first.y() + first.z() >= last.y() + last.z()) return;
    BodyCurve& trunk = reading_.curves.front();
    const std::size_t end = trunk.points.size() - 1;
    std::reverse(trunk.points.begin(), trunk.points.end());
    for (BodyCurve& curve : reading_.curves) {
      if (curve.carrier == 0) curve.at = end - curve.at;
    }
    for (PairedLimb& limb : reading_.limbs) limb.at = end - limb.at;
    std::reverse(reading_.along.begin(), reading_.along.end());
    for (double& pathLength : reading_.along) pathLength = 1 - pathLength;
  }

  // How many times as long as thick, by the thickness that a fifth of the trunk exceeds.
  double slenderness() const {
    std::vector<double> radii;
    for (const BodyCurve::Point& point : reading_.trunk().points) radii.push_back(std::sqrt(point.area / kPi));
    std::sort(radii.begin(), radii.end());
    return reading_.trunk().length /
           (2 * radii[static_cast<std::size_t>(kThickest * static_cast<double>(radii.size() - 1))]);
  }

  // Legs stand on the ground. Where none does, but three pairs look like legs, it flies or leaps.
  void findLegs() {
    std::size_t thin = 0;
    const auto isThinLeg = [&](const PairedLimb& limb) {
      const BodyCurve& curve = reading_.curves[limb.curve];
      return limb.kind == PartKind::kLeg && curve.flatness() < kRound.good && curve.length > kLongLeg;
    };
    for (PairedLimb& limb : reading_.limbs) {
      limb.isLeg = limb.legLike > 0.5;
      thin += isThinLeg(limb) ? 1 : 0;
    }
    if (!reading_.legs().empty() || thin < 3) return;
    for (PairedLimb& limb : reading_.limbs) limb.isLeg = isThinLeg(limb);
  }

  // What hangs on the trunk, over its length: limbs that are no legs, and what goes off it in the middle.
  struct Others {
    double limbs = 0, middle = 0;
  };
  Others othersThanLegs() const {
    Others others;
    const double length = reading_.trunk().length;
    for (const PairedLimb& limb : reading_.limbs) {
      if (!limb.isLeg) others.limbs += reading_.curves[limb.curve].length / length;
    }
    for (const BodyCurve& curve : reading_.curves) {
      if (curve.carrier && !curve.isPaired) others.middle += curve.length / length;
    }
    return others;
  }

  // How far along the trunk, ahead or behind, the feet are from below its mass.
  double offBalance(const PairedLimb& leg) const {
    double mass = 0, middle = 0;
    for (const BodyCurve::Point& point : reading_.trunk().points) {
      mass += point.area;
      middle += point.area * point.position.z();
    }
    const double foot = lowest(reading_.curves[leg.curve]).z();
    return std::abs(foot - middle / std::max(mass, 1e-12)) / reading_.trunk().length;
  }

  bool hasArms(const PairedLimb& leg) const {
    return std::any_of(reading_.limbs.begin(), reading_.limbs.end(), [&](const PairedLimb& limb) {
      return !limb.isLeg && limb.at < leg.at && reading_.along[limb.at] > kHeadFraction &&
             reading_.curves[limb.curve].length > kArm;
    });
  }

  void decide(BodyPlan plan, double confidence) {
    if (confidence <= reading_.confidence) return;
    reading_.plan = plan;
    reading_.confidence = confidence;
  }

  void findPlan(const Anatomy& anatomy) {
    const std::vector<PairedLimb> legs = reading_.legs();
    const Others others = othersThanLegs();
    const BodyCurve& trunk = reading_.trunk();
    const Vec3 pathLength = trunk.points.front().position - trunk.end();
    const double across = std::abs(pathLength.z()) / std::max(pathLength.norm(), 1e-9);
    const double slender = slenderness();
    // That its orientation is the assumed one, and that each limb is a leg or none.
    double counted = kUpright.of(anatomy.axes.up.y());
    for (const PairedLimb& limb : reading_.limbs) {
      // Of a leg that does not reach the ground its looks are all there is.
      counted *= !limb.isLeg ? 1 - limb.legLike : limb.legLike > 0.5 ? limb.legLike : kLooksLikeLeg;
    }
    if (legs.size() >= 3) {
      decide(BodyPlan::kManyLegs, counted);
    } else if (legs.size() == 2) {
      const double apart = reading_.along[legs[1].at] - reading_.along[legs[0].at];
      decide(BodyPlan::kFourLegs, counted * kLevelOnFour.of(across) * kLegsApart.of(apart));
    } else if (legs.size() == 1) {
      const double at = reading_.along[legs[0].at];
      const Vec3 ahead = trunk.points.front().position - trunk.points[legs[0].at].position;
      const double rises = ahead.y() / std::max(ahead.norm(), 1e-9);
      const double arms = hasArms(legs[0]) ? 1 : kArmless;
      decide(BodyPlan::kUpright, counted * arms * kLegsLow.of(at) * kRises.of(rises));
      decide(BodyPlan::kTwoLegs, counted * kLevelOnTwo.of(across) * kTail.of(1 - at) * kLeansOver.of(rises) *
                                     kSlenderOnTwo.of(slender) * kOverFeet.of(offBalance(legs[0])));
    } else {
      decide(BodyPlan::kSwimming, counted * kFewFins.of(others.limbs + others.middle) * kLevelAfloat.of(across) *
                                      kSlenderFish.of(slender) * kThickFish.of(slender));
      decide(BodyPlan::kCrawling, counted * kNoLimbs.of(others.limbs) * kSlenderSnake.of(slender));
    }
  }

  ShapeReading reading_;
  Skeleton skeleton_;            // along the curves, the mesh's unit
  std::vector<Vec3> positions_;  // of its joints
  std::vector<Index> ends_;      // by limb: the joint at its end
};

}  // namespace

std::vector<PairedLimb> ShapeReading::legs() const {
  std::vector<PairedLimb> legs;
  for (const PairedLimb& limb : limbs) {
    if (limb.isLeg) legs.push_back(limb);
  }
  return legs;
}

std::optional<PairedLimb> ShapeReading::wings() const {
  double foremost = kHeadFraction;
  if (plan == BodyPlan::kFourLegs) foremost = std::max(foremost, along[legs().front().at] - kBeforeLegs);
  std::optional<PairedLimb> wings;
  for (const PairedLimb& limb : limbs) {
    const BodyCurve& curve = curves[limb.curve];
    if (limb.isLeg || limb.kind == PartKind::kEar || along[limb.at] <= foremost) continue;
    if (curve.length <= kWing || curve.flatness() <= kBroadWing) continue;
    if (!wings || curve.length > curves[wings->curve].length) wings = limb;
  }
  return wings;
}

std::optional<ShapeReading> readShape(const BodyVolume& body, const std::vector<AnatomicalFrame>& frames,
                                      bool isFrontGiven) {
  const AnatomicalFrame* best = nullptr;
  const Vec3 up = frames.front().axes.row(1).transpose();
  for (const AnatomicalFrame& frame : frames) {
    if (frame.axes.row(1).dot(up.transpose()) < 0.99 || !frame.symmetric()) continue;
    if (!best || frame.asymmetry < best->asymmetry - 0.02) best = &frame;
  }
  if (!best) return {};
  return ShapeReader(body, *best).read(isFrontGiven);
}

}  // namespace limber
