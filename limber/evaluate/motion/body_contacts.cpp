#include "limber/evaluate/motion/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "limber/core/text/numbers.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {

namespace {

constexpr double kTrunkRadius = 0.3, kHeadRadius = 0.4, kThighRadius = 0.16, kForearmRadius = 0.13;
constexpr double kPalm = 0.1;        // of a hand's thickness at the wrist's joint, over the forearm's length
constexpr std::size_t kMoving = 30;  // frames into the pose and back
constexpr double kFramesPerSecond = 30;

// A point on the surface: along a bone, and about it from ahead (+Z of the bone's joint) to the left (+X), radians.
struct SurfaceAnchor {
  std::string from, to;
  double along = 0, about = 0;
  double radius = 0;  // over the bone's length; of the trunk over the shoulders' distance
};

struct ContactGoal {
  std::string side;  // of the hand
  SurfaceAnchor point;
};

struct ContactRecipe {
  BodyContact contact;
  std::vector<ContactGoal> goals;  // in the order in which arms are solved
  double thighs = 0, stoop = 0;    // raised and bent forward, radians
};

std::vector<ContactRecipe> recipes() {
  const double quarter = kPi / 2;
  return {{{"hands-on-hips", {true, true}},
           {{"left", {"hips", "chest", 0.15, quarter, kTrunkRadius}},
            {"right", {"hips", "chest", 0.15, -quarter, kTrunkRadius}}}},
          {{"crossed-arms", {true, true}},
           {{"right", {"chest", "neck", 0.1, 0.6, kTrunkRadius}},
            {"left", {"rightLowerArm", "rightHand", 0.35, 0, kForearmRadius}}}},
          {{"hands-together", {true, true}},
           {{"right", {"chest", "neck", 0.1, 0.0, 2.2 * kTrunkRadius}},
            {"left", {"rightHand", "rightFingers", 0.0, 0, kForearmRadius}}}},
          {{"chin-on-hand", {true, false}}, {{"left", {"neck", "head", 0.6, 0.3, kHeadRadius}}}},
          {{"hand-on-knee", {true, true}},
           {{"left", {"leftUpperLeg", "leftLowerLeg", 0.85, 0, kThighRadius}},
            {"right", {"rightUpperLeg", "rightLowerLeg", 0.85, 0, kThighRadius}}},
           1.35,
           0.7}};
}

void addJoint(Skeleton& body, const std::string& name, const std::string& parent, const Vec3& position) {
  Joint joint;
  joint.name = name;
  if (!parent.empty()) joint.parent = body.find(parent);
  joint.rest.translation = position;
  body.joints.push_back(joint);
}

Index jointOf(const Skeleton& body, const std::string& name) {
  return body.find(name).value();
}

double shouldersApart(const Skeleton& body) {
  const std::vector<Vec3> rest = restPositions(body);
  return (rest[jointOf(body, "leftUpperArm")] - rest[jointOf(body, "rightUpperArm")]).norm();
}

Vec3 positionOf(const SurfaceAnchor& point, const Skeleton& body, const std::vector<Affine>& globals) {
  const Index from = jointOf(body, point.from), to = jointOf(body, point.to);
  const Vec3 a = globals[from].translation(), bone = globals[to].translation() - a;
  const bool ofTrunk = point.from == "hips" || point.from == "chest";
  const double hand =
      kPalm *
      (restPositions(body)[jointOf(body, "leftHand")] - restPositions(body)[jointOf(body, "leftLowerArm")]).norm();
  const double radius = point.radius * (ofTrunk ? shouldersApart(body) : bone.norm()) + hand;
  const Quat turn(globals[from].rotation());
  Vec3 out = turn * Vec3(std::sin(point.about), 0, std::cos(point.about));
  out = (out - out.dot(bone) / bone.squaredNorm() * bone).normalized();
  return a + point.along * bone + radius * out;
}

// With the elbow down and out, as people hold it.
void reach(const Skeleton& body, const std::string& side, const Vec3& goal, Pose& pose) {
  const Index upper = jointOf(body, side + "UpperArm"), lower = jointOf(body, side + "LowerArm"),
              hand = jointOf(body, side + "Hand");
  const std::vector<Affine> globals = poseGlobals(body, pose);
  TwoBone bones{globals[upper].translation(), globals[lower].translation(), globals[hand].translation(), goal, {}, {}};
  const double out = side == "left" ? 1 : -1;
  bones.pole = bones.start + Vec3(out, -0.7, -0.6);
  const TwoBoneTurns turns = solveTwoBone(bones);
  const auto turnTo = [&](Index joint, const Quat& turned, const Quat& above) {
    pose.locals[joint].rotation = (above.conjugate() * turned).normalized();
  };
  const Quat shoulder(globals[*body.joints[upper].parent].rotation());
  const Quat upperTurned = turns.start * Quat(globals[upper].rotation());
  turnTo(upper, upperTurned, shoulder);
  turnTo(lower, turns.middle * Quat(globals[lower].rotation()), upperTurned);
}

Pose standing(const Skeleton& body) {
  Pose pose = restPose(body);
  for (const auto& [side, sign] : {std::pair{"left", 1.0}, std::pair{"right", -1.0}}) {
    pose.locals[jointOf(body, std::string(side) + "UpperArm")].rotation =
        Eigen::AngleAxisd(-sign * 1.25, Vec3::UnitZ());
  }
  return pose;
}

Pose touching(const Skeleton& body, const ContactRecipe& recipe) {
  Pose pose = standing(body);
  pose.locals[jointOf(body, "spine")].rotation = Eigen::AngleAxisd(recipe.stoop, Vec3::UnitX());
  for (const char* side : {"left", "right"}) {
    pose.locals[jointOf(body, std::string(side) + "UpperLeg")].rotation =
        Eigen::AngleAxisd(-recipe.thighs, Vec3::UnitX());
    pose.locals[jointOf(body, std::string(side) + "LowerLeg")].rotation =
        Eigen::AngleAxisd(recipe.thighs, Vec3::UnitX());
  }
  if (recipe.thighs > 0) {
    const std::vector<Vec3> posed = posePositions(body, pose), rest = restPositions(body);
    const Index foot = jointOf(body, "leftFoot");
    pose.locals[0].translation.y() += rest[foot].y() - posed[foot].y();
  }
  for (const ContactGoal& goal : recipe.goals) {
    reach(body, goal.side, positionOf(goal.point, body, poseGlobals(body, pose)), pose);
  }
  return pose;
}

Pose between(const Pose& one, const Pose& other, double fraction) {
  Pose pose = one;
  for (std::size_t j = 0; j < pose.locals.size(); ++j) {
    pose.locals[j].rotation = one.locals[j].rotation.slerp(fraction, other.locals[j].rotation);
    pose.locals[j].translation += fraction * (other.locals[j].translation - one.locals[j].translation);
  }
  return pose;
}

ContactRecipe recipeOf(const BodyContact& contact) {
  for (const ContactRecipe& recipe : recipes()) {
    if (recipe.contact.name == contact.name) return recipe;
  }
  return recipes().front();
}

}  // namespace

Skeleton contactFigure(const FigureShape& shape) {
  Skeleton body;
  const double leg = 0.42 * shape.legs, ankle = 0.09;
  addJoint(body, "hips", "", Vec3(0, 2 * leg + ankle + 0.06, 0));
  addJoint(body, "spine", "hips", Vec3(0, 0.12 * shape.trunk, 0));
  addJoint(body, "chest", "spine", Vec3(0, 0.15 * shape.trunk, 0));
  addJoint(body, "neck", "chest", Vec3(0, 0.23 * shape.trunk, 0));
  addJoint(body, "head", "neck", Vec3(0, 0.09, 0.01));
  addJoint(body, "headTop_end", "head", Vec3(0, 0.2, 0));
  for (const auto& [side, x] : {std::pair{std::string("left"), 1.0}, std::pair{std::string("right"), -1.0}}) {
    addJoint(body, side + "Shoulder", "chest", Vec3(0.03 * x * shape.shoulders, 0.19 * shape.trunk, 0));
    addJoint(body, side + "UpperArm", side + "Shoulder", Vec3(0.15 * x * shape.shoulders, 0, 0));
    addJoint(body, side + "LowerArm", side + "UpperArm", Vec3(0.28 * x * shape.arms, 0, 0));
    addJoint(body, side + "Hand", side + "LowerArm", Vec3(0.26 * x * shape.arms, 0, 0));
    addJoint(body, side + "Fingers", side + "Hand", Vec3(0.09 * x * shape.arms, 0, 0));
    addJoint(body, side + "UpperLeg", "hips", Vec3(0.09 * x * shape.hips, -0.06, 0));
    addJoint(body, side + "LowerLeg", side + "UpperLeg", Vec3(0, -leg, 0.004));
    addJoint(body, side + "Foot", side + "LowerLeg", Vec3(0, -leg, -0.004));
    addJoint(body, side + "Toes", side + "Foot", Vec3(0, 0.02 - ankle, 0.13));
  }
  return body;
}

std::vector<FigureShape> contactFigures() {
  std::vector<FigureShape> figures = {{}};
  for (const double factor : {0.8, 1.25}) {
    figures.push_back({factor, 1, 1, 1, 1});
    figures.push_back({1, factor, 1, 1, 1});
    figures.push_back({1, 1, factor, 1, 1});
    figures.push_back({1, 1, 1, factor, factor});
    figures.push_back({factor, factor, 1, 1, 1});
    figures.push_back({1, factor, 1, 1 / factor, 1});
    figures.push_back({factor, 1, 1 / factor, 1 / factor, 1 / factor});
  }
  return figures;
}

std::array<BodyContact, 5> bodyContacts() {
  std::array<BodyContact, 5> contacts;
  const std::vector<ContactRecipe> all = recipes();
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = all[i].contact;
  return contacts;
}

PoseSequence contactMotion(const Skeleton& figure, const BodyContact& contact) {
  const Pose from = standing(figure), to = touching(figure, recipeOf(contact));
  PoseSequence motion;
  motion.frameSeconds = 1 / kFramesPerSecond;
  const auto move = [&](const Pose& one, const Pose& other) {
    for (std::size_t f = 0; f < kMoving; ++f) {
      const double t = static_cast<double>(f) / kMoving;
      motion.poses.push_back(between(one, other, t * t * t * (10 - 15 * t + 6 * t * t)));
    }
  };
  move(from, to);
  motion.poses.insert(motion.poses.end(), kHoldFrames, to);
  move(to, from);
  motion.poses.push_back(from);
  return motion;
}

ContactScore scoreContact(const RetargetMethod& method, const BodyContact& contact) {
  const ContactRecipe recipe = recipeOf(contact);
  const Skeleton source = contactFigure({});
  const PoseSequence motion = contactMotion(source, contact);
  ContactScore score;
  for (const FigureShape& shape : contactFigures()) {
    const Skeleton body = contactFigure(shape);
    const RetargetSetup setup(source, body, matchSkeletons(source, body), {}, &motion);
    const PoseSequence result = retargetFrames(method, setup, motion);
    const std::vector<Affine> globals = poseGlobals(body, result.poses[kMoving + kHoldFrames / 2]);
    const std::vector<Vec3> rest = restPositions(body);
    const double height = rest[jointOf(body, "headTop_end")].y();
    for (const ContactGoal& goal : recipe.goals) {
      const Index upper = jointOf(body, goal.side + "UpperArm"), hand = jointOf(body, goal.side + "Hand");
      const Vec3 shoulder = globals[upper].translation(), position = positionOf(goal.point, body, globals);
      const double arm = 0.54 * shape.arms, far = (position - shoulder).norm();
      const double off = (globals[hand].translation() - position).norm() / height;
      if (far <= arm) {
        ++score.reached;
        score.kept += off < kKept;
        score.worst = std::max(score.worst, off);
      } else {
        ++score.farReached;
        score.farWorst = std::max(score.farWorst, off - (far - arm) / height);
      }
    }
  }
  return score;
}

}  // namespace limber
