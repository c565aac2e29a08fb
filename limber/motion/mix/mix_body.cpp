#include "limber/motion/mix/mix_body.h"

namespace limber {

namespace {

RetargetSetup ontoItself(const Skeleton& skeleton) {
  const SkeletonReading reading(skeleton);
  RetargetSetup setup(skeleton, skeleton, matchSkeletons(reading, reading), {});
  setup.sameBody = false;  // nothing is retargeted: what is mixed has to be corrected all the same
  return setup;
}

}  // namespace

MixBody::MixBody(const Skeleton& skeleton)
    : original_(skeleton),
      plain_(skeleton),
      setup_(ontoItself(plain_.skeleton())),
      root_(setup_),
      goals_(setup_, root_),
      legs_(goals_.specs()) {
  for (LegSpec& leg : legs_) leg.ownBend = false;
  const JointMatch* pelvis = setup_.map.find(body_part::kPelvis);
  pelvis_ = (pelvis ? *pelvis : setup_.map.matches.front()).target.front();
}

}  // namespace limber
