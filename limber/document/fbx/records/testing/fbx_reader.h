// A reader of binary FBX 7.4 that has no code in common with the library: it follows the format's description, with
// zlib for arrays.
#pragma once

#include <cstring>
#include <stdexcept>

#include <zlib.h>

#include "limber/document/fbx/records/fbx_node.h"

namespace limber::testing {

class FbxTestReader {
 public:
  explicit FbxTestReader(ByteSpan bytes) : bytes_(bytes) {}

  // Of all records at the top level; afterwards at() is behind the empty one that ends them.
  std::vector<FbxNode> read() {
    at_ = 27;
    std::vector<FbxNode> records;
    for (FbxNode record; readRecord(record);) records.push_back(std::move(record));
    return records;
  }

  std::size_t at() const { return at_; }

 private:
  template <typename Number>
  Number take() {
    Number number;
    need(sizeof(number));
    std::memcpy(&number, &bytes_[at_], sizeof(number));
    at_ += sizeof(number);
    return number;
  }

  void need(std::size_t count) const {
    if (bytes_.size() - at_ < count) throw std::runtime_error("cut off");
  }

  template <typename Text>
  Text takeText(std::size_t size) {
    need(size);
    Text text(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
              bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + size));
    at_ += size;
    return text;
  }

  bool readRecord(FbxNode& record) {
    record = {};
    const auto end = take<std::uint32_t>(), count = take<std::uint32_t>(), size = take<std::uint32_t>();
    record.name = takeText<std::string>(take<std::uint8_t>());
    if (end == 0) return false;
    const std::size_t values = at_;
    for (std::uint32_t i = 0; i < count; ++i) record.values.push_back(readValue());
    if (at_ != values + size) throw std::runtime_error(record.name + ": its values have another size");
    if (at_ == end) return true;
    for (FbxNode child; readRecord(child);) record.children.push_back(std::move(child));
    if (at_ != end) throw std::runtime_error(record.name + ": ends elsewhere");
    return true;
  }

  FbxValue readValue() {
    switch (take<char>()) {
      case 'C':
        return (take<std::uint8_t>() & 1) != 0;
      case 'Y':
        return take<std::int16_t>();
      case 'I':
        return take<std::int32_t>();
      case 'L':
        return take<std::int64_t>();
      case 'F':
        return take<float>();
      case 'D':
        return take<double>();
      case 'S':
        return takeText<std::string>(take<std::uint32_t>());
      case 'R':
        return takeText<Bytes>(take<std::uint32_t>());
      case 'i':
        return readArray<std::int32_t>();
      case 'l':
        return readArray<std::int64_t>();
      case 'f':
        return readArray<float>();
      case 'd':
        return readArray<double>();
      default:
        throw std::runtime_error("a value of no known type");
    }
  }

  template <typename Number>
  std::vector<Number> readArray() {
    std::vector<Number> array(take<std::uint32_t>());
    const auto encoding = take<std::uint32_t>(), size = take<std::uint32_t>();
    const Bytes stored = takeText<Bytes>(size);
    uLongf length = array.size() * sizeof(Number);
    if (encoding == 0 && size == length) {
      if (size > 0) std::memcpy(array.data(), stored.data(), size);
    } else if (encoding != 1 ||
               uncompress(reinterpret_cast<Bytef*>(array.data()), &length, stored.data(), size) != Z_OK ||
               length != array.size() * sizeof(Number)) {
      throw std::runtime_error("an array that is not what it says");
    }
    return array;
  }

  ByteSpan bytes_;
  std::size_t at_ = 0;
};

}  // namespace limber::testing
