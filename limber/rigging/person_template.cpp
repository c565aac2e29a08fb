#include "limber/rigging/person_template.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/rigging/templates/joints_between.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 9> kNeeded = {"hips",          "leftUpperArm",  "rightUpperArm",
                                                     "leftLowerArm",  "rightLowerArm", "leftUpperLeg",
                                                     "rightUpperLeg", "leftLowerLeg",  "rightLowerLeg"};

constexpr double kTrunk = 0.28;                // of the humanoid, from its legs' upper joints to its arms'
constexpr double kBeyondFingers = 1.15;        // ends of fingers, in distances from the hand to their last joint
constexpr double kAlike = 0.7, kSquare = 0.5;  // cosines between arms and legs, trunk and legs

const TemplateSkeleton& humanoid() {
  return findTemplate("humanoid");
}

bool isFinger(std::string_view bone) {
  constexpr std::array<std::string_view, 4> kFingers = {"Index", "Middle", "Ring", "Little"};
  return std::any_of(kFingers.begin(), kFingers.end(),
                     [&](std::string_view finger) { return bone.find(finger) != std::string_view::npos; });
}

std::optional<Index> playing(const PersonTemplate& person, std::string_view bone) {
  const std::optional<Index> sought = humanoid().find(bone);
  const auto found = std::find(person.humanoidJoint.begin(), person.humanoidJoint.end(), sought);
  return found == person.humanoidJoint.end() ? std::nullopt
                                             : std::optional(static_cast<Index>(found - person.humanoidJoint.begin()));
}

// Ends of limbs, and the tips of the humanoid there.
struct LimbEnd {
  std::string_view tip;
  std::array<std::string_view, 2> ends;  // it hangs on the first that there is
  bool isHand;
};
constexpr std::array<LimbEnd, 5> kEnds = {{{"headTip", {"head", "neck"}, false},
                                           {"leftHandTip", {"leftHand", "leftLowerArm"}, true},
                                           {"rightHandTip", {"rightHand", "rightLowerArm"}, true},
                                           {"leftToesTip", {"leftToes", "leftFoot"}, false},
                                           {"rightToesTip", {"rightToes", "rightFoot"}, false}}};

// From the middle between the legs' upper joints to that between the arms'.
Vec3 trunkOf(const PersonTemplate& person) {
  Vec3 trunk = Vec3::Zero();
  for (const std::string side : {"left", "right"}) {
    trunk += 0.5 * (person.skeleton.joints[*playing(person, side + "UpperArm")].position -
                    person.skeleton.joints[*playing(person, side + "UpperLeg")].position);
  }
  return trunk;
}

// Arms and legs run alike, square to the trunk: an animal's, whose front legs end in what is called a hand.
bool onAllFours(const PersonTemplate& person) {
  const auto positionOf = [&](const std::string& bone) {
    return person.skeleton.joints[*playing(person, bone)].position;
  };
  Vec3 arms = Vec3::Zero(), legs = Vec3::Zero();
  for (const std::string side : {"left", "right"}) {
    arms += positionOf(side + "LowerArm") - positionOf(side + "UpperArm");
    legs += positionOf(side + "LowerLeg") - positionOf(side + "UpperLeg");
  }
  const Vec3 trunk = trunkOf(person).normalized();
  arms.normalize();
  legs.normalize();
  return arms.dot(legs) > kAlike && std::abs(trunk.dot(legs)) < kSquare;
}

// Rows: left, up and front as the limbs tell them. None where they all lie in a line.
std::optional<Mat3> standingAxes(const PersonTemplate& person) {
  const auto positionOf = [&](const std::string& bone) {
    return person.skeleton.joints[*playing(person, bone)].position;
  };
  Vec3 left = Vec3::Zero();
  for (const std::string limb : {"UpperArm", "UpperLeg"})
    left += positionOf("left" + limb) - positionOf("right" + limb);
  const Vec3 up = trunkOf(person).normalized();
  left -= left.dot(up) * up;
  if (!(up.norm() > 0.5 && left.norm() > 1e-6)) return std::nullopt;
  left.normalize();
  Mat3 axes;
  axes << left.transpose(), up.transpose(), left.cross(up).transpose();
  return axes;
}

// The joint that is farthest from the hand of those that play a finger's bone and hang on it.
std::optional<Index> fingerEnd(const PersonTemplate& person, Index hand, const std::vector<Index>& fingers) {
  std::optional<Index> end;
  double farthest = 0;
  for (const Index finger : fingers) {
    std::optional<Index> above = finger;
    while (above && *above != hand) above = person.skeleton.joints[*above].parent;
    const double reach = (person.skeleton.joints[finger].position - person.skeleton.joints[hand].position).norm();
    if (!above || reach <= farthest) continue;
    farthest = reach;
    end = finger;
  }
  return end;
}

// Tips as the humanoid has them, as large as the trunk; hands' in the direction of the fingers or of the forearm.
void addTips(PersonTemplate& person, const std::vector<Index>& fingers) {
  const std::vector<TemplateJoint>& known = humanoid().joints;
  const double scale = trunkOf(person).norm() / kTrunk;
  for (const LimbEnd& end : kEnds) {
    const std::optional<Index> last = playing(person, end.ends[0]);
    const std::optional<Index> joint = last ? last : playing(person, end.ends[1]);
    if (!joint) continue;
    const TemplateJoint& from = person.skeleton.joints[*joint];
    const Index tipJoint = *humanoid().find(end.tip);
    TemplateJoint tip;
    tip.name = from.name + " tip";
    tip.parent = joint;
    tip.role = TemplateRole::kTip;
    Vec3 reach = scale * (known[tipJoint].position - known[*person.humanoidJoint[*joint]].position);
    if (!end.isHand) {
      // as it is
    } else if (const std::optional<Index> finger = fingerEnd(person, *joint, fingers)) {
      reach = kBeyondFingers * (person.skeleton.joints[*finger].position - from.position);
    } else if (from.parent) {
      reach = reach.norm() * (from.position - person.skeleton.joints[*from.parent].position).normalized();
    }
    tip.position = from.position + reach;
    person.skeleton.joints.push_back(std::move(tip));
    person.humanoidJoint.push_back(tipJoint);
  }
}

}  // namespace

std::optional<PersonTemplate> personTemplate(const Skeleton& skeleton, const TemplateSkeleton& own) {
  const std::vector<HumanoidJoint> bones = humanoidJoints(skeleton);
  PersonTemplate person;
  person.skeleton = {own.name, own.summary, {}};
  std::vector<std::optional<Index>> kept(own.jointCount());
  std::vector<Index> fingers;
  for (Index j = 0; j < own.jointCount(); ++j) {
    TemplateJoint joint = own.joints[j];
    if (joint.role == TemplateRole::kTip) continue;
    const auto bone =
        std::find_if(bones.begin(), bones.end(), [&](const HumanoidJoint& each) { return each.joint == j; });
    const std::optional<Index> part = bone == bones.end() ? std::nullopt : humanoid().find(bone->bone);
    kept[j] = person.skeleton.jointCount();
    if (bone != bones.end() && isFinger(bone->bone)) fingers.push_back(*kept[j]);
    if (joint.parent) joint.parent = kept[*joint.parent];
    joint.role = part ? TemplateRole::kPlaced : TemplateRole::kBetween;
    joint.mirror.reset();
    person.skeleton.joints.push_back(std::move(joint));
    person.humanoidJoint.push_back(part);
  }
  for (const std::string_view bone : kNeeded) {
    if (!playing(person, bone)) return std::nullopt;
  }
  const std::optional<Mat3> axes = standingAxes(person);
  if (!axes || onAllFours(person)) return std::nullopt;
  double ground = 0;
  for (TemplateJoint& joint : person.skeleton.joints) {
    joint.position = *axes * joint.position;
    ground = std::min(ground, joint.position.y());
  }
  for (TemplateJoint& joint : person.skeleton.joints) joint.position.y() -= ground;
  addTips(person, fingers);
  return person;
}

std::vector<Vec3> placePerson(const PersonTemplate& person, const std::vector<Vec3>& fitted, const TemplatePins& pins) {
  TemplateSkeleton skeleton = person.skeleton;
  std::vector<Vec3> positions(skeleton.jointCount(), Vec3::Zero());
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (person.humanoidJoint[j]) positions[j] = fitted[*person.humanoidJoint[j]];
    if (!pins[j]) continue;
    positions[j] = *pins[j];
    skeleton.joints[j].role = TemplateRole::kPlaced;
  }
  placeBetween(skeleton, positions);
  return positions;
}

std::vector<JointPin> humanoidPins(const PersonTemplate& person, const std::vector<JointPin>& pins) {
  std::vector<JointPin> result;
  for (const JointPin& pin : pins) {
    const std::optional<Index> joint = person.skeleton.find(pin.joint);
    if (joint && person.humanoidJoint[*joint]) {
      result.push_back({humanoid().joints[*person.humanoidJoint[*joint]].name, pin.position});
    }
  }
  return result;
}

TemplateSkeleton humanoidNamedAs(const PersonTemplate& person, TemplateSkeleton humanoid) {
  for (Index j = 0; j < person.skeleton.jointCount(); ++j) {
    if (person.humanoidJoint[j]) humanoid.joints[*person.humanoidJoint[j]].name = person.skeleton.joints[j].name;
  }
  humanoid.name = person.skeleton.name;
  return humanoid;
}

}  // namespace limber
