#include "limber/character/anatomy/certain_states.h"

#include <array>

namespace limber {

namespace {

constexpr std::uint32_t kAllStates = (1u << kPartStates) - 1;

constexpr std::uint32_t bit(PartState state) {
  return 1u << static_cast<std::size_t>(state);
}

constexpr std::uint32_t statesOf(PartKind kind) {
  std::uint32_t mask = 0;
  for (std::size_t s = 0; s < kPartStates; ++s) {
    if (kindOf(static_cast<PartState>(s)) == kind) mask |= 1u << s;
  }
  return mask;
}

constexpr std::uint32_t kLegStates = statesOf(PartKind::kLeg), kArmStates = statesOf(PartKind::kArm);

// The segments of a limb in their order, one bit each; none for what is no limb.
std::uint32_t limbStatesAfter(PartState state) {
  std::uint32_t mask = 0;
  for (std::size_t s = static_cast<std::size_t>(state) + 1; s < kPartStates; ++s) {
    if (kindOf(static_cast<PartState>(s)) == kindOf(state)) mask |= 1u << s;
  }
  return mask;
}

// What is declared of a skeleton as a whole, and what follows for the joints of which nothing is.
class Declared {
 public:
  explicit Declared(const BodyReading& reading)
      : roles_(reading.declared),
        words_(reading.words),
        tree_(reading.tree),
        contradicted_(roles_.size(), false),
        carriesCenter_(roles_.size(), false),
        carriesLimb_(roles_.size(), false),
        base_(roles_.size(), 0) {
    if (reading.convention) {
      for (const Index joint : reading.convention->contradicted) contradicted_[joint] = true;
    }
    for (const Index joint : tree_.order()) {
      const std::optional<PartState> state = stateAt(joint);
      if (!state) continue;
      declared_ |= bit(*state);
      ofSide_[sideIndex(joint)] |= bit(*state);
      const PartKind kind = kindOf(*state);
      const bool isLimb = kind == PartKind::kLeg || kind == PartKind::kArm || kind == PartKind::kFinger;
      std::vector<bool>& carries = isLimb ? carriesLimb_ : carriesCenter_;
      for (std::optional<Index> up = tree_.parent(joint); up && !carries[*up]; up = tree_.parent(*up))
        carries[*up] = true;
      if (*state != PartState::kLegUpper && *state != PartState::kArmUpper) continue;
      // What an upper arm or leg is a child of, up to what is declared, may be its collar or its hip.
      for (std::optional<Index> up = tree_.parent(joint); up && !roles_[*up]; up = tree_.parent(*up))
        base_[*up] |= bit(*state == PartState::kLegUpper ? PartState::kLegBase : PartState::kArmBase);
    }
  }

  bool isDeclared(Index joint) const { return stateAt(joint).has_value(); }

  std::uint32_t statesAt(Index joint) const {
    if (const std::optional<PartState> state = stateAt(joint)) return bit(*state);
    const std::optional<Index> above = declaredAbove(joint);
    const std::uint32_t own = above ? bit(*stateAt(*above)) : 0;
    if (roles_[joint]) return bit(PartState::kOther) | own;  // a tip
    if (contradicted_[joint]) return kAllStates;
    if (!has(PartState::kLegUpper) || !has(PartState::kArmUpper)) return maskOfFew();
    // Where a declared joint's bone ends.
    const bool isLeaf = tree_.children(joint).empty() && words_[joint].has(NameMark::kEnd);
    if (isLeaf && above && tree_.parent(joint) == above) return bit(PartState::kOther) | own;
    std::uint32_t mask = kAllStates & ~kLegStates & ~kArmStates;
    if (has(PartState::kHead)) mask &= ~(bit(PartState::kNeck) | bit(PartState::kHead));
    const bool carries = carriesCenter_[joint] || carriesLimb_[joint];
    if (!carries) mask &= ~bit(PartState::kTrunk);
    if (carries) mask |= own | base_[joint];
    if (!above) return mask;
    // What a limb has beyond its declared joints, where none of its side is declared to be that.
    const PartState state = *stateAt(*above);
    if (state == PartState::kHead) mask |= own;  // a face's joints
    const PartKind kind = kindOf(state);
    const bool isLimb = kind == PartKind::kLeg || kind == PartKind::kArm;
    const std::uint32_t left = isLimb ? limbStatesAfter(state) & ~ofSide_[sideIndex(*above)] : 0;
    mask |= left;
    // Digits are children of hands and feet, and of digits.
    const std::uint32_t ends = bit(PartState::kArmEnd) | bit(PartState::kLegEnd) | bit(PartState::kLegToes);
    if (kind != PartKind::kFinger && ((bit(state) | left) & ends) == 0) mask &= ~bit(PartState::kFinger);
    return mask;
  }

 private:
  bool has(PartState state) const { return (declared_ & bit(state)) != 0; }

  // Of bodies whose legs or arms are not declared: all that is not declared elsewhere.
  std::uint32_t maskOfFew() const {
    std::uint32_t mask = kAllStates;
    if (has(PartState::kHead)) mask &= ~bit(PartState::kHead);
    return mask;
  }

  // None of tips, which have no state of their own.
  std::optional<PartState> stateAt(Index joint) const {
    return roles_[joint] ? stateOf(roles_[joint]->role) : std::nullopt;
  }
  std::size_t sideIndex(Index joint) const { return static_cast<std::size_t>(roles_[joint]->side); }

  // The nearest joint above that has a declared state.
  std::optional<Index> declaredAbove(Index joint) const {
    std::optional<Index> up = tree_.parent(joint);
    while (up && !stateAt(*up)) up = tree_.parent(*up);
    return up;
  }

  const std::vector<std::optional<NamedRole>>& roles_;
  const std::vector<JointWords>& words_;
  const JointTree& tree_;
  std::vector<bool> contradicted_;                 // #J
  std::vector<bool> carriesCenter_, carriesLimb_;  // #J, whether such a declared joint is below
  std::vector<std::uint32_t> base_;                // #J, states of a limb's base that a joint above it may have
  std::uint32_t declared_ = 0;                     // states of all declared joints
  std::array<std::uint32_t, 3> ofSide_{};          // likewise by Side
};

}  // namespace

std::vector<std::uint32_t> certainStates(const BodyReading& reading, const AnatomyOptions& options) {
  const Declared declared(reading);
  std::vector<std::uint32_t> ofJoint(reading.declared.size());
  enum class Certainty { kNone, kDeclared, kUser };
  std::vector<Certainty> certainty(ofJoint.size(), Certainty::kNone);
  for (Index j = 0; j < ofJoint.size(); ++j) {
    ofJoint[j] = declared.statesAt(j);
    if (declared.isDeclared(j)) certainty[j] = Certainty::kDeclared;
  }
  for (const FixedLabel& label : options.fixed) {
    const std::uint32_t mask = statesOf(label.kind);
    if (label.joint >= ofJoint.size() || mask == 0) continue;
    ofJoint[label.joint] = mask;
    certainty[label.joint] = Certainty::kUser;
  }
  std::vector<std::uint32_t> allowed;
  for (const HalfJoint& half : reading.body.joints) {
    std::uint32_t both = ofJoint[half.joint];
    if (half.partner && certainty[*half.partner] > certainty[half.joint]) both = ofJoint[*half.partner];
    if (half.partner && (both & ofJoint[*half.partner]) != 0) both &= ofJoint[*half.partner];
    allowed.push_back(both);
  }
  return allowed;
}

}  // namespace limber
