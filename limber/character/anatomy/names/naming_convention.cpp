#include "limber/character/anatomy/names/naming_convention.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "limber/character/anatomy/joint_tree.h"
#include "limber/core/text/split_text.h"

namespace limber {

namespace {

// Of hips, trunk, head and, on each side, upper and lower leg, foot, upper and lower arm and hand: a body of which a
// convention names fewer is not known by its names. A person without head and hands, or an upper body, has as many.
constexpr std::size_t kMinCoreJoints = 8;
// Fraction of what the names say that the tree may contradict.
constexpr double kMaxContradicted = 0.25;
// Fraction of joints that end in a number of their own where an exporter has put one behind every name.
constexpr double kMinNumbered = 0.8;

struct TableEntry {
  std::uint16_t convention = 0;
  NamedRole role;
};

bool isSeparator(char c) {
  return c == '_' || c == '.' || c == '-' || c == ' ' || c == ':' || c == '|';
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

// A name in small letters without separators, with full-width letters and digits as plain ones, and where its words
// begin.
struct PlainName {
  std::string text;
  std::vector<std::size_t> starts;
};

PlainName plainNameOf(std::string_view name) {
  PlainName plain;
  plain.text.reserve(name.size());
  bool begins = true;
  char last = ' ';
  for (std::size_t i = 0; i < name.size(); ++i) {
    char c = name[i];
    // U+FF10 to U+FF5A: EF BC 90 to EF BD 9A.
    if (c == '\xEF' && i + 2 < name.size() && (name[i + 1] == '\xBC' || name[i + 1] == '\xBD')) {
      const int wide = (name[i + 1] == '\xBD' ? 0x40 : 0) + (static_cast<unsigned char>(name[i + 2]) - 0x80) + 0x20;
      if (wide >= '0' && wide <= 'z') {
        c = static_cast<char>(wide);
        i += 2;
      }
    }
    if (isSeparator(c)) {
      begins = true;
      last = c;
      continue;
    }
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0,
               lastUpper = std::isupper(static_cast<unsigned char>(last)) != 0;
    const bool nextLower = i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1])) != 0;
    if (begins || (upper && (!lastUpper || nextLower)) || (isDigit(last) && !isDigit(c))) {
      plain.starts.push_back(plain.text.size());
    }
    begins = false;
    last = c;
    plain.text.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  return plain;
}

bool isNumbered(std::string_view pattern) {
  return pattern.find('#') != std::string_view::npos;
}

bool isSided(std::string_view pattern) {
  return pattern.find('@') != std::string_view::npos || pattern.find('%') != std::string_view::npos;
}

// Of the convention's own files, not of variants.
bool isOwn(std::string_view pattern) {
  return !pattern.starts_with('~');
}

// A pattern written out: for one side, with a number or "#" for any, and with or without the text in brackets.
std::string writtenOut(const NamingConvention& convention, std::string_view pattern, Side side,
                       std::optional<std::size_t> number, bool withBrackets) {
  std::string name;
  bool inBrackets = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '[' || c == ']') {
      inBrackets = c == '[';
    } else if ((inBrackets && !withBrackets) || (i == 0 && (c == '~' || c == '='))) {
      continue;
    } else if (c == '@' || c == '%') {
      const auto& sides = c == '@' ? convention.sides : convention.otherSides;
      name += sides[side == Side::kRight ? 1 : 0];
    } else if (c == '#') {
      std::size_t width = 1;
      while (i + 1 < pattern.size() && pattern[i + 1] == '#') ++width, ++i;
      if (number)
        name += fmt::format("{:0{}}", *number, width);
      else
        name += '#';
    } else {
      name += c;
    }
  }
  return name;
}

// As the convention's own files have it; `index` is that of the joint among those of the pattern.
std::string ownName(const NamingConvention& convention, std::string_view pattern, Side side, std::size_t index) {
  const bool bracketed = pattern.find('[') != std::string_view::npos;
  const std::string_view prefix = pattern.starts_with('=') ? "" : convention.prefix;
  return std::string(prefix) +
         writtenOut(convention, pattern, side, bracketed ? index : index + 1, !bracketed || index > 0);
}

// Every name of every convention, plain, with "#" for any number.
using Table = std::unordered_map<std::string, std::vector<TableEntry>>;

const Table& table() {
  static const Table kTable = [] {
    Table all;
    const std::span<const NamingConvention> conventions = namingConventions();
    for (std::size_t c = 0; c < conventions.size(); ++c) {
      const NamingConvention& convention = conventions[c];
      for (const RoleNames& row : convention.roles) {
        for (const std::string_view pattern : wordsIn(row.names)) {
          const bool sided = isSided(pattern);
          for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
            if (sided == (side == Side::kCenter)) continue;
            for (const bool withBrackets : {false, true}) {
              const std::string key = plainNameOf(writtenOut(convention, pattern, side, {}, withBrackets)).text;
              std::vector<TableEntry>& entries = all[key];
              // The first meaning that a convention gives to a name applies.
              if (!entries.empty() && entries.back().convention == c) continue;
              entries.push_back({static_cast<std::uint16_t>(c), {row.role, side, row.pair}});
            }
          }
        }
      }
    }
    return all;
  }();
  return kTable;
}

// Calls `found(entries)` for the plain name, for it with each of its numbers as any, and with each of its numbers but
// for the first digit as any ("finger01" is the second joint of "finger0").
void lookUp(std::string_view plain, const auto& found) {
  const Table& all = table();
  std::string key(plain);
  const auto tryKey = [&] {
    if (const auto at = all.find(key); at != all.end()) found(at->second);
  };
  tryKey();
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (!isDigit(plain[i])) continue;
    std::size_t end = i;
    while (end < plain.size() && isDigit(plain[end])) ++end;
    for (const std::size_t from : {i, i + 1}) {
      if (from >= end) continue;
      key.assign(plain.substr(0, from)).append("#").append(plain.substr(end));
      tryKey();
    }
    i = end;
  }
}

// The names of a skeleton without their namespaces, and without numbers that stand behind every one of them.
std::vector<PlainName> plainNames(const Skeleton& skeleton) {
  std::size_t numbered = 0;
  const auto numberAt = [](std::string_view name) {
    std::size_t end = name.size();
    while (end > 0 && isDigit(name[end - 1])) --end;
    return end > 1 && end < name.size() && name[end - 1] == '_' ? end - 1 : name.size();
  };
  for (const Joint& joint : skeleton.joints) numbered += numberAt(joint.name) < joint.name.size() ? 1 : 0;
  const bool isNumbered = static_cast<double>(numbered) > kMinNumbered * static_cast<double>(skeleton.joints.size());
  std::vector<PlainName> names;
  names.reserve(skeleton.joints.size());
  for (const Joint& joint : skeleton.joints) {
    std::string_view name = joint.name;
    if (const std::size_t space = name.find_last_of(":|"); space != std::string_view::npos && space + 1 < name.size())
      name.remove_prefix(space + 1);
    if (isNumbered) name = name.substr(0, numberAt(name));
    names.push_back(plainNameOf(name));
  }
  return names;
}

// What each role says of a joint.
struct RoleMeaning {
  JointRole role;
  std::optional<PartState> state = {};
  std::optional<int> orderInLimb = {};  // of segments, from the body to the limb's end; none for what is no segment
  std::optional<int> coreBit = {};      // of a core joint of the left side (coreBit())
};

constexpr std::array kRoleMeanings = {RoleMeaning{JointRole::kRoot, PartState::kOther},
                                      RoleMeaning{JointRole::kHelper, PartState::kOther},
                                      RoleMeaning{JointRole::kAttachment, PartState::kAttachment},
                                      RoleMeaning{JointRole::kHips, PartState::kTrunk, {}, 0},
                                      RoleMeaning{JointRole::kTrunk, PartState::kTrunk, {}, 1},
                                      RoleMeaning{JointRole::kSpineToHead, PartState::kTrunk, {}, 1},
                                      RoleMeaning{JointRole::kNeck, PartState::kNeck},
                                      RoleMeaning{JointRole::kHead, PartState::kHead, {}, 2},
                                      RoleMeaning{JointRole::kJaw, PartState::kJaw},
                                      RoleMeaning{JointRole::kEye, PartState::kEye},
                                      RoleMeaning{JointRole::kTip},
                                      RoleMeaning{JointRole::kCollar, PartState::kArmBase, 0},
                                      RoleMeaning{JointRole::kUpperArm, PartState::kArmUpper, 1, 9},
                                      RoleMeaning{JointRole::kLowerArm, PartState::kArmMiddle, 2, 11},
                                      RoleMeaning{JointRole::kHand, PartState::kArmEnd, 4, 13},
                                      RoleMeaning{JointRole::kLegBase, PartState::kLegBase, 0},
                                      RoleMeaning{JointRole::kUpperLeg, PartState::kLegUpper, 1, 3},
                                      RoleMeaning{JointRole::kLowerLeg, PartState::kLegMiddle, 2, 5},
                                      RoleMeaning{JointRole::kHock, PartState::kLegHock, 3},
                                      RoleMeaning{JointRole::kFoot, PartState::kLegEnd, 4, 7},
                                      RoleMeaning{JointRole::kToes, PartState::kLegToes, 5},
                                      RoleMeaning{JointRole::kPalm, PartState::kFinger},
                                      RoleMeaning{JointRole::kThumb, PartState::kFinger},
                                      RoleMeaning{JointRole::kIndex, PartState::kFinger},
                                      RoleMeaning{JointRole::kMiddle, PartState::kFinger},
                                      RoleMeaning{JointRole::kRing, PartState::kFinger},
                                      RoleMeaning{JointRole::kLittle, PartState::kFinger},
                                      RoleMeaning{JointRole::kTail, PartState::kTail, {}, 24},
                                      RoleMeaning{JointRole::kHair, PartState::kHair},
                                      RoleMeaning{JointRole::kEar, PartState::kEar},
                                      RoleMeaning{JointRole::kWing, PartState::kWing, {}, 25}};

constexpr const RoleMeaning& meaningOf(JointRole role) {
  return kRoleMeanings[static_cast<std::size_t>(role)];
}
static_assert(std::all_of(kRoleMeanings.begin(), kRoleMeanings.end(),
                          [](const RoleMeaning& row) { return &row == &meaningOf(row.role); }));

// A bit for each core joint; none for others.
std::uint32_t coreBit(const NamedRole& named) {
  constexpr int kHindLegs = 12;  // from the bits of the fore legs, or of the only pair, to those of the hind legs
  const auto& [role, state, order, bit] = meaningOf(named.role);
  if (!bit) return 0;
  const bool isSided = order || role == JointRole::kWing, isLeg = order && role >= JointRole::kLegBase;
  return 1u << (*bit + (isSided && named.side == Side::kRight ? 1 : 0) + (isLeg && named.pair == 1 ? kHindLegs : 0));
}

// Whether enough of a body is named: an upper and a lower leg and, of people, arm, of animals two pairs of legs.
bool isWhole(std::uint32_t core) {
  const auto named = [&](int segment) { return (core >> (3 + 2 * segment) & 3u) != 0; };
  const bool limbs = named(0) && named(1) && ((named(3) && named(4)) || (named(6) && named(7)));
  return limbs && static_cast<std::size_t>(std::popcount(core)) >= kMinCoreJoints;
}

// Which convention has most of the names when they are read behind one prefix.
struct Vote {
  std::size_t convention = 0, named = 0;
  std::uint32_t core = 0;
};

bool hasPrefix(const Skeleton& skeleton, std::string_view prefix) {
  const std::string plain = plainNameOf(prefix).text;
  return !plain.empty() && std::any_of(skeleton.joints.begin(), skeleton.joints.end(), [&](const Joint& joint) {
    return plainNameOf(joint.name).text.starts_with(plain);
  });
}

class Finder {
 public:
  explicit Finder(const Skeleton& skeleton) : names_(plainNames(skeleton)) {
    for (const NamingConvention& convention : namingConventions())
      hasOwnPrefix_.push_back(hasPrefix(skeleton, convention.prefix));
  }

  std::optional<ConventionMatch> find() const {
    std::string prefix;
    Vote best = voteFor(prefix);
    if (!isWhole(best.core)) {
      for (const std::string& other : commonPrefixes()) {
        const Vote vote = voteFor(other);
        if (std::pair(isWhole(vote.core), vote.named) <= std::pair(isWhole(best.core), best.named)) continue;
        best = vote;
        prefix = other;
      }
    }
    if (!isWhole(best.core)) return std::nullopt;
    ConventionMatch match;
    match.convention = &namingConventions()[best.convention];
    match.roles.resize(names_.size());
    for (std::size_t j = 0; j < names_.size(); ++j) match.roles[j] = roleOf(j, prefix, best.convention);
    match.partners = partnersIn(match);
    return match;
  }

 private:
  // The name with its side replaced by the other is that of a joint of the same role.
  std::vector<std::optional<Index>> partnersIn(const ConventionMatch& match) const {
    std::unordered_map<std::string, Index> rights;
    for (Index j = 0; j < names_.size(); ++j) {
      if (match.roles[j] && match.roles[j]->side == Side::kRight) rights.emplace(names_[j].text, j);
    }
    std::vector<std::optional<Index>> partners(names_.size());
    for (Index j = 0; j < names_.size(); ++j) {
      if (!match.roles[j] || match.roles[j]->side != Side::kLeft) continue;
      for (const auto& sides : {match.convention->sides, match.convention->otherSides}) {
        const std::string left = plainNameOf(sides[0]).text, right = plainNameOf(sides[1]).text;
        if (left.empty() || partners[j]) continue;
        for (std::size_t at = names_[j].text.find(left); at != std::string::npos && !partners[j];
             at = names_[j].text.find(left, at + 1)) {
          const auto found = rights.find(std::string(names_[j].text).replace(at, left.size(), right));
          if (found == rights.end() || match.roles[found->second]->role != match.roles[j]->role) continue;
          partners[j] = found->second;
          partners[found->second] = j;
        }
      }
    }
    return partners;
  }

  // What begins the names of many joints, before a word of theirs; the commonest first.
  std::vector<std::string> commonPrefixes() const {
    std::map<std::string, std::size_t> counts;
    for (const PlainName& name : names_) {
      for (const std::size_t start : name.starts) {
        if (start > 0) ++counts[name.text.substr(0, start)];
      }
    }
    std::vector<std::string> prefixes;
    for (const auto& [prefix, count] : counts) {
      if (count >= kMinCoreJoints) prefixes.push_back(prefix);
    }
    std::stable_sort(prefixes.begin(), prefixes.end(),
                     [&](const std::string& a, const std::string& b) { return counts[a] > counts[b]; });
    constexpr std::size_t kMaxPrefixes = 6;  // "bip01", "bip01l" and so on: the commonest are tried
    prefixes.resize(std::min(prefixes.size(), kMaxPrefixes));
    return prefixes;
  }

  Vote voteFor(const std::string& prefix) const {
    std::vector<Vote> votes(namingConventions().size());
    for (std::size_t c = 0; c < votes.size(); ++c) votes[c].convention = c;
    for (const PlainName& name : names_) {
      if (!name.text.starts_with(prefix)) continue;
      std::uint64_t counted = 0;
      lookUp(std::string_view(name.text).substr(prefix.size()), [&](const std::vector<TableEntry>& entries) {
        for (const TableEntry& entry : entries) {
          if (counted >> entry.convention & 1) continue;
          counted |= std::uint64_t{1} << entry.convention;
          ++votes[entry.convention].named;
          votes[entry.convention].core |= coreBit(entry.role);
        }
      });
    }
    // Where programs use the same names, the one whose prefix the joints have.
    const auto rank = [&](const Vote& vote) {
      return std::pair(isWhole(vote.core), vote.named * (hasOwnPrefix_[vote.convention] ? 2 : 1));
    };
    return *std::max_element(votes.begin(), votes.end(),
                             [&](const Vote& a, const Vote& b) { return rank(a) < rank(b); });
  }

  std::optional<NamedRole> roleOf(std::size_t joint, const std::string& prefix, std::size_t convention) const {
    std::optional<NamedRole> role;
    const std::string& name = names_[joint].text;
    if (!name.starts_with(prefix)) return role;
    lookUp(std::string_view(name).substr(prefix.size()), [&](const std::vector<TableEntry>& entries) {
      for (const TableEntry& entry : entries) {
        if (!role && entry.convention == convention) role = entry.role;
      }
    });
    return role;
  }

  std::vector<PlainName> names_;    // #J
  std::vector<bool> hasOwnPrefix_;  // #conventions, whether some joint has the prefix of its files
};

constexpr int kLowerSegment = 3;  // orderInLimb: hands and feet may be roots of their own, as for inverse kinematics

bool isOfArm(JointRole role) {
  return role >= JointRole::kCollar && role <= JointRole::kHand;
}

bool isFinger(JointRole role) {
  return role >= JointRole::kPalm && role <= JointRole::kLittle;
}

// Takes away the roles that the tree contradicts.
class TreeCheck {
 public:
  TreeCheck(const Skeleton& skeleton, std::span<const Vec3> rest, ConventionMatch& match)
      : tree_(skeleton), match_(match), rest_(rest) {}

  // False where the tree is not the convention's.
  bool agrees() {
    decideSpineToHead();
    if (lacksForefeet() || bendsBetween()) return false;
    std::size_t named = 0;
    std::vector<Index> wrong;
    for (Index j = 0; j < tree_.size(); ++j) {
      if (!match_.roles[j]) continue;
      ++named;
      if (!isAttachedRight(j)) wrong.push_back(j);
    }
    for (const Index j : wrong) match_.roles[j].reset();
    match_.contradicted = wrong;
    return static_cast<double>(wrong.size()) <= kMaxContradicted * static_cast<double>(named);
  }

 private:
  // Of a numbered spine the joints above where the arms begin are the neck's, and the last one is the head, where no
  // other joint is.
  void decideSpineToHead() {
    std::optional<Index> arms;
    bool hasHead = false;
    std::vector<Index> spine;
    for (const Index j : tree_.order()) {
      if (!match_.roles[j]) continue;
      const JointRole role = match_.roles[j]->role;
      if (role == JointRole::kHead) hasHead = true;
      if (role == JointRole::kSpineToHead) spine.push_back(j);
      if (role != JointRole::kCollar && role != JointRole::kUpperArm) continue;
      arms = arms ? tree_.meeting(*arms, j) : std::optional(j);
      if (!arms) return;
    }
    for (std::size_t i = 0; i < spine.size(); ++i) {
      JointRole& role = match_.roles[spine[i]]->role;
      const bool isAboveArms = arms && tree_.isAboveOrSelf(spine[i], *arms);
      const bool isLast = i + 1 == spine.size();
      role = i == 0                 ? JointRole::kHips
             : !arms || isAboveArms ? JointRole::kTrunk
             : isLast && !hasHead   ? JointRole::kHead
                                    : JointRole::kNeck;
    }
  }

  // A joint without a name that bends a limb between its upper and its lower bone makes it another kind of limb, as a
  // leg of three bones.
  bool bendsBetween() const {
    constexpr double kOffLine = 0.1;  // fraction of the length; twist joints lie nearer to the line
    for (Index lower = 0; lower < tree_.size(); ++lower) {
      const std::optional<NamedRole>& role = match_.roles[lower];
      if (!role || (role->role != JointRole::kLowerLeg && role->role != JointRole::kLowerArm)) continue;
      std::vector<Index> between;
      std::optional<Index> up = tree_.parent(lower);
      for (; up && !match_.roles[*up]; up = tree_.parent(*up)) between.push_back(*up);
      if (!up || (match_.roles[*up]->role != JointRole::kUpperLeg && match_.roles[*up]->role != JointRole::kUpperArm))
        continue;
      const Vec3 line = rest_[lower] - rest_[*up];
      for (const Index joint : between) {
        if (line.cross(rest_[joint] - rest_[*up]).norm() > kOffLine * line.squaredNorm()) return true;
      }
    }
    return false;
  }

  // What is called a foreleg and has no foot may be an arm: then it is another animal.
  bool lacksForefeet() const {
    const auto has = [&](JointRole role, int pair) {
      return std::any_of(match_.roles.begin(), match_.roles.end(), [&](const std::optional<NamedRole>& each) {
        return each && each->role == role && each->pair == pair;
      });
    };
    return has(JointRole::kUpperLeg, 1) && !has(JointRole::kFoot, 0);
  }

  bool isAttachedRight(Index joint) const {
    const NamedRole& own = *match_.roles[joint];
    const std::optional<int> order = meaningOf(own.role).orderInLimb;
    bool isJoined = false;
    const bool isCenter = own.role == JointRole::kHips || own.role == JointRole::kTrunk ||
                          own.role == JointRole::kNeck || own.role == JointRole::kHead;
    for (std::optional<Index> up = tree_.parent(joint); up; up = tree_.parent(*up)) {
      if (!match_.roles[*up]) continue;
      const NamedRole& above = *match_.roles[*up];
      const std::optional<int> orderAbove = meaningOf(above.role).orderInLimb;
      if (isCenter && (orderAbove || isFinger(above.role))) return false;
      if (isCenter && rankInCenter(above.role) > rankInCenter(own.role)) return false;
      if (isFinger(own.role) && orderAbove && !(isOfArm(above.role) && above.side == own.side)) return false;
      if (!order) continue;
      if (isFinger(above.role)) return false;
      if (!orderAbove) continue;
      const bool sameLimb =
          above.side == own.side && isOfArm(above.role) == isOfArm(own.role) && above.pair == own.pair;
      if (!sameLimb || *orderAbove > *order) return false;
      isJoined = isJoined || *orderAbove < *order;
    }
    return isJoined || !order || *order > kLowerSegment || !isBelowAnother(own, *order);
  }

  // Whether the skeleton has a segment of the same limb that comes before it.
  bool isBelowAnother(const NamedRole& own, int order) const {
    return std::any_of(match_.roles.begin(), match_.roles.end(), [&](const std::optional<NamedRole>& other) {
      const std::optional<int> before = other ? meaningOf(other->role).orderInLimb : std::nullopt;
      if (!before || *before == 0 || *before >= order) return false;
      return other->side == own.side && other->pair == own.pair && isOfArm(other->role) == isOfArm(own.role);
    });
  }

  // From the hips to the head; what carries hips is rated as they are.
  static int rankInCenter(JointRole role) { return role == JointRole::kNeck ? 1 : role == JointRole::kHead ? 2 : 0; }

  JointTree tree_;
  ConventionMatch& match_;
  std::span<const Vec3> rest_;  // #J
};

// Animals that are named as people are: the trunk lies across the legs, and the arms reach as low as these. Of people
// the arms of no rest pose do.
bool restsOnArms(const ConventionMatch& match, std::span<const Vec3> rest) {
  // Cosine between trunk and legs, 32 degrees: above it the trunk goes on from the legs.
  constexpr double kAcross = 0.85;
  // Fractions of the legs' length by which hands, or elbows where there are no hands, may be higher than feet.
  constexpr double kHands = 0.3, kElbows = 0.7;
  const auto at = [&](JointRole role) { return meanPosition(match.roles, rest, {role}); };
  const std::optional<Vec3> hips = at(JointRole::kUpperLeg), feet = at(JointRole::kFoot),
                            shoulders = at(JointRole::kUpperArm), hands = at(JointRole::kHand),
                            elbows = at(JointRole::kLowerArm);
  if (!hips || !feet || !shoulders || (!hands && !elbows)) return false;
  const Vec3 legs = *feet - *hips, trunk = *shoulders - *hips;
  if (legs.norm() <= 0 || trunk.norm() <= 0) return false;
  const Vec3 down = legs.normalized();
  const double higher = down.dot(*feet - (hands ? *hands : *elbows)) / legs.norm();
  return std::abs(down.dot(trunk)) < kAcross * trunk.norm() && higher < (hands ? kHands : kElbows);
}

}  // namespace

std::optional<ConventionMatch> findConvention(const Skeleton& skeleton) {
  if (skeleton.joints.size() < kMinCoreJoints) return std::nullopt;
  std::optional<ConventionMatch> match = Finder(skeleton).find();
  if (!match) return std::nullopt;
  const std::vector<Vec3> rest = restPositions(skeleton);
  if (!TreeCheck(skeleton, rest, *match).agrees() || restsOnArms(*match, rest)) return std::nullopt;
  return match;
}

std::optional<Vec3> meanPosition(std::span<const std::optional<NamedRole>> jointRoles, std::span<const Vec3> positions,
                                 std::initializer_list<JointRole> roles) {
  Vec3 sum = Vec3::Zero();
  std::size_t count = 0;
  for (std::size_t j = 0; j < positions.size(); ++j) {
    if (!jointRoles[j] || std::find(roles.begin(), roles.end(), jointRoles[j]->role) == roles.end()) continue;
    sum += positions[j];
    ++count;
  }
  return count > 0 ? std::optional<Vec3>(sum / static_cast<double>(count)) : std::nullopt;
}

std::optional<PartState> stateOf(JointRole role) {
  return meaningOf(role).state;
}

std::string conventionName(const NamingConvention& convention, JointRole role, Side side, std::size_t number,
                           int pair) {
  for (const RoleNames& row : convention.roles) {
    if (row.role != role || row.pair != pair) continue;
    std::vector<std::string_view> patterns = wordsIn(row.names);
    std::erase_if(patterns, [](std::string_view pattern) { return !isOwn(pattern); });
    if (patterns.empty()) continue;
    const std::size_t at = isNumbered(patterns.front()) ? 0 : std::min(number, patterns.size() - 1);
    if (isSided(patterns[at]) != (side != Side::kCenter)) continue;
    if (!isNumbered(patterns[at]) && number >= patterns.size()) continue;
    return ownName(convention, patterns[at], side, number - at);
  }
  return "";
}

std::vector<std::string> conventionNames(const NamingConvention& convention, JointRole role, Side side,
                                         std::size_t count) {
  std::vector<std::string> names;
  for (const RoleNames& row : convention.roles) {
    if (row.role != role) continue;
    for (const std::string_view pattern : wordsIn(row.names)) {
      if (!isOwn(pattern) || isSided(pattern) != (side != Side::kCenter)) continue;
      for (std::size_t i = 0; i < (isNumbered(pattern) ? count : 1); ++i) {
        names.push_back(ownName(convention, pattern, side, i));
      }
    }
  }
  return names;
}

}  // namespace limber
