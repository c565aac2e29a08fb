#include "limber/rigging/figure/figure_steps.h"

#include <algorithm>
#include <array>

#include "limber/rigging/figure/steady.h"

namespace limber {

namespace {

constexpr double kMaxScale = 1.4, kMinScale = 0.7, kMaxShift = 0.05;  // of bones; statures of shoulders
constexpr double kMaxNeck = 0.09, kMinNeck = 0.01;                    // statures
constexpr double kSmallest = 0.15;                                    // step that is worth to be tried

Vec3 randomStep(Random& random, double size) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return size * Vec3(x, y, z);
}

Mat3 randomTurn(Random& random, double angle) {
  return turnBy(randomStep(random, angle));
}

void turnLimb(FigureLimb& bones, const Mat3& turn) {
  bones.upper = turn * bones.upper;
  bones.lower = turn * bones.lower;
  bones.end = turn * bones.end;
}

// Brings elbow or knee to `middle` and wrist or ankle to `ankle`, as far as bones can be as long.
void reach(Figure& figure, int limb, const Vec3& middle, const Vec3& ankle) {
  FigureLimb& bones = figure.limbs[limb];
  const auto scaleFor = [&](const Vec3& displacement, double length) {
    return std::clamp(displacement.norm() / (length * figure.stature), kMinScale, kMaxScale);
  };
  const Vec3 upper = middle - figure.positions(limb).root;
  bones.upper = upper.normalized();
  bones.upperScale = scaleFor(upper, upperLength(limb));
  const Vec3 lower = ankle - figure.positions(limb).middle;
  bones.lower = lower.normalized();
  bones.lowerScale = scaleFor(lower, lowerLength(limb));
  if (!isLeg(limb)) bones.end = bones.lower;
}

void changeTrunk(Figure& figure, double size, Random& random) {
  const double angle = 0.22 * size;
  switch (random.below(7)) {
    case 0:
      figure.head += randomStep(random, 0.02 * size * figure.stature);
      break;
    case 1:
      figure.headRadius *= ratioFor(0.05 * size * random.normal());
      break;
    case 2:
      figure.stature *= ratioFor(0.05 * size * random.normal());
      break;
    case 3:
      figure.neckLength = std::clamp(figure.neckLength + 0.01 * size * random.normal(), kMinNeck, kMaxNeck);
      break;
    case 4:
      figure.neck = randomTurn(random, angle) * figure.neck;
      break;
    case 5: {
      const Mat3 turn = randomTurn(random, angle);
      figure.chest = turn * figure.chest;
      if (random.below(2) == 0) break;
      for (const int arm : {0, 1}) turnLimb(figure.limbs[arm], turn);
      break;
    }
    default:
      figure.pelvis = randomTurn(random, angle) * figure.pelvis;
  }
}

}  // namespace

bool StepSize::failed() {
  if (++failures_ <= patience_) return true;
  failures_ = 0;
  value_ *= factor_;
  return value_ >= kSmallest;
}

void stepLimb(Figure& figure, int limb, double size, Random& random) {
  FigureLimb& bones = figure.limbs[limb];
  const double angle = 0.25 * size;
  switch (random.below(6)) {
    case 0:
      bones.upper = randomTurn(random, angle) * bones.upper;
      break;
    case 1: {
      const Mat3 turn = randomTurn(random, angle);
      bones.lower = turn * bones.lower;
      bones.end = turn * bones.end;
      break;
    }
    case 2:
      turnLimb(bones, randomTurn(random, angle));
      break;
    case 3: {  // elbow or knee moves, wrist or ankle stays about where it is
      const LimbPositions positions = figure.positions(limb);
      const Vec3 middle = positions.middle + randomStep(random, 0.03 * size * figure.stature);
      bones.upper = (middle - positions.root).normalized();
      bones.lower = (positions.ankle - middle).normalized();
      break;
    }
    case 4: {
      double& scale = random.below(2) == 0 ? bones.upperScale : bones.lowerScale;
      scale = std::clamp(scale * ratioFor(0.06 * size * random.normal()), kMinScale, kMaxScale);
      break;
    }
    default:
      if (isLeg(limb)) {
        bones.end = randomTurn(random, 1.5 * angle) * bones.end;
      } else {
        const Vec3 shift = bones.shift + randomStep(random, 0.012 * size);
        if (shift.norm() >= kMaxShift) break;
        const LimbPositions before = figure.positions(limb);
        bones.shift = shift;
        if (random.below(2) == 0) reach(figure, limb, before.middle, before.ankle);
      }
  }
  if (!isLeg(limb)) bones.end = bones.lower;
}

void stepTrunk(Figure& figure, double size, Random& random) {
  const bool limbsStay = random.below(10) < 7;
  std::array<LimbPositions, kFigureLimbs> before;
  for (int limb = 0; limb < kFigureLimbs; ++limb) before[limb] = figure.positions(limb);
  changeTrunk(figure, size, random);
  for (int limb = 0; limbsStay && limb < kFigureLimbs; ++limb) {
    reach(figure, limb, before[limb].middle, before[limb].ankle);
  }
}

Figure turnedAround(Figure figure) {
  for (Mat3* axes : {&figure.chest, &figure.pelvis}) {
    axes->col(0) *= -1;
    axes->col(2) *= -1;
  }
  std::swap(figure.limbs[0], figure.limbs[1]);
  std::swap(figure.limbs[2], figure.limbs[3]);
  for (int limb = 0; limb < kFigureLimbs; ++limb) {
    FigureLimb& bones = figure.limbs[limb];
    bones.shift = Vec3(-bones.shift.x(), bones.shift.y(), -bones.shift.z());
    if (isLeg(limb)) bones.end = toesForward(figure, limb).normalized();
    if (limbAllowed(figure, limb)) continue;
    const LimbPositions positions = figure.positions(limb);
    bones.upper = bones.lower = (positions.ankle - positions.root).normalized();
    bones.end = isLeg(limb) ? toesForward(figure, limb).normalized() : bones.lower;
  }
  return figure;
}

}  // namespace limber
