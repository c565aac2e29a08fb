#include "limber/rigging/figure/figure_match.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/rigging/figure/limb_overlap.h"
#include "limber/rigging/figure/steady.h"

namespace limber {

namespace {

// The surface is looked for between these parts of a radius, and taken for there as softly as this one.
constexpr double kInner = 0.65, kOuter = 1.45, kSoft = 0.18;
constexpr double kHiddenCost = 0.35;  // of limbs: they are in the open rather than in what is thicker than they are

constexpr double kHeadWeight = 1.2, kChestWeight = 1.2, kPelvisWeight = 1, kNeckWeight = 0.5;
constexpr double kShoulderRadius = 0.038, kShoulderWeight = 0.12;
constexpr double kHeadSpread = 0.12, kHeadCost = 0.15;      // of the head's size against the stature's, logarithmic
constexpr double kNeckSpread = 0.02, kNeckCost = 0.1;       // of the neck's length, statures
constexpr double kLengthSpread = 0.12, kLengthCost = 0.08;  // of bones' lengths, logarithmic
constexpr double kShiftSpread = 0.025, kShiftCost = 0.12;   // of shoulders, statures
constexpr double kNod = 0.25, kBow = 0.3, kTwist = 0.15;    // of a head, a trunk turned by a right angle
constexpr double kInTrunk = 0.5;                            // for each position on a limb inside the trunk
constexpr double kInGround = 0.2, kGroundDepth = 0.03;      // for each position on a limb; statures, fully in it
constexpr double kRootDepth = 0.025, kShallowRoot = 0.3;    // statures that shoulders and hips lie deep, at least
constexpr double kTurnedArm = 0.15;                         // of an elbow that bends square to its relaxed direction
constexpr double kPinCost = 8, kFarFromPin = 0.25;          // statures from a pin, where it costs most
constexpr double kShared = 0.175;                           // for each position where limbs overlap

struct LimbShape {
  std::array<double, 2> upperRadii, lowerRadii;  // statures, at the beginning and the end of a bone
  std::array<double, 2> upperPart, lowerPart;    // of the bones that is looked at: joints are hidden
  int lowerRings;
  LimbWeights weights;
  double raised;  // cost of an upper bone that points up rather than down, halved
};
constexpr LimbShape kArm = {{0.03, 0.025}, {0.026, 0.018}, {0.35, 0.9}, {0.12, 0.95}, 4, {0.7, 0.8, 0.25}, 0.08};
constexpr LimbShape kLeg = {{0.052, 0.036}, {0.036, 0.02}, {0.4, 0.9}, {0.12, 0.92}, 4, {0.6, 1.5, 0.5}, 0.02};
constexpr int kUpperRings = 3;

const LimbShape& shapeOf(int limb) {
  return isLeg(limb) ? kLeg : kArm;
}

double squared(double x) {
  return x * x;
}

// Cosine and sine of `count` even angles, the first `from` steps on.
std::vector<std::array<double, 2>> circle(int count, double from) {
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < count; ++i) {
    const SteadyAngle angle(2 * kPi * (i + from) / count);
    points.push_back({angle.cos, angle.sin});
  }
  return points;
}

}  // namespace

std::vector<Vec3> evenDirections(int count) {
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - 2 * (i + 0.5) / count, around = std::sqrt(1 - y * y);
    const SteadyAngle angle(i * kGoldenAngle);
    directions.push_back(Vec3(around * angle.cos, y, around * angle.sin).normalized());
  }
  return directions;
}

Vec3 positionOf(const Figure& figure, const FigurePin& pin) {
  switch (pin.joint) {
    case FigurePin::Joint::kHead:
      return figure.skullBase();
    case FigurePin::Joint::kNeck:
      return figure.neckJoint();
    case FigurePin::Joint::kHips:
      return figure.pelvisJoint();
    case FigurePin::Joint::kRoot:
      return figure.positions(pin.limb).root;
    case FigurePin::Joint::kMiddle:
      return figure.positions(pin.limb).middle;
    case FigurePin::Joint::kAnkle:
      return figure.positions(pin.limb).ankle;
    case FigurePin::Joint::kTip:
      break;
  }
  return figure.positions(pin.limb).tip;
}

FigureMatch::FigureMatch(const SignedDistance& distance, std::vector<FigurePin> pins,
                         std::optional<FigureGround> ground)
    : distance_(distance),
      pins_(std::move(pins)),
      ground_(ground),
      ball_(evenDirections(kBall)),
      oval_(circle(kOval, 0.5)) {
  const std::vector<std::array<double, 2>> ring = circle(kRing, 0);
  for (std::size_t i = 0; i < kRing; ++i) {
    ring_[0][i] = static_cast<float>(ring[i][0]);
    ring_[1][i] = static_cast<float>(ring[i][1]);
  }
}

double FigureMatch::costOf(const FigurePin& pin, const Figure& figure) const {
  const double off = (positionOf(figure, pin) - pin.position).norm() / (kFarFromPin * figure.stature);
  return kPinCost * std::min(1.0, off * off);
}

double FigureMatch::pinCost(const Figure& figure, int limb, bool upToMiddle) const {
  double cost = 0;
  for (const FigurePin& pin : pins_) {
    const bool ofLimb = pin.joint >= FigurePin::Joint::kRoot && pin.limb == limb;
    if (!ofLimb || (upToMiddle && pin.joint > FigurePin::Joint::kMiddle)) continue;
    cost += costOf(pin, figure);
  }
  return cost;
}

double FigureMatch::trunkPinCost(const Figure& figure) const {
  double cost = 0;
  for (const FigurePin& pin : pins_) {
    if (pin.joint >= FigurePin::Joint::kRoot) continue;
    cost += costOf(pin, figure);
  }
  return cost;
}

template <std::size_t N>
std::array<float, N> FigureMatch::answers(const Vec3& middle, const Spokes<N>& spokes, Hidden hidden) const {
  constexpr float kIn = static_cast<float>(kInner), kOut = static_cast<float>(kOuter);
  std::array<std::array<float, 2 * N>, 3> positions;
  for (int axis = 0; axis < 3; ++axis) {
    const float from = static_cast<float>(middle[axis]);
    for (std::size_t i = 0; i < N; ++i) {
      positions[axis][i] = from + kIn * spokes.directions[axis][i];
      positions[axis][N + i] = from + kOut * spokes.directions[axis][i];
    }
  }
  const std::array<float, 2 * N> distances = distance_.atEach(positions);
  const auto fractionOf = [](float x) {
    x = x > 0 ? x : 0;
    return x < 1 ? x : 1;
  };
  const float cost = hidden == Hidden::kCosts ? static_cast<float>(kHiddenCost) : 0;
  std::array<float, N> answers;
  for (std::size_t i = 0; i < N; ++i) {
    const float perSoft = 1 / (2 * static_cast<float>(kSoft) * spokes.radii[i]);
    const float inside = fractionOf(0.5f - distances[i] * perSoft),
                outside = fractionOf(0.5f + distances[N + i] * perSoft);
    answers[i] = inside * outside - (1 - inside) - cost * inside * (1 - outside);
  }
  return answers;
}

template <std::size_t N>
double FigureMatch::meanAnswer(const Vec3& middle, const Spokes<N>& spokes, Hidden hidden) const {
  float sum = 0;
  for (const float answer : answers(middle, spokes, hidden)) sum += answer;
  return sum / N;
}

double FigureMatch::answer(const Vec3& middle, const Vec3& direction, double radius) const {
  Spokes<1> spoke;
  spoke.set(0, radius * direction, radius);
  return answers(middle, spoke, Hidden::kFree)[0];
}

FigureMatch::Circle FigureMatch::circleRound(const Vec3& axis) const {
  const Vec3 x = axis.unitOrthogonal(), z = axis.cross(x);
  Circle circle;
  for (int i = 0; i < 3; ++i) {
    const float along = static_cast<float>(x[i]), across = static_cast<float>(z[i]);
    for (std::size_t p = 0; p < kRing; ++p) circle[i][p] = along * ring_[0][p] + across * ring_[1][p];
  }
  return circle;
}

double FigureMatch::ring(const Vec3& middle, const Circle& circle, double radius) const {
  Spokes<kRing> spokes = {circle, {}};
  const float size = static_cast<float>(radius);
  for (std::array<float, kRing>& directions : spokes.directions) {
    for (float& coordinate : directions) coordinate *= size;
  }
  spokes.radii.fill(size);
  return meanAnswer(middle, spokes, Hidden::kCosts);
}

double FigureMatch::bone(const Vec3& from, const Vec3& direction, double length, const std::array<double, 2>& radii,
                         const std::array<double, 2>& part, int rings) const {
  const Circle circle = circleRound(direction);
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double at = part[0] + (part[1] - part[0]) * i / (rings - 1);
    sum += ring(from + at * length * direction, circle, radii[0] + (radii[1] - radii[0]) * at);
  }
  return sum / rings;
}

double FigureMatch::oval(const Vec3& middle, const Mat3& axes, double halfWidth, double halfDepth) const {
  Spokes<kOval> spokes;
  for (std::size_t i = 0; i < kOval; ++i) {
    const Vec3 edge = halfWidth * oval_[i][0] * axes.col(0) + halfDepth * oval_[i][1] * axes.col(2);
    spokes.set(i, edge, edge.norm());
  }
  return meanAnswer(middle, spokes, Hidden::kFree);
}

double FigureMatch::head(const Vec3& middle, double radius) const {
  Spokes<kBall> spokes;
  for (std::size_t i = 0; i < kBall; ++i) spokes.set(i, radius * ball_[i], radius);
  return meanAnswer(middle, spokes, Hidden::kFree);
}

double FigureMatch::neck(const Figure& figure) const {
  const double down = 1.05 * figure.headRadius + 0.01 * figure.stature;
  return ring(figure.head + down * figure.neck, circleRound(figure.neck), proportions::kNeckRadius * figure.stature);
}

double FigureMatch::chest(const Figure& figure) const {
  struct Section {
    double down, halfWidth, halfDepth;  // parts of the thorax; statures
  };
  constexpr Section kSections[] = {{0.35, 0.085, 0.055}, {0.7, 0.082, 0.06}, {1, 0.075, 0.055}};
  const double size = figure.stature;
  const Vec3 up = figure.chest.col(1), front = figure.chest.col(2);
  double sections = 0;
  for (const Section& section : kSections) {
    const Vec3 middle = figure.neckBase() - section.down * proportions::kThorax * size * up;
    sections += oval(middle, figure.chest, section.halfWidth * size, section.halfDepth * size);
  }
  double shoulders = 0;
  for (const int limb : {0, 1}) {
    const Vec3 out = sideOf(limb) * figure.chest.col(0), position = figure.socket(limb);
    const double radius = kShoulderRadius * size;
    const Vec3 directions[] = {out, (out + up).normalized(), up, front, -front};
    Spokes<5> spokes;
    for (std::size_t i = 0; i < 5; ++i) spokes.set(i, radius * directions[i], radius);
    const std::array<float, 5> at = answers(position, spokes, Hidden::kFree);
    shoulders += at[0] + at[1] + at[2] + 0.5 * (at[3] + at[4]);
  }
  return sections / 3 + kShoulderWeight * shoulders + kNeckWeight * neck(figure);
}

double FigureMatch::trunk(const Figure& figure) const {
  const double size = figure.stature;
  const Vec3 waist = figure.waist(), down = -proportions::kLoins * size * figure.pelvis.col(1);
  const double pelvis = 0.5 * (oval(waist + 0.4 * down, figure.pelvis, 0.075 * size, 0.055 * size) +
                               oval(waist + 0.85 * down, figure.pelvis, 0.09 * size, 0.062 * size));
  const double headSize = ratioOff(figure.headRadius / (proportions::kHeadRadius * size)) / kHeadSpread;
  const double neckLength = (figure.neckLength - proportions::kNeckLength) / kNeckSpread;
  return kHeadWeight * head(figure.head, figure.headRadius) + kChestWeight * chest(figure) + kPelvisWeight * pelvis -
         kHeadCost * squared(headSize) - kNeckCost * squared(neckLength) - nodCost(figure) -
         kBow * (1 - figure.chest.col(1).dot(figure.pelvis.col(1))) -
         kTwist * (1 - figure.chest.col(0).dot(figure.pelvis.col(0))) - trunkPinCost(figure);
}

double FigureMatch::upper(const Figure& figure, int limb) const {
  const LimbShape& shape = shapeOf(limb);
  const LimbPositions positions = figure.positions(limb);
  const double size = figure.stature;
  return bone(positions.root, figure.limbs[limb].upper, figure.limbs[limb].upperScale * upperLength(limb) * size,
              {shape.upperRadii[0] * size, shape.upperRadii[1] * size}, shape.upperPart, kUpperRings);
}

double FigureMatch::lower(int limb, const Vec3& from, const Vec3& direction, double length, double stature) const {
  const LimbShape& shape = shapeOf(limb);
  return bone(from, direction, length, {shape.lowerRadii[0] * stature, shape.lowerRadii[1] * stature}, shape.lowerPart,
              shape.lowerRings);
}

double FigureMatch::foot(const Figure& figure, const Vec3& ankle, const Vec3& direction) const {
  const double size = figure.stature;
  const double along = bone(ankle + 0.03 * size * direction, direction, 0.11 * size, {0.024 * size, 0.017 * size},
                            {0.2, 0.9}, kUpperRings);
  return 0.7 * along + 0.3 * answer(ankle + 0.12 * size * direction, direction, 0.02 * size);
}

double FigureMatch::insideTrunk(const Figure& figure, const Vec3& position) const {
  const double size = figure.stature;
  const auto ellipsoid = [&](const Vec3& middle, const Mat3& axes) {
    return (axes.transpose() * (position - middle)).cwiseQuotient(size * Vec3(0.085, 0.07, 0.058)).norm();
  };
  const Vec3 neck = figure.neckBase(), up = figure.chest.col(1);
  double nearest = (position - figure.head).norm() / (0.98 * figure.headRadius);
  nearest = std::min(nearest, ellipsoid(neck - 0.06 * size * up, figure.chest));
  nearest = std::min(nearest, ellipsoid(neck - 0.14 * size * up, figure.chest));
  nearest = std::min(nearest, ellipsoid(figure.waist() - 0.1 * size * figure.pelvis.col(1), figure.pelvis));
  return std::clamp(1.15 - nearest, 0.0, 1.0);
}

double FigureMatch::inGround(const Figure& figure, const Vec3& position) const {
  if (!ground_) return 0;
  return std::clamp((ground_->height - position.dot(ground_->up)) / (kGroundDepth * figure.stature), 0.0, 1.0);
}

double FigureMatch::limb(const Figure& figure, int limb) const {
  const LimbShape& shape = shapeOf(limb);
  const FigureLimb& bones = figure.limbs[limb];
  const LimbPositions positions = figure.positions(limb);
  const double size = figure.stature;
  double end = 0;
  if (isLeg(limb)) {
    end = foot(figure, positions.ankle, bones.end);
  } else {
    end = 0.7 * ring(positions.ankle + 0.04 * size * bones.end, circleRound(bones.end), 0.02 * size) +
          0.3 * std::max(0.0, answer(positions.ankle + 0.06 * size * bones.end, bones.end, 0.03 * size));
  }
  const double lowerBone = bones.lowerScale * lowerLength(limb) * size;
  double sum = shape.weights.upper * upper(figure, limb) +
               shape.weights.lower * lower(limb, positions.middle, bones.lower, lowerBone, size) +
               shape.weights.end * end;
  double within = insideTrunk(figure, positions.tip), sunk = inGround(figure, positions.tip);
  for (const double at : {0.6, 1.0}) {
    const Vec3 position = positions.root + at * (positions.middle - positions.root);
    within += insideTrunk(figure, position);
    sunk += inGround(figure, position);
  }
  for (const double at : {0.25, 0.5, 0.75, 1.0}) {
    const Vec3 position = positions.middle + at * (positions.ankle - positions.middle);
    within += insideTrunk(figure, position);
    sunk += inGround(figure, position);
  }
  const double shallow = 1 + distance_.at(positions.root) / (kRootDepth * size);
  sum -= kInTrunk * within + kInGround * sunk + kShallowRoot * std::clamp(shallow, 0.0, 2.0) + strain(figure, limb) +
         pinCost(figure, limb);
  if (isLeg(limb)) return sum;
  const Vec3 bend = bones.lower - bones.upper.dot(bones.lower) * bones.upper;
  return sum - kTurnedArm * (bend.norm() - bend.dot(bendDirection(figure, limb, bones.upper)));
}

const LimbWeights& weightsOf(int limb) {
  return shapeOf(limb).weights;
}

double nodCost(const Figure& figure) {
  return kNod * (1 + figure.neck.dot(figure.chest.col(1)));
}

double strain(const Figure& figure, int limb) {
  const FigureLimb& bones = figure.limbs[limb];
  const double lengths =
      squared(ratioOff(bones.upperScale) / kLengthSpread) + squared(ratioOff(bones.lowerScale) / kLengthSpread);
  const double shift = bones.shift.squaredNorm() / squared(kShiftSpread);
  const double raised = 1 + bones.upper.dot(figure.trunkOf(limb).col(1));
  return kLengthCost * lengths + kShiftCost * shift + shapeOf(limb).raised * raised;
}

void sumUp(MatchedFigure& matched) {
  std::array<LimbSpace, kFigureLimbs> spaces;
  for (int limb = 0; limb < kFigureLimbs; ++limb) spaces[limb] = spaceOf(matched.figure, limb);
  matched.total = matched.trunk;
  for (const double limb : matched.limbs) matched.total += limb;
  for (int a = 0; a < kFigureLimbs; ++a) {
    for (int b = a + 1; b < kFigureLimbs; ++b) matched.total -= sharingCost(limbOverlap(spaces[a], spaces[b]));
  }
}

double sharingCost(double shared) {
  return kShared * shared;
}

MatchedFigure matched(const FigureMatch& match, const Figure& figure) {
  MatchedFigure result;
  result.figure = figure;
  result.trunk = match.trunk(figure);
  for (int limb = 0; limb < kFigureLimbs; ++limb) result.limbs[limb] = match.limb(figure, limb);
  sumUp(result);
  return result;
}

}  // namespace limber
