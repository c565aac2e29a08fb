// Joints of a four-legged animal moved to where the shape of the body shows them.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// Where the joints of an animal are relative to the shapes that show them. Lengths in body heights; fractions of the
// trunk are of the height from its underside to its back; fractions of a leg are of the height of its upper joint.
struct QuadrupedProportions {
  double hipUp = 0.49;                     // hind legs' upper joints: fraction, from where the legs part to the back
  double shoulderUp = 0.24;                // front legs' upper joints, likewise
  double knee = 0.71, kneeForward = 0.09;  // fractions of the leg; the knee lies before the middle of it
  double hock = 0.39;
  double hindToes = 0.1;
  double elbow = 0.54;
  double frontFoot = 0.15;
  double frontToes = 0.05;
  double hipsUp = 0.62, hipsForward = -0.02;  // fraction of the trunk; from the hind legs' upper joints
  double tailUp = 0.68, tailForward = -0.11;
  double spineUp = 0.55;
  double chestUp = 0.52, chestForward = -0.06;  // from the front legs' upper joints
  double neckUp = 0.48, neckForward = 0.08;
};

// Where a template has the joints of limber's quadruped: the legs are followed from the ground to where they part;
// their upper joints go above that point, knees, hocks, elbows and feet to the middle of the leg; hips, chest, spine
// and the roots of neck and tail go into the trunk, where the legs carry it; the tail runs from there to its end. What
// a body does not show stays where it was. Pinned joints stay. Body space.
void refineQuadruped(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                     const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& positions,
                     const QuadrupedProportions& proportions = {});

}  // namespace limber
