// Names for pieces of a body that two skeletons can have in common: a whole part, or one segment of a limb.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "limber/character/anatomy/anatomy.h"

namespace limber {

// Of a limb from one landmark to the next; of the trunk the pelvis is the base, of a finger each joint a piece.
enum class Segment { kWhole, kBase, kUpper, kMiddle, kHock, kEnd, kToes };

struct BodyPart {
  PartKind kind = PartKind::kOther;
  Side side = Side::kCenter;
  Index pair = 0;  // as Part::pair
  Segment segment = Segment::kWhole;
  Index piece = 0;  // of fingers and of limbs without landmarks: counted from where they hang; of kOther any number

  auto operator<=>(const BodyPart&) const = default;
};

namespace body_part {
inline constexpr BodyPart kPelvis{PartKind::kTrunk, Side::kCenter, 0, Segment::kBase, 0};
inline constexpr BodyPart kTrunk{PartKind::kTrunk, Side::kCenter, 0, Segment::kWhole, 0};
inline constexpr BodyPart kNeck{PartKind::kNeck, Side::kCenter, 0, Segment::kWhole, 0};
inline constexpr BodyPart kHead{PartKind::kHead, Side::kCenter, 0, Segment::kWhole, 0};
inline constexpr BodyPart kTail{PartKind::kTail, Side::kCenter, 0, Segment::kWhole, 0};
constexpr BodyPart leg(Side side, Segment segment, Index pair = 0) {
  return {PartKind::kLeg, side, pair, segment, 0};
}
constexpr BodyPart arm(Side side, Segment segment, Index pair = 0) {
  return {PartKind::kArm, side, pair, segment, 0};
}
}  // namespace body_part

inline constexpr Side kSides[] = {Side::kLeft, Side::kRight};

// As files and people know it: the bones of VRM 1.0 ("hips", "leftUpperArm", "rightIndexProximal"), "trunk", and for
// all else the same pattern: side, segment, kind, number of a further pair, piece ("leftUpperLeg2", "rightWingPiece3").
std::string nameOf(const BodyPart& part);
// Its inverse; nothing for other names.
std::optional<BodyPart> bodyPartNamed(std::string_view name);

// Of which part a joint is, limbs from landmark to landmark; nothing for joints of no part.
std::optional<BodyPart> bodyPartAt(const Anatomy& anatomy, Index joint);
// As one says it to a person: "left upper leg", "right hind foot" where there are two pairs of legs, "left foot 3"
// where there are more. Empty for joints of no part.
std::string labelOf(const Anatomy& anatomy, Index joint);

}  // namespace limber
