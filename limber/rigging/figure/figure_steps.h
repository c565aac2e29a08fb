// Small random changes of a figure, of which a search keeps those for the better.
#pragma once

#include "limber/core/random.h"
#include "limber/rigging/figure/figure.h"

namespace limber {

// How large steps are: at first 1, less where none was for the better for a while.
class StepSize {
 public:
  // patience  failures in a row before steps get smaller
  StepSize(int patience, double factor) : patience_(patience), factor_(factor) {}

  double value() const { return value_; }
  void succeeded() { failures_ = 0; }
  // Whether it is worth to go on.
  bool failed();

 private:
  int patience_, failures_ = 0;
  double factor_, value_ = 1;
};

// One change of one limb: a bone or both turn, an elbow or a knee moves, a bone grows, a foot turns, a shoulder shifts,
// with the elbow or without.
void stepLimb(Figure& figure, int limb, double size, Random& random);

// One change of the head or the trunk: its position or size, the stature, the neck, the chest (with the arms or
// without), the pelvis. Mostly elbows, knees, wrists and ankles stay where they are, as far as bones can be as long: a
// limb that matches well would otherwise keep the trunk from moving.
void stepTrunk(Figure& figure, double size, Random& random);

// Left for right and front for back, the limbs where they are; straight where they would bend in the wrong direction.
Figure turnedAround(Figure figure);

}  // namespace limber
