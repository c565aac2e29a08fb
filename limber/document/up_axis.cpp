#include "limber/document/up_axis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber {

namespace {

constexpr std::array<std::string_view, 4> kUpAxisNames = {"y", "z", "-y", "-z"};  // by UpAxis

}  // namespace

Quat uprightTurn(UpAxis up) {
  const double half = std::sqrt(0.5);
  switch (up) {
    case UpAxis::kZ:
      return Quat(half, -half, 0, 0);
    case UpAxis::kMinusZ:
      return Quat(half, half, 0, 0);
    case UpAxis::kMinusY:
      return Quat(0, 1, 0, 0);
    default:
      return Quat::Identity();
  }
}

std::string_view nameOf(UpAxis up) {
  return kUpAxisNames[static_cast<std::size_t>(up)];
}

std::optional<UpAxis> upAxisNamed(std::string_view name) {
  const auto found = std::find(kUpAxisNames.begin(), kUpAxisNames.end(), name);
  if (found == kUpAxisNames.end()) return std::nullopt;
  return static_cast<UpAxis>(found - kUpAxisNames.begin());
}

UpAxis opposite(UpAxis up) {
  switch (up) {
    case UpAxis::kZ:
      return UpAxis::kMinusZ;
    case UpAxis::kMinusZ:
      return UpAxis::kZ;
    case UpAxis::kMinusY:
      return UpAxis::kY;
    default:
      return UpAxis::kMinusY;
  }
}

}  // namespace limber
