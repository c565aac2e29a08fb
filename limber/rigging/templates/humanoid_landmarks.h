// Joints of a person moved to where the shape of the body shows them.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// Where the joints of a person are relative to the shapes that show them. Heights, except for fractions.
// tools/fit_template.cpp fits these values.
struct HumanoidProportions {
  double hipAboveParting = 1.0;  // the legs' upper joints above the point where the legs part, half widths of a leg
  double hipsBelow = 0.012;      // the hips, below the legs' upper joints
  double neckAboveShoulders = 0.025;
  double headAboveNeck = 0.055;
  double ankle = 0.02, ankleFraction = 0.05;  // of the height of the legs' upper joints
  double knee = 0.49;                         // fraction of the path from hip to ankle
  double elbow = 0.475;                       // fraction of the path from shoulder to hand, of straight arms
  double kneeForward = 0.35;                  // half depths of the leg before its middle
  double chestBack = 0.25;                    // half depths of the chest behind its middle
  double upperChest = 0.73;                   // fraction of the path from hips to neck
};

// Where a template has the legs and arms of VRM's humanoid: the legs' upper joints go to where the legs part; knees,
// ankles, elbows and hands to the middle of the limb; shoulders on in the direction of the upper arm; the hips between
// the legs, the neck and the head above the shoulders, all in the middle between front and back. What a body does not
// show (a robe hides where legs part) stays where it was. Legs and trunk move only where they are upright. Pinned joints
// stay. Body space.
void refineHumanoid(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                    const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& positions,
                    const HumanoidProportions& proportions = {});

}  // namespace limber
