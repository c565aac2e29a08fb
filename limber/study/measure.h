// What is measured of a cell of a study.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "limber/document/asset.h"

namespace limber {

enum class Better { kLess, kMore, kNeither };

// Which command's figures a measure is read from.
enum class MeasureSource {
  kNone,
  kClock,          // how long a command takes
  kRigReport,      // limber rig --json
  kSkeletonTruth,  // limber evaluate rig --json
  kWeightTruth,    // limber evaluate weights --json
  kModel,          // limber evaluate model --json
  kModelMotion,    // of these what the surface does in motion, all that depends on the deformer
  kMotion,         // limber evaluate motion --json
};

struct Measure {
  std::string_view name;   // "joint_to_joint"
  std::string_view label;  // for people
  std::string_view unit;   // may be empty
  Better better;
  MeasureSource source;
  std::string_view pointer;      // into the figures (RFC 6901); kClock: unused
  bool ranks = true;             // false: shown, but orders no methods, as it says too little of who is better
  bool needsSameJoints = false;  // orders methods on one skeleton alone: fewer joints are smoother and stretch less
};

// Whether what a command gives has the measure: kModel has those of kModelMotion, too.
bool includes(MeasureSource figures, const Measure& measure);

// In the order in which tables have them.
std::span<const Measure> studyMeasures();
// Throws Error kBadArgument that lists the names there are.
const Measure& findMeasure(std::string_view name);

struct MeasuredValue {
  const Measure* measure;
  double value;
};

// Those of the source's measures that the figures hold as finite numbers, in the table's order.
std::vector<MeasuredValue> measuresIn(const Json& figures, MeasureSource source);

}  // namespace limber
