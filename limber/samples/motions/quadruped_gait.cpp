// Gaits of an animal on four legs, for skeletons of the template quadruped. Footfalls after Hildebrand (The quadrupedal
// gaits of vertebrates, 1989) and Alexander (2003): in the walk (lateral sequence) left hind, left front, right hind
// and right front leg follow each other by a quarter of a stride, in the trot diagonal pairs go together, and in the
// transverse gallop the hind legs touch one after the other, then the front legs, then the body flies, gathered.
#include <cmath>
#include <string>

#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/smooth_path.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {

const QuadrupedGait kQuadrupedWalk = {.seconds = 0.9,
                                      .stride = 0.20,
                                      .dutyFactor = 0.65,
                                      .leftHind = 0,
                                      .leftFront = 0.25,
                                      .rightHind = 0.5,
                                      .rightFront = 0.75,
                                      .onGround = 1,
                                      .bounces = 2,
                                      .lift = 0.022,
                                      .sinks = 0.018,
                                      .bob = 0.003,
                                      .sway = 0.004,
                                      .swing = 0.06,
                                      .rock = 0,
                                      .flex = 0};

// 1 m/s.
const QuadrupedGait kTrot = {.seconds = 0.45,
                             .stride = 0.42,
                             .dutyFactor = 0.44,
                             .leftHind = 0,
                             .leftFront = 0.5,
                             .rightHind = 0.5,
                             .rightFront = 0,
                             .onGround = 0.88,
                             .bounces = 2,
                             .lift = 0.055,
                             .sinks = 0.034,
                             .bob = 0,
                             .sway = 0.002,
                             .swing = 0.05,
                             .rock = 0,
                             .flex = 0};

// 1.8 m/s.
const QuadrupedGait kGallop = {.seconds = 0.4,
                               .stride = 0.72,
                               .dutyFactor = 0.26,
                               .leftHind = 0,
                               .leftFront = 0.40,
                               .rightHind = 0.11,
                               .rightFront = 0.52,
                               .onGround = 0.78,
                               .bounces = 1,
                               .lift = 0.06,
                               .sinks = 0.05,
                               .bob = 0,
                               .sway = 0,
                               .swing = 0,
                               .rock = 0.10,
                               .flex = 0.14};

namespace {

constexpr double kHalfTrunk = 0.16;  // metres: from the hips to the middle that the trunk rocks about

struct QuadrupedBone {
  const char *name, *parent;
  Vec3 position;  // metres; of a side's bones the left one's
};

const QuadrupedBone kQuadrupedTrunk[] = {{"hips", "", {0, 0.367, -0.17}},       {"spine", "hips", {0, 0.352, -0.076}},
                                         {"spine1", "spine", {0, 0.35, 0.018}}, {"chest", "spine1", {0, 0.345, 0.112}},
                                         {"neck", "chest", {0, 0.42, 0.212}},   {"neck1", "neck", {0, 0.485, 0.24}},
                                         {"head", "neck1", {0, 0.551, 0.268}},  {"tail", "hips", {0, 0.379, -0.235}},
                                         {"tail1", "tail", {0, 0.389, -0.39}},  {"tail2", "tail1", {0, 0.45, -0.5}}};
const QuadrupedBone kQuadrupedSides[] = {{"FrontShoulder", "chest", {0.041, 0.327, 0.138}},
                                         {"FrontUpperLeg", "FrontShoulder", {0.072, 0.291, 0.155}},
                                         {"FrontLowerLeg", "FrontUpperLeg", {0.075, 0.157, 0.159}},
                                         {"FrontFoot", "FrontLowerLeg", {0.076, 0.044, 0.171}},
                                         {"FrontToes", "FrontFoot", {0.076, 0.015, 0.175}},
                                         {"HindUpperLeg", "hips", {0.07, 0.345, -0.156}},
                                         {"HindLowerLeg", "HindUpperLeg", {0.07, 0.245, -0.125}},
                                         {"HindFoot", "HindLowerLeg", {0.08, 0.135, -0.201}},
                                         {"HindToes", "HindFoot", {0.081, 0.035, -0.173}}};

double sineWave(double phase) {
  return std::sin(2 * kPi * phase);
}

Quat turnAbout(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

// The fraction of a swing that has passed; outside 0 to 1 the leg is in stance.
double swingOf(const QuadrupedGait& gait, double phase) {
  return (phase - gait.dutyFactor) / (1 - gait.dutyFactor);
}

// How far the last bone leans forward over its toes, radians: increasing in stance, then back in the air.
double leanAt(const QuadrupedGait& gait, double phase, bool front) {
  constexpr double kFrontLeans = 0.54;  // fraction of its time on the ground after which a front foot begins to lean
  const double stood = phase / gait.dutyFactor, swing = swingOf(gait, phase);
  const double standing =
      front ? 0.45 * smoothRise((stood - kFrontLeans) / (1 - kFrontLeans)) : 0.5 * smoothRise(stood) - 0.2;
  const double most = front ? 0.45 : 0.5;
  return standing - most * smoothRise(swing) + (front ? 0.5 : 0.35) * smoothBump(swing);
}

// Of the toes, against where they are in rest pose on a body that has not moved.
Vec3 toesDisplacement(const QuadrupedGait& gait, double strides) {
  const double count = std::floor(strides), swing = swingOf(gait, strides - count);
  return {0, gait.lift * smoothBump(swing), (count + 0.5 * gait.dutyFactor + smoothRise(swing)) * gait.stride};
}

class FourLegs {
 public:
  FourLegs(const QuadrupedGait& gait, const Skeleton& skeleton, double seconds)
      : gait_(gait),
        skeleton_(skeleton),
        pose_(restPose(skeleton)),
        rest_(restGlobals(skeleton)),
        strides_(seconds / gait.seconds) {}

  Pose pose() {
    moveTrunk();
    globals_ = poseGlobals(skeleton_, pose_);
    moveLeg("leftHind", gait_.leftHind);
    moveLeg("leftFront", gait_.leftFront);
    moveLeg("rightHind", gait_.rightHind);
    moveLeg("rightFront", gait_.rightFront);
    return pose_;
  }

 private:
  Index joint(const std::string& name) const { return skeleton_.find(name).value(); }
  void turn(const char* name, double pitch, double yaw, double roll) {
    pose_.locals[joint(name)].rotation =
        turnAbout(Vec3::UnitY(), yaw) * turnAbout(Vec3::UnitX(), pitch) * turnAbout(Vec3::UnitZ(), roll);
  }

  double height() const {
    const double still = gait_.bob * sineWave(2 * strides_ + 0.1) - gait_.sinks;
    if (gait_.onGround == 1) return still;
    const double bounces = gait_.bounces * strides_;
    return still + bounceHeight(bounces - std::floor(bounces), gait_.onGround, gait_.seconds / gait_.bounces);
  }

  // The hips swing with the hind legs, the chest against them; the head and the tail follow. Nose down over the front
  // legs, up over the hind legs; the back is bent when the legs are gathered under it, before the hind legs touch.
  void moveTrunk() {
    const double swing = gait_.swing * sineWave(strides_ + 0.1), nod = sineWave(2 * strides_ - 0.1);
    const double rock = gait_.rock * sineWave(strides_ - 0.38), bend = gait_.flex * sineWave(strides_ + 0.33);
    const double steady = gait_.onGround < 1 ? 0.3 : 1;  // a body that flies holds its head still
    pose_.locals[0].translation +=
        Vec3(gait_.sway * sineWave(strides_ + 0.1), height() + kHalfTrunk * rock, gait_.stride * strides_);
    turn("hips", gait_.bob * 3.3 * sineWave(2 * strides_ + 0.1) + rock - bend, -swing, 0.7 * swing);
    turn("spine", 0.6 * bend, 0.7 * swing, -0.3 * swing);
    turn("spine1", 0.7 * bend, 0.7 * swing, -0.3 * swing);
    turn("chest", -gait_.bob * 3.3 * sineWave(2 * strides_ + 0.1) + 0.7 * bend, 0.3 * swing, 0);
    turn("neck", 0.03 * steady * nod - 0.6 * (rock + bend), -0.3 * swing, 0);
    turn("head", -0.03 * steady * sineWave(2 * strides_ - 0.15) - 0.4 * (rock + bend), -0.3 * swing, 0);
    turn("tail", 1.5 * bend, 2 * gait_.swing * sineWave(strides_ - 0.05), 0);
    turn("tail1", 0.8 * gait_.flex * sineWave(strides_ + 0.2), 2.3 * gait_.swing * sineWave(strides_ - 0.15), 0);
    turn("tail2", 0.8 * gait_.flex * sineWave(strides_ + 0.1), 2.7 * gait_.swing * sineWave(strides_ - 0.25), 0);
  }

  void moveLeg(const std::string& leg, double behind) {
    const bool front = leg.ends_with("Front");
    const double strides = strides_ - behind, phase = strides - std::floor(strides);
    const double lean = leanAt(gait_, phase, front);
    const Vec3 restDirection =
        rest_[joint(leg + "Toes")].translation() + toesDisplacement(gait_, strides) + Vec3(0, 0, behind * gait_.stride);
    // Flat while they stand, hanging a little in the air.
    const double toes = -lean * (1 - 0.7 * smoothBump(swingOf(gait_, phase)));
    placeQuadrupedLeg(skeleton_, leg, {restDirection, lean, toes}, rest_, globals_, pose_);
  }

  const QuadrupedGait& gait_;
  const Skeleton& skeleton_;
  Pose pose_;
  std::vector<Affine> rest_, globals_;
  double strides_;
};

}  // namespace

void placeQuadrupedLeg(const Skeleton& quadruped, const std::string& leg, const QuadrupedFoot& foot,
                       std::span<const Affine> rest, std::span<const Affine> globals, Pose& pose) {
  const auto joint = [&](const char* name) { return quadruped.find(leg + name).value(); };
  const Index upper = joint("UpperLeg"), lower = joint("LowerLeg"), ankle = joint("Foot"), toes = joint("Toes");
  const auto resting = [&](Index j) -> Vec3 { return rest[j].translation(); };
  const Quat leaning = turnAbout(Vec3::UnitX(), foot.lean);
  TwoBone bones;
  bones.start = globals[upper].translation();
  bones.middle = globals[lower].translation();
  bones.end = globals[ankle].translation();
  bones.target = foot.toes - leaning * Vec3(resting(toes) - resting(ankle));
  bones.pole = bones.start + Vec3(0, -0.1, leg.ends_with("Front") ? -1 : 1);
  const TwoBoneTurns turns = solveTwoBone(bones);
  const Quat above(globals[*quadruped.joints[upper].parent].linear()), body(globals[upper].linear());
  const Quat upperTurn = turns.start * body, lowerTurn = turns.middle * body;
  pose.locals[upper].rotation = above.conjugate() * upperTurn;
  pose.locals[lower].rotation = upperTurn.conjugate() * lowerTurn;
  pose.locals[ankle].rotation = lowerTurn.conjugate() * leaning;
  pose.locals[toes].rotation = turnAbout(Vec3::UnitX(), foot.toesTurn);
}

Skeleton quadrupedSkeleton() {
  Skeleton skeleton;
  std::vector<Vec3> positions;
  const auto add = [&](const std::string& prefix, double side, const QuadrupedBone& bone) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = prefix + bone.name;
    joint.parent = skeleton.find(bone.parent);
    if (!joint.parent) joint.parent = skeleton.find(prefix + bone.parent);
    positions.emplace_back(side * bone.position.x(), bone.position.y(), bone.position.z());
    joint.rest.translation = joint.parent ? Vec3(positions.back() - positions[*joint.parent]) : positions.back();
  };
  for (const QuadrupedBone& bone : kQuadrupedTrunk) add("", 1, bone);
  for (const QuadrupedBone& bone : kQuadrupedSides) add("left", 1, bone);
  for (const QuadrupedBone& bone : kQuadrupedSides) add("right", -1, bone);
  return skeleton;
}

Pose quadrupedGaitAt(const QuadrupedGait& gait, const Skeleton& quadruped, double seconds) {
  return FourLegs(gait, quadruped, seconds).pose();
}

}  // namespace limber
