// What the chosen clip does over its length, for a front end to draw.
#pragma once

#include <span>
#include <vector>

#include "limber/session/edit/movement.h"

namespace limber {

// From 0 to the clip's end, so many a second, or fewer so that there are at most `most` (2 or more). Empty where no
// clip is chosen, or it has no length. Throws Error kBadArgument for a rate that is not above 0.
std::vector<double> evenMoments(const Movement& movement, double framesPerSecond, std::size_t most);

// The same with the moments at which that joint has keys to edit (editableKeys), ascending: a front end draws these.
std::vector<double> curveMoments(const Movement& movement, Index joint, double framesPerSecond, std::size_t most);

// #moments * #J, where the joints are, moment after moment. These throw Error kBadArgument where no clip is chosen and
// there are moments.
std::vector<Vec3> jointPaths(const Movement& movement, const Skeleton& skeleton, std::span<const double> moments);

// A joint's pose, relative to its rest pose.
struct CurvePoint {
  Vec3 turn = Vec3::Zero();    // degrees about the axes of its own frame: a rotation vector
  Vec3 offset = Vec3::Zero();  // metres along the axes of its parent's
};
// From one time to the next the rotation takes the shorter arc, so that it does not jump at half a circle. Throws Error
// kBadArgument for a joint that is not there.
std::vector<CurvePoint> jointCurve(const Movement& movement, const Skeleton& skeleton, Index joint,
                                   std::span<const double> moments);

// How the joint's curves run through its keys, where they are cubic and can be edited: `slope` is what they change by
// in a second.
struct CurveTangent {
  double seconds = 0;
  KeyTangents tangents = KeyTangents::kAuto;
  CurvePoint slope;
};
std::vector<CurveTangent> curveTangents(const Movement& movement, const Skeleton& skeleton, Index joint);

// By the shorter arc, at most 180 degrees.
CurvePoint pointFromRest(const Transform& local, const Transform& rest);
// The inverse: sets the joint's pose. Its scale stays.
void setFromRest(Transform& local, const Transform& rest, const CurvePoint& point);

}  // namespace limber
