// NumPy's array files, made byte by byte for tests. Not installed.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "limber/core/file/file.h"

namespace limber::testing {

// Version 1.0, the header filled up to 64 bytes as NumPy does.
inline Bytes npyOf(const std::string& header, const Bytes& data, int version = 1) {
  const std::size_t lengthSize = version == 1 ? 2 : 4, start = 8 + lengthSize;
  std::string text = header;
  while ((start + text.size() + 1) % 64 != 0) text += ' ';
  text += '\n';
  Bytes bytes = {0x93, 'N', 'U', 'M', 'P', 'Y', static_cast<std::uint8_t>(version), 0};
  for (std::size_t i = 0; i < lengthSize; ++i) bytes.push_back(static_cast<std::uint8_t>(text.size() >> 8 * i));
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

inline std::string npyHeader(const std::string& type, const std::string& shape, bool isFortran = false) {
  return "{'descr': '" + type + "', 'fortran_order': " + (isFortran ? "True" : "False") + ", 'shape': " + shape + ", }";
}

template <typename T>
Bytes rawBytes(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string shapeText(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (const std::size_t length : shape) text += std::to_string(length) + ", ";
  if (shape.size() > 1) text.resize(text.size() - 2);
  return text + ")";
}

inline Bytes npyDoubles(const std::vector<std::size_t>& shape, const std::vector<double>& values) {
  return npyOf(npyHeader("<f8", shapeText(shape)), rawBytes(values));
}

}  // namespace limber::testing
