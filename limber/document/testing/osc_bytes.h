// Packets of Open Sound Control, made byte by byte for tests. Not installed.
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "limber/core/file/file.h"
#include "limber/core/transform.h"

namespace limber::testing {

using OscArgument = std::variant<float, std::string>;

inline void putOscText(Bytes& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
  do bytes.push_back(0);
  while (bytes.size() % 4 != 0);
}

inline void putOscNumber(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

inline Bytes oscMessage(std::string_view address, const std::vector<OscArgument>& arguments) {
  Bytes bytes;
  putOscText(bytes, address);
  std::string types = ",";
  for (const OscArgument& argument : arguments) types += argument.index() == 0 ? 'f' : 's';
  putOscText(bytes, types);
  for (const OscArgument& argument : arguments) {
    if (const float* value = std::get_if<float>(&argument))
      putOscNumber(bytes, std::bit_cast<std::uint32_t>(*value));
    else
      putOscText(bytes, std::get<std::string>(argument));
  }
  return bytes;
}

inline Bytes oscBundle(const std::vector<Bytes>& elements) {
  Bytes bytes;
  putOscText(bytes, "#bundle");
  bytes.insert(bytes.end(), 8, 0);  // due at once
  for (const Bytes& element : elements) {
    putOscNumber(bytes, static_cast<std::uint32_t>(element.size()));
    bytes.insert(bytes.end(), element.begin(), element.end());
  }
  return bytes;
}

// As VMC sends a bone or the root: numbers in Unity's space.
inline Bytes vmcMessage(std::string_view address, const std::string& name, const Vec3& position, const Quat& rotation) {
  std::vector<OscArgument> values = {name};
  for (const double value :
       {position.x(), position.y(), position.z(), rotation.x(), rotation.y(), rotation.z(), rotation.w()}) {
    values.emplace_back(static_cast<float>(value));
  }
  return oscMessage(address, values);
}

}  // namespace limber::testing
