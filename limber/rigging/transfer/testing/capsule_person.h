// A person made of capsules, with joints and weights, for tests. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/rigging/transfer/rig_transfer.h"

namespace limber::testing {

struct PersonJoint {
  const char* name;
  int parent;
  Vec3 position, end;  // of its bone
  double radius;
};

inline const std::vector<PersonJoint>& personJoints() {
  static const std::vector<PersonJoint> joints = {{"hips", -1, {0, 0.95, 0}, {0, 1.1, 0}, 0.13},
                                                  {"spine", 0, {0, 1.1, 0}, {0, 1.4, 0.01}, 0.14},
                                                  {"head", 1, {0, 1.52, 0.01}, {0, 1.66, 0.03}, 0.1},
                                                  {"leftUpperArm", 1, {0.18, 1.4, 0}, {0.45, 1.39, -0.01}, 0.05},
                                                  {"leftLowerArm", 3, {0.45, 1.39, -0.01}, {0.7, 1.4, 0.02}, 0.04},
                                                  {"leftHand", 4, {0.7, 1.4, 0.02}, {0.82, 1.4, 0.03}, 0.035},
                                                  {"rightUpperArm", 1, {-0.18, 1.4, 0}, {-0.45, 1.39, -0.01}, 0.05},
                                                  {"rightLowerArm", 6, {-0.45, 1.39, -0.01}, {-0.7, 1.4, 0.02}, 0.04},
                                                  {"rightHand", 7, {-0.7, 1.4, 0.02}, {-0.82, 1.4, 0.03}, 0.035},
                                                  {"leftUpperLeg", 0, {0.1, 0.9, 0}, {0.11, 0.5, 0.02}, 0.08},
                                                  {"leftLowerLeg", 9, {0.11, 0.5, 0.02}, {0.11, 0.1, -0.01}, 0.06},
                                                  {"leftFoot", 10, {0.11, 0.1, -0.01}, {0.12, 0.05, 0.14}, 0.05},
                                                  {"rightUpperLeg", 0, {-0.1, 0.9, 0}, {-0.11, 0.5, 0.02}, 0.08},
                                                  {"rightLowerLeg", 12, {-0.11, 0.5, 0.02}, {-0.11, 0.1, -0.01}, 0.06},
                                                  {"rightFoot", 13, {-0.11, 0.1, -0.01}, {-0.12, 0.05, 0.14}, 0.05}};
  return joints;
}

inline double distanceToBone(const PersonJoint& bone, const Vec3& p) {
  const Vec3 along = bone.end - bone.position;
  const double t = std::clamp(along.dot(p - bone.position) / along.squaredNorm(), 0.0, 1.0);
  return (bone.position + t * along - p).norm() - bone.radius;
}

// Fifteen capsules that lie in each other, each a piece of its own; a vertex follows the two bones that are nearest.
inline RiggedBody riggedCapsulePerson() {
  RiggedBody body;
  for (const PersonJoint& bone : personJoints()) {
    addCapsule(body.mesh, bone.position, bone.end, bone.radius);
    Joint joint;
    joint.name = bone.name;
    if (bone.parent >= 0) joint.parent = static_cast<Index>(bone.parent);
    const Vec3 above =
        bone.parent < 0 ? Vec3(Vec3::Zero()) : personJoints()[static_cast<std::size_t>(bone.parent)].position;
    joint.rest.translation = bone.position - above;
    body.skeleton.joints.push_back(joint);
  }
  body.weights.slots = 2;
  for (Index v = 0; v < body.mesh.vertexCount(); ++v) {
    std::vector<std::pair<double, Index>> near;
    for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
      near.emplace_back(std::abs(distanceToBone(personJoints()[j], body.mesh.position(v))), j);
    }
    std::sort(near.begin(), near.end());
    const double a = 1 / (near[0].first + 0.01), b = 1 / (near[1].first + 0.01);
    body.weights.joints.insert(body.weights.joints.end(), {near[0].second, near[1].second});
    body.weights.weights.insert(body.weights.weights.end(),
                                {static_cast<float>(a / (a + b)), static_cast<float>(b / (a + b))});
  }
  return body;
}

inline std::vector<Vec3> jointPositions(const Skeleton& skeleton) {
  std::vector<Vec3> positions;
  for (const Affine& global : restGlobals(skeleton)) positions.push_back(global.translation());
  return positions;
}

// All joints as landmarks, at `positions`.
inline std::vector<JointLandmark> landmarksAt(const std::vector<Vec3>& positions) {
  std::vector<JointLandmark> landmarks;
  for (Index j = 0; j < positions.size(); ++j) landmarks.push_back({j, positions[j]});
  return landmarks;
}

template <typename Map>
TriMesh mapped(TriMesh mesh, const Map& map) {
  for (Vec3f& p : mesh.positions) p = Vec3(map(Vec3(p.cast<double>()))).template cast<float>();
  return mesh;
}

}  // namespace limber::testing
