// People under the names of a convention, with more or fewer joints and with attachments, made in code for tests.
#pragma once

#include <string>
#include <vector>

#include "limber/character/anatomy/names/naming_convention.h"
#include "limber/character/anatomy/testing/bodies.h"

namespace limber::testing {

struct PersonVariant {
  int spines = 3, necks = 1;
  bool fingers = false, toes = true, twists = false, leaves = false;
  bool skirt = false, hair = false, breasts = false, cape = false, ikTargets = false;
};

class ConventionPerson {
 public:
  ConventionPerson(const NamingConvention& convention, const PersonVariant& variant)
      : convention_(convention), variant_(variant) {}

  MadeBody make() {
    torso();
    for (const Side side : kSides) {
      arm(side);
      leg(side);
    }
    attachments();
    return std::move(body_);
  }

 private:
  static BodyPart center(PartKind kind, Segment segment = Segment::kWhole) {
    return {kind, Side::kCenter, 0, segment, 0};
  }

  std::string nameOf(JointRole role, Side side, std::size_t number = 0) const {
    return conventionName(convention_, role, side, number);
  }

  // Adds nothing where the convention has no such name: then the parent is used instead.
  std::string add(const std::string& name, const std::string& parent, const Vec3& at, const BodyPart& part) {
    if (name.empty()) return parent;
    body_.add(name, parent, at, part);
    return name;
  }

  void torso() {
    const bool isCounted = !nameOf(JointRole::kSpineToHead, Side::kCenter).empty();
    std::size_t count = 0;
    const auto centerName = [&](JointRole role, std::size_t number) {
      return isCounted ? nameOf(JointRole::kSpineToHead, Side::kCenter, count++) : nameOf(role, Side::kCenter, number);
    };
    std::string carrier;
    if (convention_.torso == TorsoTree::kLowerBodyBeside) {
      carrier = "carrier";
      body_.add(carrier, "", {0, 0.96, 0}, center(PartKind::kOther));
    }
    hips_ = add(centerName(JointRole::kHips, 0), carrier, {0, 0.95, 0}, center(PartKind::kTrunk, Segment::kBase));
    chest_ = convention_.torso == TorsoTree::kLowerBodyBeside ? carrier : hips_;
    for (int i = 0; i < variant_.spines; ++i) {
      chest_ = add(centerName(JointRole::kTrunk, static_cast<std::size_t>(i)), chest_,
                   {0, 1.05 + 0.3 * i / variant_.spines, 0}, center(PartKind::kTrunk));
    }
    std::string neck = chest_;
    for (int i = 0; i < variant_.necks; ++i) {
      neck = add(centerName(JointRole::kNeck, static_cast<std::size_t>(i)), neck, {0, 1.44 + 0.03 * i, 0},
                 center(PartKind::kNeck));
    }
    armsOn_ = convention_.torso == TorsoTree::kArmsOnNeck && variant_.necks > 0
                  ? nameOf(JointRole::kNeck, Side::kCenter)
                  : chest_;
    head_ = add(centerName(JointRole::kHead, 0), neck, {0, 1.55, 0.01}, center(PartKind::kHead));
    if (variant_.leaves) body_.add("HeadTop_end", head_, {0, 1.72, 0.01}, center(PartKind::kOther));
  }

  void arm(Side side) {
    const double x = side == Side::kLeft ? 1 : -1;
    const auto part = [&](Segment segment) { return body_part::arm(side, segment); };
    const std::string collar =
                          add(nameOf(JointRole::kCollar, side), armsOn_, {0.03 * x, 1.41, 0}, part(Segment::kBase)),
                      upper =
                          add(nameOf(JointRole::kUpperArm, side), collar, {0.17 * x, 1.42, 0}, part(Segment::kUpper)),
                      lower = add(nameOf(JointRole::kLowerArm, side), upper, {0.45 * x, 1.42, -0.01},
                                  part(Segment::kMiddle)),
                      hand = add(nameOf(JointRole::kHand, side), lower, {0.70 * x, 1.42, 0}, part(Segment::kEnd));
    if (variant_.twists) {
      body_.add(upper + "_twist", upper, {0.3 * x, 1.42, 0}, center(PartKind::kOther));
      body_.add(lower + "_twist", lower, {0.6 * x, 1.42, 0}, center(PartKind::kOther));
    }
    hands_.push_back(hand);
    if (!variant_.fingers) return;
    for (Index finger = 0; finger < 5; ++finger) {
      const auto role = static_cast<JointRole>(static_cast<Index>(JointRole::kThumb) + finger);
      std::string parent = hand;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::string name = nameOf(role, side, i);
        if (name.empty()) break;
        parent = add(name, parent, {(0.74 + 0.03 * static_cast<double>(i)) * x, 1.42, 0.05 - 0.025 * finger},
                     {PartKind::kFinger, side, finger, Segment::kWhole, static_cast<Index>(i)});
      }
      if (variant_.leaves && parent != hand)
        body_.add(parent + "_end", parent, {0.84 * x, 1.42, 0.05 - 0.025 * finger}, center(PartKind::kOther));
    }
  }

  void leg(Side side) {
    const double x = side == Side::kLeft ? 1 : -1;
    const auto part = [&](Segment segment) { return body_part::leg(side, segment); };
    const std::string base = add(nameOf(JointRole::kLegBase, side), hips_, {0.07 * x, 0.93, 0}, part(Segment::kBase)),
                      upper = add(nameOf(JointRole::kUpperLeg, side), base, {0.1 * x, 0.9, 0}, part(Segment::kUpper)),
                      lower =
                          add(nameOf(JointRole::kLowerLeg, side), upper, {0.1 * x, 0.5, 0.01}, part(Segment::kMiddle)),
                      foot = add(nameOf(JointRole::kFoot, side), lower, {0.1 * x, 0.09, -0.02}, part(Segment::kEnd));
    if (variant_.twists) body_.add(upper + "_twist", upper, {0.1 * x, 0.7, 0}, center(PartKind::kOther));
    feet_.push_back(foot);
    if (!variant_.toes) return;
    const std::string toes = add(nameOf(JointRole::kToes, side), foot, {0.1 * x, 0.02, 0.12}, part(Segment::kToes));
    if (variant_.leaves) body_.add(toes + "_end", toes, {0.1 * x, 0.02, 0.18}, center(PartKind::kOther));
  }

  void chain(const std::string& stem, int links, const std::string& carrier, const Vec3& at, const Vec3& step) {
    addChain(body_, stem, links, carrier, at, step, center(PartKind::kOther));
  }

  void attachments() {
    for (const Side side : kSides) {
      const double x = side == Side::kLeft ? 1 : -1;
      const std::string tag = side == Side::kLeft ? "_L_" : "_R_";
      if (variant_.skirt) {
        chain("J_Sec_Skirt" + tag, 3, hips_, {0.1 * x, 0.93, 0.09}, {0, -0.13, 0});
        chain("J_Sec_SkirtBack" + tag, 3, hips_, {0.1 * x, 0.93, -0.09}, {0, -0.13, 0});
      }
      if (variant_.hair) chain("Hair" + tag, 5, head_, {0.07 * x, 1.66, -0.03}, {0, -0.1, -0.01});
      if (variant_.breasts) chain("breast" + tag, 2, chest_, {0.08 * x, 1.28, 0.1}, {0, 0.01, 0.04});
      if (variant_.cape) chain("cape" + tag, 4, chest_, {0.1 * x, 1.35, -0.12}, {0, -0.3, -0.03});
    }
    if (variant_.cape) chain("cape_M_", 4, chest_, {0, 1.35, -0.12}, {0, -0.3, -0.03});
    if (!variant_.ikTargets) return;
    const std::string root = body_.skeleton.joints.front().name;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 foot = positionOf(feet_[i]), hand = positionOf(hands_[i]);
      body_.add(i == 0 ? "ik_foot_left" : "ik_foot_right", root, foot, center(PartKind::kOther));
      body_.add(i == 0 ? "ik_hand_left" : "ik_hand_right", root, hand, center(PartKind::kOther));
    }
  }

  Vec3 positionOf(const std::string& name) const {
    return restPositions(body_.skeleton)[body_.skeleton.find(name).value()];
  }

  const NamingConvention& convention_;
  PersonVariant variant_;
  MadeBody body_;
  std::string hips_, chest_, armsOn_, head_;
  std::vector<std::string> hands_, feet_;
};

inline MadeBody personOf(const NamingConvention& convention, const PersonVariant& variant) {
  return ConventionPerson(convention, variant).make();
}

// Every variant differs from the others in several respects at once; together they have each number of necks and
// spines, and all other options.
inline std::vector<PersonVariant> personVariants() {
  std::vector<PersonVariant> variants(9);
  variants[1] = {1, 0, false, false, false, false, true, false, false, false, false};
  variants[2] = {2, 1, true, true, true, true, false, true, false, false, true};
  variants[3] = {3, 2, true, true, false, true, true, true, true, true, true};
  variants[4] = {4, 3, false, true, true, false, false, true, true, false, false};
  variants[5] = {5, 2, true, true, true, true, true, true, true, true, true};
  variants[6] = {6, 1, true, false, false, false, false, false, true, true, false};
  variants[7] = {4, 0, false, true, true, true, true, true, true, true, true};
  variants[8] = {6, 3, true, true, true, true, true, true, true, true, true};
  return variants;
}

// Conventions of people.
inline bool isOfPeople(const NamingConvention& convention) {
  return !conventionName(convention, JointRole::kUpperArm, Side::kLeft, 0).empty();
}

}  // namespace limber::testing
