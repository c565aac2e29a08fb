#include "limber/character/anatomy/part_color.h"

#include <array>

namespace limber {

Hsv partColor(PartKind kind, Side side) {
  if (kind == PartKind::kOther) return {0.6, 0.07, 0.46};
  // Neighbours on a body far apart on the circle: trunk, neck, head, tail, leg, arm, wing, fin, finger, ear, jaw, eye,
  // hair, prop, attachment.
  constexpr std::array<double, kPartKinds> kHues = {0.58, 0.50, 0.14, 0.78, 0.34, 0.03, 0.88, 0.88,
                                                    0.10, 0.70, 0.96, 0.62, 0.20, 0.42, 0.27, 0};
  return {kHues[static_cast<std::size_t>(kind)], side == Side::kLeft ? 0.55 : 0.75, side == Side::kRight ? 0.55 : 0.95};
}

}  // namespace limber
