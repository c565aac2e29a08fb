// A value's bits as another type. std::bit_cast, which the C++ library of emscripten 3.1 lacks.
#pragma once

#include <cstring>
#include <type_traits>

namespace limber {

template <typename To, typename From>
To bitCast(const From& from) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(&to, &from, sizeof(To));
  return to;
}

}  // namespace limber
