// A retargeted motion as an outsider sees it: by measures that no method minimises and no detector of theirs decides.
// Against the source, and against `aligned`, which has the source's smoothness by construction.
#pragma once

#include <optional>
#include <span>

#include "limber/character/matching/retarget_setup.h"
#include "limber/evaluate/motion/contact_oracle.h"

namespace limber {

// Lengths in heights of the body they are measured on (standingHeight). Joints are those of the limbs (limbPairs).
struct RetargetVerdict {
  double jerk = 1;      // root mean square third difference of the joints' positions, over that of `aligned`
  double jerkPeak = 1;  // likewise, of what one in a thousand exceeds
  double impact = 1;    // root mean square second difference of the limbs within a tenth of a second of where a contact
                        // of the source begins or ends, over that of `aligned`
  double sliding = 0, sourceSliding = 0;  // level speed of points that rest in the source, heights a second, mean
  ContactAgreement contacts;              // of the feet's points, source against result
  double bones95 = 0;  // degrees between a limb's bone and that of `aligned`, 95th percentile, of arms whose hand and
                       // legs whose foot touches nothing in the source
  // Fraction of the surface inside the body (self_penetration.h); none without a skin.
  std::optional<double> inside, alignedInside;
};

// `aligned` and `result` have the frames of `source`, at least 5; a setup with legs (hasLegs).
RetargetVerdict judgeRetargeting(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& aligned,
                                 const PoseSequence& result);

}  // namespace limber
