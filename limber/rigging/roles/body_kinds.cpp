#include "limber/rigging/roles/body_kinds.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "limber/core/text/names.h"
#include "limber/rigging/roles/roled_templates.h"

namespace limber {

namespace {

constexpr BodyKind kKinds[] = {
    {"humanoid", "a person: 22 joints, named as VRM 1.0 does", "upright"},
    {"humanoid-fingers", "a person with 15 finger joints to each hand", "upright"},
    {"quadruped", "a four-legged animal with neck and tail", "four"},
    {"bird", "a bird with wings spread, or another winged biped", "bird"},
    {"dinosaur", "an animal on two legs with a long tail", "dinosaur"},
    {"crawler", "a low animal on four legs, as lizards and tortoises", "four"},
    {"dragon", "a winged animal on four legs", "winged_four"},
    {"insect", "an animal on six legs", "many", 3, 3},
    {"spider", "an animal on eight legs and more", "many", 4},
    {"fish", "a fish or whale, with fins where it has some", "swims"},
    {"serpent", "a snake or worm: a chain of 12 joints", "crawls"},
};

constexpr std::array<const char*, 5> kLegRoles = {"fore", "mida", "midb", "midc", "hind"};
constexpr double kLiftedHand = 0.15;  // heights above the hind feet, from which on a front limb is an arm

class SkeletonBuilder {
 public:
  SkeletonBuilder(const BodyKind& kind, const RoleReading& reading) : kind_(kind), reading_(reading) {
    made_.skeleton.name = std::string(kind.name);
  }

  RoledSkeleton build() {
    if (kind_.plan == "swims") {
      swim();
    } else if (kind_.plan == "crawls") {
      crawl();
    } else {
      walk();
    }
    pairSides();
    return std::move(made_);
  }

 private:
  Index add(const std::string& name, std::optional<Index> parent, const RolePosition& role, bool isTip = false) {
    TemplateJoint joint;
    joint.name = name;
    joint.parent = parent;
    joint.position = reading_.position(role);
    joint.role = isTip ? TemplateRole::kTip : TemplateRole::kPlaced;
    made_.skeleton.joints.push_back(std::move(joint));
    made_.roles.push_back(role);
    return made_.skeleton.jointCount() - 1;
  }
  void addTip(Index parent) { add(made_.skeleton.joints[parent].name + "Tip", parent, *made_.roles[parent], true); }

  // Where the body has the joint; else the parent.
  Index addIfPresent(const std::string& name, Index parent, std::string_view role) {
    return reading_.has(role) ? add(name, parent, atRole(role)) : parent;
  }

  bool hasOnASide(const std::string& role) const { return reading_.has(role + ".L") || reading_.has(role + ".R"); }

  // A limb on both sides: names without the side, and the roles of its joints without theirs, from the trunk outwards.
  // The first is there, the others as far as the body has them.
  void addLimb(Index parent, const std::vector<std::pair<std::string, std::string>>& joints) {
    for (const bool right : {false, true}) {
      Index above = parent;
      for (const auto& [name, role] : joints) {
        if (&name != &joints.front().first && !hasOnASide(role)) continue;
        above = add((right ? "right" : "left") + name, above, atRole(role + (right ? ".R" : ".L")));
      }
      addTip(above);
    }
  }

  Index nearest(const std::string& role, Index one, Index other) const {
    const Vec3 root = 0.5 * (reading_.position(atRole(role + ".L")) + reading_.position(atRole(role + ".R")));
    const std::vector<TemplateJoint>& joints = made_.skeleton.joints;
    return (joints[one].position - root).norm() <= (joints[other].position - root).norm() ? one : other;
  }

  // A digitigrade leg's raised heel is called the foot, what it rests on its toes.
  std::vector<std::pair<std::string, std::string>> leg(const std::string& role, const std::string& before,
                                                       const std::string& behind) const {
    const auto named = [&](const char* name) { return before + name + behind; };
    std::vector<std::pair<std::string, std::string>> joints = {{named("UpperLeg"), role + "_upper"},
                                                               {named("LowerLeg"), role + "_middle"}};
    if (hasOnASide(role + "_hock")) {
      joints.insert(joints.end(), {{named("Foot"), role + "_hock"}, {named("Toes"), role + "_end"}});
    } else {
      joints.push_back({named("Foot"), role + "_end"});
      if (role == "hind") joints.push_back({named("Toes"), "hind_toes"});
    }
    return joints;
  }

  // From the front.
  std::vector<std::string> legs(bool hasArms) const {
    const std::size_t arms = hasArms ? 1 : 0;
    std::vector<std::string> likeliest;
    for (const std::string role : kLegRoles) {
      if (role != "fore" || !hasArms) likeliest.push_back(role);
    }
    const auto confidence = [&](const std::string& role) {
      return std::max(reading_.confidence(role + "_upper.L"), reading_.confidence(role + "_upper.R"));
    };
    std::stable_sort(likeliest.begin(), likeliest.end(),
                     [&](const std::string& a, const std::string& b) { return confidence(a) > confidence(b); });
    const auto read = static_cast<std::size_t>(std::count_if(
        likeliest.begin(), likeliest.end(), [&](const std::string& role) { return hasOnASide(role + "_upper"); }));
    likeliest.resize(std::clamp(read + arms, kind_.minPairs, kind_.maxPairs) - arms);
    std::vector<std::string> legs;
    for (const char* role : kLegRoles) {
      if (std::find(likeliest.begin(), likeliest.end(), role) != likeliest.end()) legs.emplace_back(role);
    }
    if (legs.empty()) legs.push_back("hind");
    return legs;
  }

  bool hasArms() const {
    if (!hasOnASide("fore_upper")) return false;
    if (kind_.plan == "dinosaur") return true;
    if (kind_.plan != "many") return false;
    const auto height = [&](const char* end) {
      return 0.5 *
             (reading_.position(atRole(std::string(end) + ".L")) + reading_.position(atRole(std::string(end) + ".R")))
                 .y();
    };
    return height("fore_end") > height("hind_end") + kLiftedHand;
  }

  void walk() {
    const Index hips = add("hips", {}, atRole("trunk_0"));
    const Index spine = add("spine", hips, {"trunk_1", "trunk_2", 0.5});
    const Index chest = add("chest", spine, atRole("trunk_3"));
    addTip(addIfPresent("head", addIfPresent("neck", chest, "neck"), "head"));
    if (reading_.has("tail_0")) addTail(hips);
    if (hasOnASide("wing_0"))
      addLimb(chest, {{"UpperWing", "wing_0"}, {"LowerWing", "wing_1"}, {"WingHand", "wing_2"}});
    const bool arms = hasArms();
    if (arms) addLimb(chest, {{"UpperArm", "fore_upper"}, {"LowerArm", "fore_middle"}, {"Hand", "fore_end"}});
    const std::vector<std::string> pairs = legs(arms);
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
      const std::string before = pairs.size() == 2 ? (pair == 0 ? "Front" : "Hind") : "";
      const std::string behind = pairs.size() > 2 && pair > 0 ? std::to_string(pair) : "";
      const Index carrier = pairs.size() == 1 ? hips : nearest(pairs[pair] + "_upper", hips, chest);
      addLimb(carrier, leg(pairs[pair], before, behind));
    }
  }

  void addTail(Index parent) {
    for (std::size_t i = 0; i < 4; ++i) {
      parent = add(i == 0 ? "tail" : fmt::format("tail{}", i), parent, atRole(fmt::format("tail_{}", i)));
    }
    addTip(parent);
  }

  // From the head to the tail's end, through the roles that the body has.
  std::vector<RolePosition> spineRoles() const {
    std::vector<RolePosition> roles;
    for (const char* role :
         {"head", "neck", "trunk_3", "trunk_2", "trunk_1", "trunk_0", "tail_0", "tail_1", "tail_2", "tail_3"}) {
      if (reading_.has(role)) roles.push_back(atRole(role));
    }
    if (roles.size() < 2) roles = {atRole("trunk_3"), atRole("trunk_0")};
    return roles;
  }

  // At that fraction of the path through these roles.
  RolePosition along(const std::vector<RolePosition>& roles, double fraction) const {
    std::vector<double> distances = {0};
    for (std::size_t i = 1; i < roles.size(); ++i) {
      distances.push_back(distances.back() + (reading_.position(roles[i]) - reading_.position(roles[i - 1])).norm());
    }
    const double distance = fraction * distances.back();
    std::size_t i = 1;
    while (i + 1 < roles.size() && distances[i] < distance) ++i;
    const double length = std::max(distances[i] - distances[i - 1], 1e-12);
    return {roles[i - 1].from, roles[i].from, std::clamp((distance - distances[i - 1]) / length, 0.0, 1.0)};
  }

  // Joints of that name along the spine; the last.
  Index addAlong(std::string_view name, Index parent, const std::vector<RolePosition>& spine,
                 std::initializer_list<double> fractions) {
    std::size_t number = 0;
    for (const double fraction : fractions) {
      parent = add(number == 0 ? std::string(name) : fmt::format("{}{}", name, number), parent, along(spine, fraction));
      ++number;
    }
    return parent;
  }

  // The root is before the middle, as artists have it: head and tail differ by what is attached to them.
  void swim() {
    const std::vector<RolePosition> spine = spineRoles();
    const Index chest = add("chest", {}, along(spine, 0.25));
    addTip(add("head", chest, along(spine, 0)));
    const Index tail = addAlong("tail", add("spine", chest, along(spine, 0.45)), spine, {0.65, 0.83, 1});
    addTip(tail);
    if (hasOnASide("fin0_0")) addLimb(nearest("fin0_0", chest, tail), {{"Fin", "fin0_0"}, {"FinEnd", "fin0_1"}});
    if (hasOnASide("fin1_0")) addLimb(nearest("fin1_0", chest, tail), {{"Fin1", "fin1_0"}});
  }

  void crawl() {
    const std::vector<RolePosition> spine = spineRoles();
    const Index chest = add("chest", {}, along(spine, 0.18));
    addTip(add("head", add("neck", chest, along(spine, 0.09)), along(spine, 0)));
    const Index last = addAlong("spine", chest, spine, {0.27, 0.36, 0.45, 0.54});
    addTip(addAlong("tail", last, spine, {0.63, 0.72, 0.81, 0.9, 1}));
  }

  void pairSides() {
    for (TemplateJoint& joint : made_.skeleton.joints) {
      if (joint.name.starts_with("left")) joint.mirror = made_.skeleton.find("right" + joint.name.substr(4));
      if (joint.name.starts_with("right")) joint.mirror = made_.skeleton.find("left" + joint.name.substr(5));
    }
  }

  const BodyKind& kind_;
  const RoleReading& reading_;
  RoledSkeleton made_;
};

}  // namespace

std::span<const BodyKind> bodyKinds() {
  return kKinds;
}

const BodyKind& findBodyKind(std::string_view name) {
  return findByName(kKinds, "template", name);
}

RoledSkeleton skeletonOfKind(const BodyKind& kind, const RoleReading& reading) {
  const TemplateSkeleton* skeleton = findTemplate(kind.name);
  return skeleton ? templateWithRoles(*skeleton, reading) : SkeletonBuilder(kind, reading).build();
}

}  // namespace limber
