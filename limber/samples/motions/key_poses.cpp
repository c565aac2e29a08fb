// Interpolation between key poses: each number of a stance is a periodic curve of degree 5 through its keys, with
// slopes that never overshoot (Fritsch & Carlson 1980, with the harmonic mean of Butland).
#include <array>
#include <cmath>

#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/smooth_path.h"

namespace limber {

namespace {

constexpr std::size_t kPelvisHeight = 1;  // its channel
using Channels = std::array<double, 32>;

// Every number of a stance, always in the same order; `Each` takes a double&.
template <class Each>
void forEachNumber(Stance& stance, Each each) {
  for (double& x : stance.pelvis) each(x);
  for (BodyTurn* turn : {&stance.hips, &stance.chest, &stance.head}) {
    each(turn->pitch), each(turn->yaw), each(turn->roll);
  }
  for (FootPose& foot : stance.feet) {
    for (double& x : foot.ankle) each(x);
    each(foot.outward), each(foot.pitch), each(foot.toes);
  }
  for (ArmPose& arm : stance.arms) each(arm.raise), each(arm.swing), each(arm.elbow), each(arm.twist);
}

// Feet by where their toes are, which stand still while heels are lifted.
Channels channelsOf(Stance stance) {
  for (FootPose& foot : stance.feet) foot.ankle += turnedFoot(foot, kToToes);
  Channels channels;
  std::size_t next = 0;
  forEachNumber(stance, [&](double x) { channels[next++] = x; });
  return channels;
}

Stance stanceOf(const Channels& channels) {
  Stance stance;
  std::size_t next = 0;
  forEachNumber(stance, [&](double& x) { x = channels[next++]; });
  for (FootPose& foot : stance.feet) foot.ankle -= turnedFoot(foot, kToToes);
  return stance;
}

struct Key {
  double time, value;
};

double slopeOf(const Key& from, const Key& to) {
  return (to.value - from.value) / (to.time - from.time);
}

// Through `at`, between its neighbours: level at an extreme and where a neighbour is as high.
Knot<double> smoothKnot(const Key& before, const Key& at, const Key& after) {
  const double left = slopeOf(before, at), right = slopeOf(at, after);
  return {at.value, left * right > 0 ? 2 * left * right / (left + right) : 0.0, 0};
}

// The keys of a motion that goes on forever; `number` may be below 0 and above the last.
class Cycle {
 public:
  Cycle(std::span<const KeyPose> keys, double period) : keys_(keys), period_(period) {}

  // The last key at that time or before it.
  int before(double time) const {
    int number = -1;
    while (timeOf(number + 1) <= time) ++number;
    return number;
  }
  double timeOf(int number) const {
    return pose(number).seconds + period_ * std::floor(static_cast<double>(number) / static_cast<double>(keys_.size()));
  }
  const KeyPose& pose(int number) const {
    const int count = static_cast<int>(keys_.size());
    return keys_[static_cast<std::size_t>(((number % count) + count) % count)];
  }

 private:
  std::span<const KeyPose> keys_;
  double period_;
};

// The pelvis leaves the ground and comes back to it as fast as a thrown body does.
double pelvisHeight(const Cycle& cycle, double time, int number) {
  const auto inAir = [&](int n) { return cycle.pose(n - 1).airborne && cycle.pose(n).airborne; };
  const auto step = [&](int n, int direction) {
    do n += direction;
    while (inAir(n));
    return n;
  };
  const auto key = [&](int n) { return Key{cycle.timeOf(n), cycle.pose(n).stance.pelvis.y()}; };
  const auto knot = [&](int n) {
    const int last = step(n, -1), next = step(n, 1);
    const bool leaves = cycle.pose(n).airborne, lands = cycle.pose(last).airborne;
    if (!leaves && !lands) return smoothKnot(key(last), key(n), key(next));
    const Key from = key(leaves ? n : last), to = key(leaves ? next : n);
    const double fall = 0.5 * kGravity * (to.time - from.time);
    return Knot<double>{key(n).value, slopeOf(from, to) + (leaves ? fall : -fall), -kGravity};
  };
  const int from = inAir(number) ? step(number, -1) : number, to = step(from, 1);
  return between(knot(from), knot(to), key(to).time - key(from).time, time - key(from).time);
}

}  // namespace

Stance keyedStance(std::span<const KeyPose> keys, double period, double seconds) {
  const double time = seconds - period * std::floor(seconds / period);
  const Cycle cycle(keys, period);
  const int number = cycle.before(time);
  std::array<Channels, 4> channels;  // of the keys about this moment: two before it, two after
  for (int k = 0; k < 4; ++k) channels[k] = channelsOf(cycle.pose(number - 1 + k).stance);
  Channels now;
  for (std::size_t c = 0; c < now.size(); ++c) {
    const auto key = [&](int k) { return Key{cycle.timeOf(number - 1 + k), channels[k][c]}; };
    now[c] = between(smoothKnot(key(0), key(1), key(2)), smoothKnot(key(1), key(2), key(3)), key(2).time - key(1).time,
                     time - key(1).time);
  }
  now[kPelvisHeight] = pelvisHeight(cycle, time, number);
  return stanceOf(now);
}

}  // namespace limber
