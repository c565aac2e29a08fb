#include "limber/study/measure.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "limber/core/text/names.h"

namespace limber {

namespace {

// Of measures without a truth those rank that agree with a distance from the artist's rig by 0.3 or more on both
// halves of the creatures (docs/study.md has the figures).
constexpr bool kAgreesTooLittle = false, kSameJoints = true;

// The distances of skeletons are those without fingers, faces and props, which no rigger makes.
constexpr Measure kMeasures[] = {
    {"joint_to_joint", "joints to artist's joints", "% of the longest side", Better::kLess,
     MeasureSource::kSkeletonTruth, "/without_fingers/joint_to_joint"},
    {"joint_to_bone", "joints to artist's bones", "% of the longest side", Better::kLess, MeasureSource::kSkeletonTruth,
     "/without_fingers/joint_to_bone"},
    {"bone_to_bone", "bones to artist's bones", "% of the longest side", Better::kLess, MeasureSource::kSkeletonTruth,
     "/without_fingers/bone_to_bone"},
    {"joint_precision", "joints that the artist has too", "0 to 1", Better::kMore, MeasureSource::kSkeletonTruth,
     "/without_fingers/precision"},
    {"joint_recall", "artist's joints that are there", "0 to 1", Better::kMore, MeasureSource::kSkeletonTruth,
     "/without_fingers/recall"},
    {"joint_iou", "joints in common", "0 to 1", Better::kMore, MeasureSource::kSkeletonTruth, "/without_fingers/iou"},
    {"weight_l1", "weights' distance from the artist's", "0 to 2", Better::kLess, MeasureSource::kWeightTruth, "/l1"},
    {"weight_precision", "influences that the artist has too", "0 to 1", Better::kMore, MeasureSource::kWeightTruth,
     "/precision"},
    {"weight_recall", "artist's influences that are there", "0 to 1", Better::kMore, MeasureSource::kWeightTruth,
     "/recall"},
    {"deform_mean", "surface's distance in random poses", "% of the diagonal", Better::kLess,
     MeasureSource::kWeightTruth, "/deform_mean"},
    {"deform_p95", "surface's distance in random poses, 95th percentile", "% of the diagonal", Better::kLess,
     MeasureSource::kWeightTruth, "/deform_p95"},
    {"joints_inside", "joints inside the body", "0 to 1", Better::kMore, MeasureSource::kModel, "/joints_inside"},
    {"joints_off_center", "joints off the middle of the body", "0 to 1", Better::kLess, MeasureSource::kModel,
     "/joints_off_center"},
    {"idle_joints", "joints that move nothing", "0 to 1", Better::kLess, MeasureSource::kModel, "/idle_joints",
     kAgreesTooLittle},
    {"coverage", "surface with a bone near", "0 to 1", Better::kMore, MeasureSource::kModel, "/coverage",
     kAgreesTooLittle},
    {"asymmetry", "joints without a mirror image", "% of the longest side", Better::kLess, MeasureSource::kModel,
     "/asymmetry", kAgreesTooLittle},
    {"weight_islands", "weights over gaps", "0 to 1", Better::kLess, MeasureSource::kModel, "/weight_islands",
     kAgreesTooLittle},
    {"influences", "joints that a vertex follows", "", Better::kLess, MeasureSource::kModel, "/influences",
     kAgreesTooLittle},
    {"roughness", "change of weights along edges", "0 to 2", Better::kLess, MeasureSource::kModel, "/roughness", true,
     kSameJoints},
    {"stretch", "stretch of the surface in motion", "share", Better::kLess, MeasureSource::kModelMotion,
     "/motion/stretch", true, kSameJoints},
    {"stretch_p95", "stretch of the surface in motion, 95th percentile", "share", Better::kLess,
     MeasureSource::kModelMotion, "/motion/stretch_p95", true, kSameJoints},
    {"texture_stretch", "stretch of the texture in motion", "share", Better::kLess, MeasureSource::kModelMotion,
     "/motion/texture_stretch", kAgreesTooLittle},
    {"volume_loss", "volume lost in motion", "share", Better::kLess, MeasureSource::kModelMotion, "/motion/volume_loss",
     kAgreesTooLittle},
    {"pose_penetration", "vertices that go into the body in motion", "0 to 1", Better::kLess,
     MeasureSource::kModelMotion, "/motion/self_penetration", kAgreesTooLittle},
    {"bone_direction", "angle between bones", "degrees", Better::kLess, MeasureSource::kMotion,
     "/bone_direction_degrees"},
    {"end_effector", "hands and feet off", "limb lengths", Better::kLess, MeasureSource::kMotion,
     "/end_effector_share"},
    {"contact_agreement", "planted where the source is", "0 to 1", Better::kMore, MeasureSource::kMotion,
     "/contact_agreement"},
    {"sliding", "speed of planted feet", "heights/s", Better::kLess, MeasureSource::kMotion,
     "/sliding_heights_per_second"},
    {"penetration", "feet below the ground", "heights", Better::kLess, MeasureSource::kMotion, "/penetration_heights"},
    {"jerk_ratio", "jerk against the source's", "ratio", Better::kLess, MeasureSource::kMotion, "/joint_jerk_ratio"},
    {"self_penetration", "vertices inside the body", "0 to 1", Better::kLess, MeasureSource::kMotion,
     "/self_penetration_share"},
    {"joints", "joints", "", Better::kNeither, MeasureSource::kRigReport, "/counts/joints"},
    {"seconds", "time", "s", Better::kLess, MeasureSource::kClock, ""},
};

}  // namespace

bool includes(MeasureSource figures, const Measure& measure) {
  return measure.source == figures ||
         (figures == MeasureSource::kModel && measure.source == MeasureSource::kModelMotion);
}

std::span<const Measure> studyMeasures() {
  return kMeasures;
}

const Measure& findMeasure(std::string_view name) {
  return findByName(kMeasures, "measure", name);
}

std::vector<MeasuredValue> measuresIn(const Json& figures, MeasureSource source) {
  std::vector<MeasuredValue> values;
  for (const Measure& measure : kMeasures) {
    if (!includes(source, measure)) continue;
    const Json::json_pointer location{std::string(measure.pointer)};
    if (!figures.contains(location) || !figures[location].is_number()) continue;
    const double value = figures[location].get<double>();
    if (std::isfinite(value)) values.push_back({&measure, value});
  }
  return values;
}

}  // namespace limber
