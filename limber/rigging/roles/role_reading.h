// A learned reading in body space, asked by the names of roles, parts and plans.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/reading/learned_reading.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/roles/joint_roles.h"

namespace limber {

class RoleReading {
 public:
  // surface  of the mesh that `frame` is of, in its space
  // known    joints whose position is given, in body space, by their roles
  // Throws Error as readSamples does.
  RoleReading(const SurfaceSamples& surface, const ReadingWeights& weights, const AnatomicalFrame& frame,
              const std::map<std::string, Vec3>& known = {});

  const AnatomicalFrame& frame() const { return frame_; }
  bool has(std::string_view role) const;           // false for a role that the weights do not have
  double confidence(std::string_view role) const;  // that the body has it; 0 for a role that the weights do not have
  double fractionOf(std::string_view part) const;  // the fraction of the samples that are of it
  // Of a joint, even if the body lacks it. Body space; heights.
  Vec3 position(const RolePosition& at) const;
  double expectedError(const RolePosition& at) const;

  // Natural logarithm of joints' expected errors in the mesh's space: mean over what is a joint, by its confidence.
  double meanLogError() const;

  // Where the bone ends that begins at `start` and carries samples of that part: the mean of what these say. None where
  // hardly any do.
  std::optional<Vec3> boneEnd(std::string_view part, const Vec3& start) const;

  // By the sample: its part's name.
  std::string_view partOf(std::size_t sample) const;
  const SurfaceSamples& samples() const { return reading_.surface; }

  double probability(std::string_view plan) const;

  const std::vector<std::string>& roles() const { return weights_->roles; }
  bool isKnown(std::string_view role) const;
  // Known roles stay.
  void move(std::string_view role, const Vec3& displacement);

  // One reading of both sides: each joint's position is the mean of it and of the mirror image of the other side's.
  void makeSymmetric();

 private:
  Index roleOf(std::string_view role) const;
  Vec3 toBody(const Vec3& position) const { return (position - origin_) / frame_.height; }

  const ReadingWeights* weights_;
  AnatomicalFrame frame_;
  Vec3 origin_;  // of the frame, along its axes
  LearnedReading reading_;
};

}  // namespace limber
