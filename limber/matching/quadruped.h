// The body of an animal on four legs, told by where its joints are.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// Joints of a part are in order, root to tip.
struct Quadruped {
  using Joints = std::vector<Index>;
  struct Leg {
    Joints blade, bones, foot, toes;  // the shoulder blade or hip bone; the foot is one joint
    Vec3 bladeWay = Vec3::Zero();     // of the blade, to where the bones begin: left, up, forward, of length 1
    std::vector<double> along;        // where each of the bones begins, from 0 to 1 at the foot
  };

  Index hindquarters = 0;  // carries the hind legs
  Joints trunk, neck, head, tail;
  std::array<Leg, 4> legs;      // left and right hind, left and right fore
  Vec3 forward = Vec3::Zero();  // level, of length 1
};

// Two pairs of chains that come down to the ground, one behind the other along the trunk, or all on one joint beside
// it; what goes on from the trunk is the neck, up to the joint called head or to where several hang on one, what hangs
// behind the tail. Feet on a root of their own count as on the shin above them (parentsWithLegsJoined). A leg ends at
// its first low joint, the foot. Nothing for others, or where toes point back: one whose joints hang on the chest would
// be read back to front. `positions` are #J, world, +Y up. Cost: linear in the joints but for their depth.
std::optional<Quadruped> readQuadruped(const Skeleton& skeleton, std::span<const Vec3> positions);
// In rest pose.
std::optional<Quadruped> readQuadruped(const Skeleton& skeleton);

}  // namespace limber
