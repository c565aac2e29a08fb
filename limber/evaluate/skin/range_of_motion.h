// A range of motion test for any body: what animators have a new rig do first.
#pragma once

#include <string_view>
#include <vector>

#include "limber/character/anatomy/anatomy.h"

namespace limber {

struct RangeOfMotionPose {
  std::string_view name;  // "legs forward"
  Pose pose;
};

// One pose for each movement that some part of the body can do, always in the same order: legs forward, back and aside,
// knees, ankles; arms up and forward, elbows, wrists; trunk, neck and head bent and turned; tails, wings and fins.
// All parts of a kind move together. Each goes half as far as a person's can (American Academy of Orthopaedic Surgeons,
// The clinical measurement of joint motion, 1994); what people do not have goes a right angle, halved likewise. Knees
// and elbows bend further in the direction in which they are bent at rest. Trunks, necks, tails, wings and fins bend
// evenly along their joints; fingers, faces and props rest. Empty for a body without any such part.
//
// anatomy  of that skeleton, in rest pose
std::vector<RangeOfMotionPose> rangeOfMotion(const Skeleton& skeleton, const Anatomy& anatomy);

}  // namespace limber
