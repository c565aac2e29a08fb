#include "limber/samples/flying.h"

#include <cmath>
#include <string>
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/rig/rig_io.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/samples/model_builder.h"
#include "limber/samples/model_recipe.h"
#include "limber/skeleton/placed_skeleton.h"

namespace limber {

namespace {

struct JointStart {
  const char *name, *parent;
  Vec3 position;  // metres; of a side's joints the left one's
};

constexpr const char* kHips = "hips";
const JointStart kFlyingTrunk[] = {
    {kHips, "", {0, 0.370, -0.180}},          {"spine", "hips", {0, 0.395, -0.040}},
    {"chest", "spine", {0, 0.420, 0.100}},    {"neck", "chest", {0, 0.510, 0.230}},
    {"neck_2", "neck", {0, 0.610, 0.285}},    {"head", "neck_2", {0, 0.720, 0.310}},
    {"head_end", "head", {0, 0.705, 0.475}},  {"tail", "hips", {0, 0.350, -0.300}},
    {"tail_2", "tail", {0, 0.260, -0.430}},   {"tail_3", "tail_2", {0, 0.185, -0.600}},
    {"tail_4", "tail_3", {0, 0.200, -0.775}}, {"tail_end", "tail_4", {0, 0.310, -0.930}}};
const JointStart kFlyingSides[] = {{"wing_upper", "chest", {0.070, 0.490, 0.060}},
                                   {"wing_lower", "wing_upper", {0.235, 0.640, 0.000}},
                                   {"wing_hand", "wing_lower", {0.420, 0.770, 0.060}},
                                   {"finger_1", "wing_hand", {0.600, 0.774, 0.012}},
                                   {"finger_1_end", "finger_1", {0.850, 0.780, -0.055}},
                                   {"finger_2", "wing_hand", {0.548, 0.714, -0.060}},
                                   {"finger_2_end", "finger_2", {0.728, 0.636, -0.228}},
                                   {"finger_3", "wing_hand", {0.452, 0.670, -0.096}},
                                   {"finger_3_end", "finger_3", {0.494, 0.532, -0.310}},
                                   {"arm_upper", "chest", {0.090, 0.370, 0.130}},
                                   {"arm_lower", "arm_upper", {0.125, 0.225, 0.120}},
                                   {"hand", "arm_lower", {0.130, 0.070, 0.150}},
                                   {"hand_end", "hand", {0.132, 0.025, 0.225}},
                                   {"leg_upper", "hips", {0.092, 0.335, -0.205}},
                                   {"leg_lower", "leg_upper", {0.122, 0.235, -0.155}},
                                   {"foot", "leg_lower", {0.130, 0.150, -0.225}},
                                   {"toes", "foot", {0.132, 0.060, -0.195}},
                                   {"toes_end", "toes", {0.134, 0.025, -0.120}}};

Skeleton flyingSkeleton() {
  PlacedSkeleton skeleton;
  const auto add = [&](const JointStart& start, const std::string& suffix, double side) {
    skeleton.add(start.name + suffix, skeleton.has(start.parent) ? start.parent : start.parent + suffix,
                 {side * start.position.x(), start.position.y(), start.position.z()});
  };
  for (const JointStart& start : kFlyingTrunk) add(start, "", 1);
  for (const JointStart& start : kFlyingSides) add(start, ".L", 1);
  for (const JointStart& start : kFlyingSides) add(start, ".R", -1);
  return skeleton.take();
}

// A swing about one axis: the joint's mean angle, and how far it goes to and fro with the wings; radians.
struct Swing {
  const char* joint;
  Vec3 axis;             // of a side's joints the left one's
  double center, swing;  // about it
  double lag;            // behind the wings' roots, of a beat
};

constexpr double kBeat = 0.9;      // seconds
constexpr double kAltitude = 0.6;  // metres above the ground where it was bound
constexpr double kHeave = 0.045;   // metres, of the body: down as the wings go up
constexpr int kFrames = 27;        // of a beat, at 30 frames a second

const Vec3 kPitch = Vec3::UnitX(), kYaw = Vec3::UnitY(), kRoll = Vec3::UnitZ();
const Swing kMiddleSwings[] = {{"spine", kPitch, 0.02, 0.03, 0.10},  {"chest", kPitch, -0.05, 0.05, 0.0},
                               {"neck", kPitch, 0.30, -0.05, 0.05},  {"neck_2", kPitch, 0.12, -0.04, 0.10},
                               {"head", kPitch, -0.38, 0.04, 0.10},  {"tail", kPitch, 0.25, 0.07, 0.10},
                               {"tail_2", kPitch, 0.10, 0.09, 0.20}, {"tail_3", kPitch, -0.05, 0.11, 0.30},
                               {"tail_4", kPitch, -0.05, 0.13, 0.40}};
// Two turns of a joint follow each other in this order.
const Swing kSideSwings[] = {{"wing_upper", kRoll, -0.20, 0.62, 0.0},  {"wing_upper", kYaw, 0.10, 0.16, 0.25},
                             {"wing_lower", kRoll, -0.10, 0.30, 0.14}, {"wing_hand", kRoll, -0.12, 0.36, 0.24},
                             {"finger_1", kRoll, -0.02, 0.14, 0.30},   {"finger_2", kRoll, -0.02, 0.14, 0.32},
                             {"finger_3", kRoll, 0.0, 0.10, 0.32},     {"arm_upper", kPitch, 0.70, 0.05, 0.1},
                             {"arm_lower", kPitch, -1.00, 0.06, 0.1},  {"hand", kPitch, 0.60, 0.06, 0.1},
                             {"leg_upper", kPitch, 0.75, 0.05, 0.15},  {"leg_lower", kPitch, 0.45, 0.05, 0.15},
                             {"foot", kPitch, -0.35, 0.05, 0.2},       {"toes", kPitch, 0.65, 0.05, 0.2}};

void turn(const Skeleton& skeleton, const std::string& joint, const Vec3& axis, double angle, Pose& pose) {
  Quat& rotation = pose.locals[skeleton.find(joint).value()].rotation;
  rotation = Quat(Eigen::AngleAxisd(angle, axis)) * rotation;
}

// `beat` 0 to 1, wings at their highest at 0.
Pose flyingAt(const Skeleton& skeleton, double beat) {
  const auto angleOf = [&](const Swing& swing) {
    return swing.center + swing.swing * std::cos(2 * kPi * (beat - swing.lag));
  };
  Pose pose = restPose(skeleton);
  pose.locals[skeleton.find(kHips).value()].translation.y() += kAltitude - kHeave * std::cos(2 * kPi * (beat - 0.08));
  for (const Swing& swing : kMiddleSwings) turn(skeleton, swing.joint, swing.axis, angleOf(swing), pose);
  for (const Swing& swing : kSideSwings) {
    const double angle = angleOf(swing);
    turn(skeleton, std::string(swing.joint) + ".L", swing.axis, angle, pose);
    const bool staysInMirror = swing.axis == kPitch;  // turns about x are their own mirror images
    turn(skeleton, std::string(swing.joint) + ".R", swing.axis, staysInMirror ? angle : -angle, pose);
  }
  return pose;
}

Clip flight(const Skeleton& skeleton) {
  Clip clip;
  clip.name = "fly";
  Track<Vec3f>& heave = clip.translations.emplace_back();
  heave.joint = skeleton.find(kHips).value();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].name.find("_end") == std::string::npos) clip.rotations.emplace_back().joint = j;
  }
  for (int f = 0; f <= kFrames; ++f) {
    const float seconds = static_cast<float>(kBeat * f / kFrames);
    const Pose pose = flyingAt(skeleton, static_cast<double>(f % kFrames) / kFrames);
    heave.times.push_back(seconds);
    heave.values.push_back(pose.locals[heave.joint].translation.cast<float>());
    for (auto& track : clip.rotations) {
      track.times.push_back(seconds);
      track.values.push_back(pose.locals[track.joint].rotation.normalized().cast<float>());
    }
  }
  return clip;
}

SkinWeights weightsFor(const Geometry& geometry, const Skeleton& skeleton) {
  const PreparedMesh prepared = prepareGeometry(geometry, geometry.triangles);
  std::vector<Bone> bones = bonesOf(skeleton);
  for (Bone& bone : bones) {
    bone.a = prepared.frame.toWorking(bone.a);
    bone.b = prepared.frame.toWorking(bone.b);
  }
  Progress progress;
  const WeightResult skin = findWeightMethod("bone-heat").compute(prepared.mesh, bones, {}, progress);
  return expandWeights(skin.weights, prepared.weldedVertex);
}

}  // namespace

Asset makeFlying() {
  Asset asset = modelOf(wingedCharacter());
  asset.name = "flying";
  const Geometry geometry = collectGeometry(asset);
  const Skeleton skeleton = flyingSkeleton();
  attachRig(asset, geometry, skeleton, weightsFor(geometry, skeleton));
  const AssetSkeleton rig = readSkeleton(asset);
  const Clip clip = flight(rig.skeleton);
  addClips(asset, rig, {&clip, 1});
  return asset;
}

}  // namespace limber
