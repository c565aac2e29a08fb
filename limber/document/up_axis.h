// The axis of a motion file that points up.
#pragma once

#include <optional>
#include <string_view>

#include "limber/core/types.h"

namespace limber {

// The axis along which a person's head lies above the feet.
enum class UpAxis { kY, kZ, kMinusY, kMinusZ };

// From that axis up to +Y up: a turn about X, exact. Of vectors, and of the vector part of quaternions.
template <typename Vector>
void turnUpright(Vector& v, UpAxis up) {
  const auto y = v[1], z = v[2];
  if (up == UpAxis::kZ) {
    v[1] = z;
    v[2] = -y;
  } else if (up == UpAxis::kMinusZ) {
    v[1] = -z;
    v[2] = y;
  } else if (up == UpAxis::kMinusY) {
    v[1] = -y;
    v[2] = -z;
  }
}
Quat uprightTurn(UpAxis up);

// "y", "-z": as the option --up has it.
std::string_view nameOf(UpAxis up);
std::optional<UpAxis> upAxisNamed(std::string_view name);
// The opposite direction.
UpAxis opposite(UpAxis up);

}  // namespace limber
