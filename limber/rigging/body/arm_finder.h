// An arm cut along its bones, from the hand to where it has grown into the trunk.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/body/body_section.h"

namespace limber {

// Offsets along the arm are in heights, from the given shoulder along the upper arm and then the forearm.
class ArmFinder {
 public:
  // Joints in body space; elbow and hand in the middle of the arm. `body` and `frame` must outlive the finder.
  ArmFinder(const BodyVolume& body, const AnatomicalFrame& frame, const Vec3& shoulder, const Vec3& elbow,
            const Vec3& hand);

  double elbow() const { return upper_; }
  double hand() const { return upper_ + lower_; }

  // Where the cut is all at once much wider than the arm; none where that is beyond the elbow or nowhere.
  std::optional<double> armpit() const { return armpit_; }
  double radius() const { return radius_; }  // of a disk as large as the upper arm's cut

  // Where the arm is thinnest between two offsets, if it is clearly thicker on both sides of it.
  std::optional<double> narrowest(double from, double to) const;

  // The middle of the arm; none where it was not seen thereabouts.
  std::optional<Vec3> middle(double offset) const;

 private:
  struct Cut {
    double offset, area;
    Vec3 center;
  };
  void findArmpit();

  std::vector<Cut> cuts_;  // outwards; area 0 where nothing lies
  double upper_ = 0, lower_ = 0, step_ = 0, radius_ = 0;
  std::optional<double> armpit_;
};

}  // namespace limber
