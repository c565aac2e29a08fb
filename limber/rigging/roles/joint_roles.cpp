#include "limber/rigging/roles/joint_roles.h"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "limber/core/text/names.h"

namespace limber {

namespace {

constexpr std::size_t kTrunkRoles = 4, kTailRoles = 4, kWingRoles = 3;  // along each, from where it is attached
constexpr std::size_t kFingerRoles = 3, kFingers = 5, kFins = 2;

// A joint of a chain that is that of a role.
struct Anchor {
  std::size_t at = 0;  // in the chain
  std::string role;
};

class RoleFinder {
 public:
  RoleFinder(const Skeleton& skeleton, const Anatomy& anatomy)
      : skeleton_(skeleton), anatomy_(anatomy), roles_(skeleton.jointCount()) {
    for (const Affine& global : restGlobals(skeleton)) positions_.push_back(global.translation());
  }

  std::vector<std::optional<RolePosition>> find() {
    for (const Part& part : anatomy_.parts) {
      if (!part.joints.empty()) read(part);
    }
    return std::move(roles_);
  }

 private:
  static std::string sideOf(const Part& part) {
    return part.side == Side::kCenter ? "" : part.side == Side::kLeft ? ".L" : ".R";
  }

  void read(const Part& part) {
    const std::string side = sideOf(part);
    switch (part.kind) {
      case PartKind::kTrunk:
        return spread(part.joints, "trunk", kTrunkRoles, side);
      case PartKind::kTail:
        return part.side == Side::kCenter ? spread(part.joints, "tail", kTailRoles, side) : void();
      case PartKind::kWing:
        return part.side != Side::kCenter && part.pair == 0 ? spread(part.joints, "wing", kWingRoles, side) : void();
      case PartKind::kNeck:
        return part.pair == 0 ? readNeck(part) : void();
      case PartKind::kHead:
        return part.pair == 0 ? set(part.joints.front(), "head") : void();
      case PartKind::kJaw:
        return part.side == Side::kCenter && part.pair == 0 ? set(part.joints.front(), "jaw") : void();
      case PartKind::kEar:
        return part.side != Side::kCenter && part.pair == 0 ? set(part.joints.front(), "ear" + side) : void();
      case PartKind::kFin:
        return part.side != Side::kCenter && part.pair < kFins ? readFin(part, side) : void();
      case PartKind::kFinger:
        return part.side != Side::kCenter && part.pair < kFingers ? readFinger(part, side) : void();
      case PartKind::kLeg:
      case PartKind::kArm:
        return part.side != Side::kCenter ? readLimb(part, side) : void();
      default:
        return;
    }
  }

  void set(Index joint, const std::string& role) { roles_[joint] = atRole(role); }

  // Path lengths along a chain, 1 at its end.
  std::vector<double> along(std::span<const Index> chain) const {
    std::vector<double> along = {0};
    for (std::size_t i = 1; i < chain.size(); ++i) {
      along.push_back(along.back() + (positions_[chain[i]] - positions_[chain[i - 1]]).norm());
    }
    const double length = std::max(along.back(), 1e-12);
    for (double& distance : along) distance /= length;
    return along;
  }

  // `count` roles lie along the chain at equal distances.
  void spread(std::span<const Index> chain, std::string_view role, std::size_t count, const std::string& side) {
    const std::vector<double> distances = along(chain);
    for (std::size_t i = 0; i < chain.size(); ++i) {
      const double at = distances[i] * static_cast<double>(count - 1);
      const auto before = std::min(static_cast<std::size_t>(at), count - 2);
      roles_[chain[i]] = between(fmt::format("{}_{}{}", role, before, side),
                                 fmt::format("{}_{}{}", role, before + 1, side), at - static_cast<double>(before));
    }
  }

  static RolePosition between(const std::string& from, const std::string& to, double fraction) {
    if (fraction < 1e-6) return atRole(from);
    if (fraction > 1 - 1e-6) return atRole(to);
    return {from, to, fraction};
  }

  // Joints between anchors lie on the line from one to the next; those beyond the last have no role.
  void anchor(std::span<const Index> chain, const std::vector<Anchor>& anchors) {
    const std::vector<double> distances = along(chain);
    for (std::size_t a = 0; a < anchors.size(); ++a) {
      set(chain[anchors[a].at], anchors[a].role);
      if (a + 1 == anchors.size()) break;
      const double from = distances[anchors[a].at], length = distances[anchors[a + 1].at] - from;
      for (std::size_t i = anchors[a].at + 1; i < anchors[a + 1].at; ++i) {
        const double fraction = length > 1e-12 ? (distances[i] - from) / length : 0;
        roles_[chain[i]] = between(anchors[a].role, anchors[a + 1].role, fraction);
      }
    }
  }

  void readNeck(const Part& part) {
    std::vector<Index> chain = part.joints;
    std::vector<Anchor> anchors = {{0, "neck"}};
    if (const Part* head = anatomy_.find(PartKind::kHead); head && !head->joints.empty()) {
      anchors.push_back({chain.size(), "head"});
      chain.push_back(head->joints.front());
    }
    anchor(chain, anchors);
  }

  void readFin(const Part& part, const std::string& side) {
    std::vector<Anchor> anchors = {{0, fmt::format("fin{}_0{}", part.pair, side)}};
    if (part.pair == 0 && part.joints.size() > 1) anchors.push_back({part.joints.size() - 1, "fin0_1" + side});
    anchor(part.joints, anchors);
  }

  // The bone inside the palm, which few skeletons have, is no role.
  void readFinger(const Part& part, const std::string& side) {
    if (anatomy_.pairsOf(PartKind::kArm) == 0) return;  // the rays of a wing
    const bool hasPalmBone = part.joints.size() > kFingerRoles &&
                             lowerCase(skeleton_.joints[part.joints.front()].name).find("meta") != std::string::npos;
    for (std::size_t i = hasPalmBone; i < std::min(part.joints.size(), kFingerRoles + hasPalmBone); ++i) {
      set(part.joints[i], fmt::format("finger_{}_{}{}", part.pair + 1, i - hasPalmBone, side));
    }
  }

  // Arms and front legs are one role, hind legs another; between them are up to three further pairs of legs.
  std::optional<std::string> limbRole(const Part& part) const {
    if (part.kind == PartKind::kArm) return part.pair == 0 ? std::optional<std::string>("fore") : std::nullopt;
    const Index pairs = anatomy_.pairsOf(PartKind::kLeg);
    if (part.pair + 1 == pairs) return "hind";
    const Index behindArms = part.pair + (anatomy_.pairsOf(PartKind::kArm) > 0 ? 1 : 0);
    constexpr std::array<const char*, 4> kRoles = {"fore", "mida", "midb", "midc"};
    return behindArms < kRoles.size() ? std::optional<std::string>(kRoles[behindArms]) : std::nullopt;
  }

  void readLimb(const Part& part, const std::string& side) {
    const std::optional<std::string> role = limbRole(part);
    if (!role) return;
    const bool isMiddle = role->starts_with("mid");
    std::vector<Anchor> anchors;
    const auto add = [&](std::optional<Index> joint, const char* landmark) {
      if (!joint) return;
      const auto at = std::find(part.joints.begin(), part.joints.end(), *joint);
      if (at == part.joints.end()) return;
      anchors.push_back(
          {static_cast<std::size_t>(at - part.joints.begin()), fmt::format("{}_{}{}", *role, landmark, side)});
    };
    const Index upper = part.upper.value_or(part.joints.front());
    if (*role == "fore" && part.joints.front() != upper) add(part.joints.front(), "base");
    add(upper, "upper");
    add(part.middle, "middle");
    if (!isMiddle) add(part.hock, "hock");
    add(part.end, "end");
    if (*role == "hind") add(part.toes, "toes");
    std::stable_sort(anchors.begin(), anchors.end(), [](const Anchor& a, const Anchor& b) { return a.at < b.at; });
    anchor(part.joints, anchors);
  }

  const Skeleton& skeleton_;
  const Anatomy& anatomy_;
  std::vector<Vec3> positions_;
  std::vector<std::optional<RolePosition>> roles_;
};

}  // namespace

RolePosition atRole(std::string_view role) {
  return {std::string(role), std::string(role), 0};
}

RoleName splitName(std::string_view name) {
  RoleName split;
  if (name.ends_with(".L") || name.ends_with(".R")) {
    split.side = name.substr(name.size() - 2);
    name.remove_suffix(2);
  }
  const std::size_t end = name.find('_');
  split.limb = name.substr(0, end);
  if (end != std::string_view::npos) split.segment = name.substr(end + 1);
  return split;
}

std::string partOfRole(std::string_view role) {
  const RoleName name = splitName(role);
  const auto part = [&](std::string_view of) { return std::string(of) + std::string(name.side); };
  const std::string limb(name.limb);
  if (limb == "finger") return part("fore_end");
  if (limb.starts_with("mid")) return part("mid");
  if (limb.starts_with("fin")) return part("fin");
  if (limb == "jaw") return "head";
  if (limb != "fore" && limb != "hind") return part(limb);
  if (name.segment == "upper") return part(limb + "_upper");
  if (name.segment == "middle" || name.segment == "hock") return part(limb + "_lower");
  return name.segment == "base" ? "trunk" : part(limb + "_end");
}

std::vector<std::optional<RolePosition>> jointRoles(const Skeleton& skeleton, const Anatomy& anatomy) {
  return RoleFinder(skeleton, anatomy).find();
}

}  // namespace limber
