// The file with the networks' weights: what training writes (tools/learn) and programs load when a skeleton is asked for.
#pragma once

#include <string>
#include <vector>

#include "limber/core/file/file.h"
#include "limber/reading/network.h"

namespace limber {

// Fitted after training on makers that were left out of it.
struct ReadingCalibration {
  double planTemperature = 1;  // that logits of plans are divided by
  double errorFactor = 1;      // that expected errors are multiplied with
  double sureThreshold = 1;    // confidence in a plan from which on it is taken without a question, in [0, 1]
};

struct ReadingWeights {
  // In the order of the network's outputs. Names that end in .L and .R are of the left and the right.
  std::vector<std::string> roles, parts, plans;
  std::vector<Index> mirrorRole, mirrorPart;  // the one on the other side, or itself
  ReadingCalibration calibration;
  std::string card;  // JSON: what they were trained on, by whom, under which licences
  ReadingNetwork reading;
  StanceNetwork stance;

  std::size_t sampleCount() const { return reading.trunk.sizes.samples; }
};

// "LRD1"; the length of a JSON text in 32 bits; the text; zeros up to a multiple of 4 bytes; all tensors in IEEE 754's 16
// bits, in the order of the text's list `tensors`; zeros up to a multiple of 4. Little endian. Matrices have a row for each
// input. Tensors are named as in training: reading.layers.0.qkv.weight.
//
// Throws Error: kUnsupported where it is another kind of file or a later version, kBadData where it is cut off, lacks
// something, has too much, contradicts itself or has no finite number somewhere, kLimit above 16 MB.
ReadingWeights readReadingWeights(ByteSpan file);

}  // namespace limber
