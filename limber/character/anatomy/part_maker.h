// From the states of a folded skeleton's joints to the parts of the body, on both sides. Internal to the module.
#pragma once

#include <vector>

#include "limber/character/anatomy/body_reading.h"

namespace limber {

// The likeliest labelling under the best guess of the axes.
struct LabelledBody {
  Axes axes;
  double sideConfidence = 1;                 // that left is not right
  std::vector<PartState> states;             // #half joints
  std::vector<PartField::Scores> marginals;  // #half joints
};

// Joints of one kind that hang on each other are a part; of what hangs beside, the larger goes on and the rest are
// branches, or parts of their own where a body has several of them. Pairs are numbered from front to back, fingers from
// the thumb. The trunk comes first, carriers before what they carry. Cost: joints times parts.
std::vector<Part> partsOf(const BodyReading& reading, const LabelledBody& labels);

}  // namespace limber
