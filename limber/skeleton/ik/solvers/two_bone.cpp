#include "limber/skeleton/ik/solvers/two_bone.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"

namespace limber {

namespace {

constexpr double kStraight = 1e-12;  // sine of a bend, squared, that gives no normal

// The rotation that takes one unit vector to another, and a normal of the one to a normal of the other.
Quat turnFrame(const Vec3& from, const Vec3& fromNormal, const Vec3& to, const Vec3& toNormal) {
  const Vec3 fromThird = from.cross(fromNormal), toThird = to.cross(toNormal);
  const Mat3 matrix = to * from.transpose() + toNormal * fromNormal.transpose() + toThird * fromThird.transpose();
  return Quat(matrix);
}

// The unit vector `normal` of the unit vector `from`, turned as the smallest rotation to the unit vector `to` does it.
Vec3 carriedNormal(const Vec3& normal, const Vec3& from, const Vec3& to) {
  const double w = 1 + from.dot(to);
  return w > 1e-12 ? Vec3(normal - (normal.dot(to) / w) * (from + to)) : normal;
}

// Unit normal of the bend as it is, for bones along the unit vectors `upper` and `lower`.
Vec3 bendNormal(const Vec3& upper, const Vec3& lower, const Vec3& fallback) {
  const Vec3 normal = upper.cross(lower);
  const double length2 = normal.squaredNorm();
  if (length2 > kStraight) return normal / std::sqrt(length2);
  const Vec3 second = fallback - fallback.dot(upper) * upper;
  if (second.squaredNorm() > kStraight) return second.normalized();
  return upper.unitOrthogonal();
}

// Bones as they are and as they have to be.
struct Bend {
  double upperLength, lowerLength;
  Vec3 upper, lower, normal;        // as they are; directions are unit vectors
  Vec3 direction, side, newNormal;  // of the new bend: to the target, and to where the middle lies aside
  double distance, along, out;      // of the end, and of the middle along the direction and to the side
};

Bend bendFor(const TwoBone& bones) {
  Bend bend;
  const Vec3 upperBone = bones.middle - bones.start, lowerBone = bones.end - bones.middle;
  bend.upperLength = upperBone.norm();
  bend.lowerLength = lowerBone.norm();
  const double upperLength = bend.upperLength, lowerLength = bend.lowerLength;
  bend.upper = 1 / upperLength * upperBone;
  bend.lower = 1 / lowerLength * lowerBone;
  bend.normal = bendNormal(bend.upper, bend.lower, bones.straightNormal);

  const Vec3 reach = bones.target - bones.start, now = bones.end - bones.start;
  const double distance = reach.norm(), nowLength = now.norm();
  const Vec3 nowDirection = nowLength > kStraight * upperLength ? Vec3(now * (1 / nowLength)) : bend.upper;
  bend.direction = distance > kStraight * upperLength ? Vec3(reach * (1 / distance)) : nowDirection;

  const double d = std::clamp(distance, std::abs(upperLength - lowerLength), upperLength + lowerLength);
  const double squares = upperLength * upperLength - lowerLength * lowerLength;
  bend.distance = d;
  bend.along = d > 0 ? std::clamp((squares + d * d) / (2 * d), -upperLength, upperLength) : 0;
  bend.out = std::sqrt(std::max(0.0, upperLength * upperLength - bend.along * bend.along));

  // The normal of the new bend: carried along with the direction to the target, or across to the pole.
  bend.newNormal = carriedNormal(bend.normal, nowDirection, bend.direction);
  if (bones.pole) {
    const Vec3 across = (*bones.pole - bones.start).cross(bend.direction);
    const double squared = across.squaredNorm();
    if (squared > kStraight * upperLength * upperLength) bend.newNormal = across * (1 / std::sqrt(squared));
  }
  bend.side = bend.direction.cross(bend.newNormal);
  return bend;
}

}  // namespace

TwoBoneTurns solveTwoBone(const TwoBone& bones) {
  const Bend bend = bendFor(bones);
  const Vec3 newUpper = 1 / bend.upperLength * (bend.along * bend.direction + bend.out * bend.side);
  const Vec3 newLower = 1 / bend.lowerLength * ((bend.distance - bend.along) * bend.direction - bend.out * bend.side);
  return {turnFrame(bend.upper, bend.normal, newUpper, bend.newNormal),
          turnFrame(bend.lower, bend.normal, newLower, bend.newNormal)};
}

TwoBonePositions twoBonePositions(const TwoBone& bones) {
  const Bend bend = bendFor(bones);
  return {bones.start + bend.along * bend.direction + bend.out * bend.side,
          bones.start + bend.distance * bend.direction};
}

namespace {

class TwoBoneIteration : public IkIteration {
 public:
  explicit TwoBoneIteration(const IkSystem& system) {
    std::vector<bool> taken(system.nodes.size(), false);
    for (std::size_t e = 0; e < system.effectors.size(); ++e) {
      const auto refuse = [&](const char* what) {
        throw Error(ErrorCode::kBadArgument, what, fmt::format("target {}", e), "choose another method");
      };
      const std::vector<int>& path = system.effectors[e].path;
      if (path.size() != 3) refuse("does not have exactly two bones from its base");
      for (const int n : path) {
        if (taken[static_cast<std::size_t>(n)]) refuse("shares joints with another, which two-bone cannot solve");
        taken[static_cast<std::size_t>(n)] = true;
      }
    }
  }

  Index run(IkSystem& system, Index budget) override {
    if (budget == 0) return 0;
    for (const IkSystem::Effector& effector : system.effectors) solveLimb(system, effector);
    return 1;
  }

 private:
  static void solveLimb(IkSystem& system, const IkSystem::Effector& effector) {
    const auto start = static_cast<std::size_t>(effector.path[0]), middle = static_cast<std::size_t>(effector.path[1]);
    const auto end = static_cast<std::size_t>(effector.path[2]);
    if (system.offsets[middle].squaredNorm() > 0 && system.offsets[end].squaredNorm() > 0) {
      const TwoBone bones{system.positions[start], system.positions[middle],
                          system.positions[end],   effector.target,
                          effector.pole,           straightNormal(system, effector.path[1])};
      const TwoBoneTurns turns = solveTwoBone(bones);
      const Quat middleGlobal = turns.middle * system.globals[middle];
      setGlobal(system, effector.path[0], turns.start * system.globals[start]);
      setGlobal(system, effector.path[1], middleGlobal);
    }
    system.forwardFrom(effector.path[2]);
    if (effector.angleScale > 0) setGlobal(system, effector.path[2], effector.orientation);
  }

  // About what a straight limb bends: the middle joint's first axis where it has limits, so that a knee does not have
  // to break them, else its X.
  static Vec3 straightNormal(const IkSystem& system, int middle) {
    const auto n = static_cast<std::size_t>(middle);
    const JointLimit* limit = system.nodes[n].limit;
    const TurnAxes axes = limit ? turnAxes(*limit, system.locals[n]) : TurnAxes{};
    return system.globals[n] * (axes.count > 0 ? axes.axes[0] : Vec3(Vec3::UnitX()));
  }

  // The node's global rotation, as far as its limits let it.
  static void setGlobal(IkSystem& system, int node, const Quat& global) {
    const auto n = static_cast<std::size_t>(node);
    const double freedom = system.nodes[n].freedom;
    if (freedom > 0) {
      const Quat wanted = (system.parentRotation(node).conjugate() * global).normalized();
      system.locals[n] = freedom < 1 ? system.locals[n].slerp(freedom, wanted) : wanted;
      system.limitNode(node);
    }
    system.forwardFrom(node);
  }
};

}  // namespace

std::unique_ptr<IkIteration> makeTwoBone(const IkSystem& system) {
  return std::make_unique<TwoBoneIteration>(system);
}

}  // namespace limber
