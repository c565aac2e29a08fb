// Sample motions through key poses: jumping jack, jump, idle, wave, sit down. Angles in radians, positions in metres.
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/stances.h"

namespace limber {

namespace {

// Two jumps of a fifth of a second: apart with the arms up, and together.
std::span<const KeyPose> jumpingJackKeys() {
  constexpr double kTogether = 0.09, kBetween = 0.2, kApart = 0.32;
  const auto at = [](double height, const FootPose& foot, double raise, double bend) {
    return leaning(both({0, height, -0.02}, foot, {.raise = raise, .swing = 0.05, .elbow = 0.25}), 0, bend, 0);
  };
  static const std::vector<KeyPose> keys = {
      {0, at(0.815, planted(kTogether), 0.15, 0.06)},
      {0.1, at(0.825, planted(kTogether), 0.36, 0.05)},
      {0.2, at(0.855, planted(kTogether, -0.7), 0.78, 0), true},
      {0.3, at(0, lifted(kBetween, 0.045, -0.6), 1.4, 0), true},
      {0.4, at(0.83, planted(kApart, -0.55), 2.05, 0)},
      {0.5, at(0.80, planted(kApart), 2.52, 0.05)},
      {0.6, at(0.79, planted(kApart), 2.75, 0.06)},
      {0.7, at(0.80, planted(kApart), 2.52, 0.05)},
      {0.8, at(0.83, planted(kApart, -0.7), 2.1, 0), true},
      {0.9, at(0, lifted(kBetween, 0.045, -0.6), 1.5, 0), true},
      {1.0, at(0.855, planted(kTogether, -0.55), 0.85, 0)},
      {1.1, at(0.825, planted(kTogether), 0.38, 0.05)},
  };
  return keys;
}

// Straight up by a fifth of a metre: 0.4 seconds in the air.
std::span<const KeyPose> jumpKeys() {
  constexpr double kSide = 0.10;
  static const std::vector<KeyPose> keys = {
      {0, both({0, 0.86, 0}, planted(kSide))},
      {0.12, both({0, 0.86, 0}, planted(kSide), {.raise = 0.15, .swing = 0.1, .elbow = 0.25})},
      {0.48,
       leaning(both({0, 0.66, -0.09}, planted(kSide), {.raise = 0.2, .swing = -0.8, .elbow = 0.2}), 0.4, 0.55, 0.15)},
      {0.66,
       leaning(both({0, 0.58, -0.13}, planted(kSide), {.raise = 0.2, .swing = 0.0, .elbow = 0.3}), 0.5, 0.75, 0.15)},
      {0.89,
       leaning(both({0, 0.885, 0.05}, planted(kSide, -0.85), {.raise = 0.25, .swing = 1.4, .elbow = 0.35}), 0.05, 0.05,
               -0.1),
       true},
      {1.09,
       leaning(both({0, 0, 0.05}, lifted(kSide, 0.21, -0.75), {.raise = 0.3, .swing = 2.6, .elbow = 0.3}), 0.05, 0.02,
               -0.15),
       true},
      {1.29, leaning(both({0, 0.845, 0.01}, planted(kSide, -0.5), {.raise = 0.35, .swing = 1.9, .elbow = 0.4}), 0.15,
                     0.2, 0.05)},
      {1.52,
       leaning(both({0, 0.63, -0.12}, planted(kSide), {.raise = 0.3, .swing = 0.7, .elbow = 0.5}), 0.42, 0.62, 0.2)},
      {1.98, both({0, 0.86, 0}, planted(kSide))},
  };
  return keys;
}

// Three breaths (a person at rest takes 12 to 20 a minute), the weight on one leg and then on the other, a look round.
std::span<const KeyPose> idleKeys() {
  const auto at = [](double weight, double breath, double look) {
    Stance stance = both({0.035 * weight, 0.86 + 0.003 * breath, 0}, planted(0.11),
                         {.raise = 0.13 + 0.03 * breath, .swing = 0.03 * breath, .elbow = 0.28});
    stance.hips.roll = 0.05 * weight;
    stance.chest = {0.05 - 0.045 * breath, 0.08 * look, -0.03 * weight};
    stance.head = {0.03 - 0.02 * breath, 0.45 * look, 0};
    return stance;
  };
  static const std::vector<KeyPose> keys = {{0, at(1, 0, 0)},      {1.5, at(1, 1, 0.1)}, {3, at(0.9, 0, 0.8)},
                                            {4.5, at(-1, 1, 0.7)}, {6, at(-1, 0, -0.5)}, {7.5, at(-0.9, 1, -0.4)}};
  return keys;
}

// The right hand is raised and goes to and fro three times.
std::span<const KeyPose> waveKeys() {
  constexpr double kOut = 1.0, kIn = 1.95;  // of the elbow
  const auto at = [](double raised, double elbow) {
    Stance stance = both({-0.015 * raised, 0.86, 0}, planted(0.10));
    stance.arms[1] = {0.14 + 1.4 * raised, 0.35 * raised, elbow, 1.5 * raised};
    stance.hips.roll = -0.03 * raised;
    stance.chest = {0.02, -0.10 * raised, 0.05 * raised};
    stance.head = {-0.03 * raised, -0.12 * raised, -0.08 * raised};
    return stance;
  };
  static const std::vector<KeyPose> keys = {
      {0, at(0, 0.25)},   {0.2, at(0, 0.3)},  {0.75, at(1, kIn)}, {1.0, at(1, kOut)}, {1.25, at(1, kIn)},
      {1.5, at(1, kOut)}, {1.75, at(1, kIn)}, {2.0, at(1, kOut)}, {2.25, at(1, kIn)}, {2.9, at(0, 0.25)},
  };
  return keys;
}

// On a seat as high as the knees. Trunk forward before and after, so that the body's middle stays over the feet.
std::span<const KeyPose> sitDownKeys() {
  constexpr double kSide = 0.11, kSeat = 0.50;
  const ArmPose reaching{.raise = 0.2, .swing = 0.75, .elbow = 0.35},
      onKnees{.raise = 0.16, .swing = 0.38, .elbow = 0.5};
  const Stance stance = both({0, 0.86, 0}, planted(kSide)),
               lowers = leaning(both({0, 0.66, -0.25}, planted(kSide), reaching), 0.6, 0.95, 0.35),
               touches = leaning(both({0, kSeat, -0.39}, planted(kSide), onKnees), 0.2, 0.5, 0.2),
               sits = leaning(both({0, kSeat, -0.39}, planted(kSide), onKnees), -0.12, 0.02, 0.02),
               leans = leaning(both({0, kSeat, -0.38}, planted(kSide), reaching), 0.5, 0.9, 0.3);
  static const std::vector<KeyPose> keys = {{0, stance}, {0.3, stance}, {1.0, lowers},  {1.4, touches}, {1.9, sits},
                                            {3.4, sits}, {3.9, leans},  {4.35, lowers}, {5.1, stance}};
  return keys;
}

}  // namespace

const KeyedMotion kJumpingJack = {1.2, &jumpingJackKeys}, kJump = {2.3, &jumpKeys}, kIdle = {9, &idleKeys},
                  kWave = {3.3, &waveKeys}, kSitDown = {5.6, &sitDownKeys};

}  // namespace limber
