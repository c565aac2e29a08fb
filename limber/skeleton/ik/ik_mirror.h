// Problems that are the same left and right, so that their answers are too.
#pragma once

#include <vector>

#include "limber/core/types.h"

namespace limber {

class IkSystem;

// The mirror image of a system's joints, where there is one: nodes that lie opposite each other, bend alike and have
// the same limits. Descent alone keeps such a problem symmetric only to rounding, which limits and long shallow valleys
// amplify to poses that differ between the sides; random restarts would not keep it at all.
//
// Node k is the mirror image of node j where rotation(k) = plane * rotation(j) * turn(j) and position(k) is position(j)
// mirrored. A mirror is minus the half turn `plane` about its normal; the two minuses of the first equation cancel. So
// local(k) = turn(parent of j)^-1 * local(j) * turn(j).
class IkMirror {
 public:
  IkMirror() = default;
  // Looks for the images in the system's current state (rest pose): effectors opposite each other define the plane.
  explicit IkMirror(const IkSystem& system);

  // Whether pose, targets and references are symmetric too. To be asked after each load, before impose().
  bool fits(const IkSystem& system);
  // Makes one side's local rotations and offsets the image of the other's, and those of the middle their own.
  void impose(IkSystem& system) const;

 private:
  bool pairNodes(const IkSystem& system, const Quat& plane, const Vec3& point);
  bool pairEffectors(const IkSystem& system);
  bool limitsMatch(const IkSystem& system) const;
  bool referencesMatch(const IkSystem& system) const;
  bool isImage(const IkSystem& system, int node) const;
  Quat above(const IkSystem& system, int node) const;
  Quat imageOf(const IkSystem& system, int node, const Quat& local) const;
  Vec3 mirrored(const Vec3& point) const { return point_ - plane_ * Vec3(point - point_); }

  std::vector<int> partners_;          // #nodes, itself in the middle; empty: there is no mirror
  std::vector<int> effectorPartners_;  // #effectors
  std::vector<Quat> turns_;            // #nodes
  double size_ = 0;                    // metres
  Quat restPlane_ = Quat::Identity(), plane_ = Quat::Identity();  // half turn about the plane's normal
  Vec3 point_ = Vec3::Zero();                                     // of the plane
};

}  // namespace limber
