#include "limber/evaluate/rig/attached_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

// Lengths are fractions of the body's diagonal, and were read off characters of some twenty makers.
class Attacher {
 public:
  Attacher(LabelledSkeleton& body, Random& random) : body_(body), random_(random) {
    frames_ = restGlobals(body.skeleton);
    Box box;
    for (const Affine& frame : frames_) box.add(frame.translation());
    size_ = box.empty() ? 0 : box.diagonal();
    up_ = body.axes.up;
    front_ = body.axes.front;
    left_ = body.axes.left();
    style_ = random.below(5);
  }

  void attach() {
    const std::optional<Index> hips = carrierOf(PartState::kLegUpper, PartState::kLegBase),
                               chest = carrierOf(PartState::kArmUpper, PartState::kArmBase),
                               head = first(PartState::kHead);
    if (size_ <= 0 || !first(PartState::kTrunk)) return;
    if (hips && chance(0.35)) skirt(*hips);
    if (head && chance(0.35)) hair(*head);
    if (chest && chance(0.2)) cape(*chest);
    if (chest && chance(0.3)) pairAt(*chest, {"breast", "bust", "boob", "RibsTwist", "pectoral"}, 0.05, -0.03, 0.07);
    if (hips && chance(0.12)) pairAt(*hips, {"butt", "buttock", "glute"}, 0.05, -0.03, -0.07);
    if (hips && chance(0.12)) straps(*hips);
    if (chance(0.1)) sleeves();
    if (chance(0.2)) targets();
    if (chance(0.3)) leaves();
  }

 private:
  bool chance(double probability) { return random_.uniform() < probability; }
  int between(int least, int most) {
    return least + static_cast<int>(random_.below(static_cast<std::uint64_t>(most - least + 1)));
  }

  std::optional<Index> first(PartState state) const {
    for (Index j = 0; j < body_.labels.size(); ++j) {
      if (body_.labels[j].state == state) return j;
    }
    return std::nullopt;
  }

  // What the first joint of a limb is a child of, where that is of the trunk.
  std::optional<Index> carrierOf(PartState upper, PartState base) const {
    for (const PartState state : {base, upper}) {
      const std::optional<Index> limb = first(state);
      const std::optional<Index> parent = limb ? body_.skeleton.joints[*limb].parent : std::nullopt;
      if (parent && body_.labels[*parent].state == PartState::kTrunk) return parent;
    }
    return std::nullopt;
  }

  std::string nameFor(std::string_view word, Side side, int chain, int link) {
    const bool isSided = side != Side::kCenter;
    switch (style_) {
      case 0:
        return fmt::format("J_Sec_{}{}{}_{:02}", isSided ? (side == Side::kLeft ? "L_" : "R_") : "", word, chain,
                           link + 1);
      case 1:
        return fmt::format("{}_{}_{}{}", word, chain, link, isSided ? (side == Side::kLeft ? "_l" : "_r") : "");
      case 2:
        return fmt::format("{}{}{:02}.{:03}", word, isSided ? (side == Side::kLeft ? ".L" : ".R") : "", chain, link);
      case 3:
        return fmt::format("{}{}{}{}", isSided ? (side == Side::kLeft ? "Left" : "Right") : "", word, chain, link);
      default:
        return fmt::format("bone_{}_{}_{}", body_.skeleton.jointCount(), chain, link);
    }
  }

  Index add(const std::string& name, Index parent, const Vec3& at, const JointLabel& label) {
    Joint joint;
    joint.name = fmt::format("{}~{}", name, body_.skeleton.jointCount());
    joint.parent = parent;
    joint.rest.translation = frames_[parent].inverse() * at;
    Affine frame = frames_[parent];
    frame.translation() = at;
    body_.skeleton.joints.push_back(joint);
    body_.labels.push_back(label);
    frames_.push_back(frame);
    return body_.skeleton.jointCount() - 1;
  }

  void chain(std::string_view word, PartState state, Side side, int number, int links, Index carrier, Vec3 at,
             const Vec3& step) {
    Index parent = carrier;
    const Vec3 wobble = 0.1 * step.norm() * Vec3(random_.normal(), random_.normal(), random_.normal());
    for (int link = 0; link < links; ++link, at += step + link * wobble) {
      parent = add(nameFor(word, side, number, link), parent, at, {state, side, 0});
    }
  }

  Vec3 at(Index joint) const { return frames_[joint].translation(); }
  Vec3 mirrored(const Vec3& point, const Vec3& about) const { return point - 2 * left_.dot(point - about) * left_; }
  template <std::size_t n>
  std::string_view oneOf(const std::array<std::string_view, n>& words) {
    return words[random_.below(n)];
  }

  void skirt(Index hips) {
    constexpr std::array<std::string_view, 8> kWords = {"Skirt", "skirt", "Coat", "cloth",
                                                        "dress", "Hem",   "robe", "Tasset"};
    const std::string_view word = oneOf(kWords);
    Index carrier = hips;
    if (chance(0.3))
      carrier = add(nameFor(word, Side::kCenter, 9, 0), hips, at(hips), {PartState::kAttachment, Side::kCenter, 0});
    const int pairs = between(1, 6), links = between(1, 5);
    const double radius = size_ * random_.uniform(0.04, 0.1), step = size_ * random_.uniform(0.03, 0.1),
                 outward = random_.uniform(0, 0.6);
    const Vec3 about = at(hips) - size_ * random_.uniform(-0.01, 0.03) * up_;
    for (int p = 0; p < pairs; ++p) {
      const double angle = kPi * (p + 0.5) / pairs;  // from the front to the back
      const Vec3 direction = std::cos(angle) * front_ + std::sin(angle) * left_, start = about + radius * direction;
      const Vec3 down = step * (outward * direction - up_).normalized();
      chain(word, PartState::kAttachment, Side::kLeft, p, links, carrier, start, down);
      chain(word, PartState::kAttachment, Side::kRight, p, links, carrier, mirrored(start, about),
            mirrored(down, Vec3::Zero()));
    }
    if (chance(0.4))
      chain(word, PartState::kAttachment, Side::kCenter, 8, links, carrier, about - radius * front_, -step * up_);
  }

  void hair(Index head) {
    constexpr std::array<std::string_view, 6> kWords = {"Hair", "hair", "bangs", "ponytail", "braid", "Kami"};
    const std::string_view word = oneOf(kWords);
    const int pairs = between(0, 5), links = between(1, 7);
    const double radius = size_ * random_.uniform(0.02, 0.06), step = size_ * random_.uniform(0.01, 0.06);
    const Vec3 about = at(head) + size_ * random_.uniform(0.02, 0.07) * up_;
    for (int p = 0; p < pairs; ++p) {
      const double angle = kPi * (p + 0.5) / pairs;
      const Vec3 direction = std::cos(angle) * front_ + std::sin(angle) * left_, start = about + radius * direction;
      const Vec3 down = step * (0.3 * direction - up_).normalized();
      chain(word, PartState::kHair, Side::kLeft, p, links, head, start, down);
      chain(word, PartState::kHair, Side::kRight, p, links, head, mirrored(start, about), mirrored(down, Vec3::Zero()));
    }
    if (pairs == 0 || chance(0.4))
      chain(word, PartState::kHair, Side::kCenter, 8, links, head, about - radius * front_,
            -step * (up_ + 0.3 * front_).normalized());
  }

  void cape(Index chest) {
    constexpr std::array<std::string_view, 5> kWords = {"cape", "Cape", "cloak", "Mantle", "scarf"};
    const std::string_view word = oneOf(kWords);
    const int pairs = between(0, 3), links = between(2, 7);
    const double step = size_ * random_.uniform(0.04, 0.12);
    const Vec3 about = at(chest) - size_ * random_.uniform(0.03, 0.07) * front_,
               down = -step * (up_ + random_.uniform(0, 0.4) * front_).normalized();
    for (int p = 0; p < pairs; ++p) {
      const Vec3 start = about + size_ * 0.04 * (p + 1) * left_;
      chain(word, PartState::kAttachment, Side::kLeft, p, links, chest, start, down);
      chain(word, PartState::kAttachment, Side::kRight, p, links, chest, mirrored(start, about), down);
    }
    if (pairs == 0 || chance(0.5)) chain(word, PartState::kAttachment, Side::kCenter, 8, links, chest, about, down);
  }

  // One joint on each side, with a leaf now and then.
  void pairAt(Index carrier, const std::array<std::string_view, 5>& words, double aside, double below, double ahead) {
    const std::string_view word = words[random_.below(3)];
    const int links = between(1, 3);
    const double scale = random_.uniform(0.6, 1.2);
    const Vec3 about = at(carrier), start = about + size_ * scale * (aside * left_ + below * up_ + ahead * front_),
               step = size_ * 0.03 * (ahead > 0 ? front_ : Vec3(-front_));
    chain(word, PartState::kAttachment, Side::kLeft, 0, links, carrier, start, step);
    chain(word, PartState::kAttachment, Side::kRight, 0, links, carrier, mirrored(start, about), step);
  }

  void straps(Index hips) {
    constexpr std::array<std::string_view, 5> kWords = {"strap", "belt", "ribbon", "pouch", "Himo"};
    const std::string_view word = oneOf(kWords);
    const int links = between(1, 4);
    const Vec3 about = at(hips), start = about + size_ * 0.07 * left_, step = -size_ * random_.uniform(0.03, 0.1) * up_;
    chain(word, PartState::kAttachment, Side::kLeft, 0, links, hips, start, step);
    if (chance(0.7)) chain(word, PartState::kAttachment, Side::kRight, 0, links, hips, mirrored(start, about), step);
  }

  void sleeves() {
    const int links = between(1, 3);
    const double step = size_ * random_.uniform(0.02, 0.07);
    for (Index j = 0, count = body_.skeleton.jointCount(); j < count; ++j) {
      if (body_.labels[j].state != PartState::kArmMiddle) continue;
      chain("sleeve", PartState::kAttachment, body_.labels[j].side, 0, links, j, at(j) - 0.3 * step * up_, -step * up_);
    }
  }

  // Where hands and feet are, below the root.
  void targets() {
    std::optional<Index> root;
    for (Index j = 0; j < body_.skeleton.jointCount() && !root; ++j) {
      if (!body_.skeleton.joints[j].parent) root = j;
    }
    const bool hands = chance(0.5);
    for (Index j = 0, count = body_.skeleton.jointCount(); j < count; ++j) {
      const PartState state = body_.labels[j].state;
      if (state != PartState::kLegEnd && !(hands && state == PartState::kArmEnd)) continue;
      const char* word = state == PartState::kLegEnd ? "ik_foot" : "ik_hand";
      add(nameFor(word, body_.labels[j].side, 0, 0), *root, at(j), {PartState::kAttachment, body_.labels[j].side, 0});
    }
  }

  // Of what has been attached, where chains end.
  void leaves() {
    std::vector<bool> isParent(body_.skeleton.joints.size(), false);
    for (const Joint& joint : body_.skeleton.joints) {
      if (joint.parent) isParent[*joint.parent] = true;
    }
    for (Index j = 0, count = body_.skeleton.jointCount(); j < count; ++j) {
      const JointLabel label = body_.labels[j];
      const std::optional<Index> parent = body_.skeleton.joints[j].parent;
      const bool isAttached = label.state == PartState::kAttachment || label.state == PartState::kHair;
      if (isParent[j] || !isAttached || !parent) continue;
      add(body_.skeleton.joints[j].name + "_end", j, at(j) + 0.7 * (at(j) - at(*parent)), label);
    }
  }

  LabelledSkeleton& body_;
  Random& random_;
  std::vector<Affine> frames_;  // #J
  double size_ = 0;
  Vec3 up_, front_, left_;
  std::uint64_t style_ = 0;
};

}  // namespace

void addAttachments(LabelledSkeleton& body, Random& random) {
  Attacher(body, random).attach();
}

}  // namespace limber
