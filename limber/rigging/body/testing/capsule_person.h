// Bodies made of capsules round a known skeleton, for tests of what fits skeletons into bodies. Not installed.
#pragma once

#include <cmath>
#include <vector>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// Legs as people have them, or such as animals on two legs have: down from a hock behind to toes on the ground.
enum class CapsuleLegs { kStraight, kHocked };

// A person 1 high, feet on y = 0, facing +Z, its left at +X; arms lowered from level by `arms` radians.
struct CapsulePerson {
  TriMesh mesh;
  Vec3 shoulder, elbow, hand, hip, knee, ankle;  // of the left; the ankle is the hock if there is one
  Vec3 toes;                                     // below the hock
};
inline CapsulePerson capsulePerson(double arms = 0.3, CapsuleLegs legs = CapsuleLegs::kStraight) {
  CapsulePerson person;
  person.shoulder = {0.1, 0.78, 0};
  const Vec3 along(std::cos(arms), -std::sin(arms), 0);
  person.elbow = person.shoulder + 0.14 * along;
  person.hand = person.elbow + 0.14 * along;
  person.hip = {0.07, 0.5, 0};
  person.knee = {0.08, 0.27, 0};
  person.ankle = {0.09, 0.045, 0};
  const bool hocked = legs == CapsuleLegs::kHocked;
  if (hocked) {
    person.knee = {0.08, 0.3, 0.1};
    person.ankle = {0.08, 0.2, -0.1};
    person.toes = {0.08, 0.035, 0.02};
  }
  TriMesh& mesh = person.mesh;
  addCapsule(mesh, {0, 0.55, 0}, {0, 0.74, 0}, 0.085);  // trunk
  addCapsule(mesh, {0, 0.78, 0}, {0, 0.86, 0}, 0.03);
  addCapsule(mesh, {0, 0.9, 0.01}, {0, 0.93, 0.01}, 0.07);
  for (const double s : {1.0, -1.0}) {
    const auto sided = [&](const Vec3& p) { return Vec3(s * p.x(), p.y(), p.z()); };
    addCapsule(mesh, sided({0.03, 0.765, 0}), sided(person.shoulder), 0.04);
    addCapsule(mesh, sided(person.shoulder), sided(person.elbow), 0.033);
    addCapsule(mesh, sided(person.elbow), sided(person.hand), 0.028);
    addCapsule(mesh, sided(person.hand), sided(person.hand + 0.08 * along), 0.025);
    addCapsule(mesh, sided(person.hip), sided(person.knee), 0.05);
    addCapsule(mesh, sided(person.knee), sided(person.ankle), 0.038);
    if (hocked) {
      addCapsule(mesh, sided(person.ankle), sided(person.toes), 0.03);
      addCapsule(mesh, sided(person.toes), sided(person.toes + Vec3(0, -0.01, 0.07)), 0.025);
    } else {
      addCapsule(mesh, sided({0.09, 0.03, -0.01}), sided({0.095, 0.03, 0.1}), 0.03);
    }
  }
  for (Vec3f& p : mesh.positions) p.y() = std::max(p.y(), 0.0f);
  return person;
}

}  // namespace limber::testing
