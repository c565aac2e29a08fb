// The capsule person with what fitting a template measures of it first. Not installed.
#pragma once

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/body/testing/capsule_person.h"

namespace limber::testing {

struct MeasuredPerson {
  CapsulePerson shape = capsulePerson();
  BodyVolume body = measureBody(shape.mesh);
  AnatomicalFrame frame = frameAlong(shape.mesh, body, Vec3::UnitY(), Vec3::UnitZ());
};

// Measured once for all tests of a program.
inline const MeasuredPerson& measuredPerson() {
  static const MeasuredPerson person;
  return person;
}

}  // namespace limber::testing
