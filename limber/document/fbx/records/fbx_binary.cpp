// The layout has no public specification; this follows Blender's notes on it ("FBX binary file format specification",
// code.blender.org 2013) and what its exporter writes.
#include "limber/document/fbx/records/fbx_binary.h"
#include "limber/core/file/read_bounds.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/file/inflate.h"

namespace limber {

namespace {

constexpr std::size_t kVersionAt = 23, kHeaderSize = 27;
constexpr std::uint32_t kFirstWithLongOffsets = 7500;

class BinaryParser {
 public:
  explicit BinaryParser(ByteSpan bytes)
      : bytes_(bytes), inflationLeft_(static_cast<std::size_t>(read_bounds::kFbxArrays.of(bytes.size()))) {}

  FbxFile parse() {
    if (bytes_.size() < kHeaderSize) fail("is cut off");
    if (bytes_[kFbxMagic.size() + 2] != 0) {
      throw Error(ErrorCode::kUnsupported, "is a big-endian FBX file", {}, "export it anew as FBX 7.4");
    }
    FbxFile file;
    at_ = kVersionAt;
    file.version = number<std::uint32_t>();
    checkFbxVersion(file.version);
    hasLongOffsets_ = file.version >= kFirstWithLongOffsets;
    while (at_ < bytes_.size() && addNode(file.root.children, bytes_.size(), 1)) {
    }
    return file;
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw Error(ErrorCode::kBadData, fmt::format("{} (byte {})", what, at_), {}, "export it again");
  }

  ByteSpan take(std::size_t count, std::size_t end) {
    if (count > end - at_) fail("a record of it is cut off");
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof value, bytes_.size()).data(), sizeof value);
    return value;
  }

  std::uint64_t offset() { return hasLongOffsets_ ? number<std::uint64_t>() : number<std::uint32_t>(); }

  // False at the empty record that ends a list.
  bool addNode(std::vector<FbxNode>& list, std::size_t parentEnd, int depth) {
    const std::size_t begin = at_;
    const std::uint64_t end = offset(), valueCount = offset(), valueBytes = offset();
    const auto nameLength = number<std::uint8_t>();
    if (end == 0) return false;
    if (end > parentEnd || end <= begin) fail("a record of it ends outside of the one that it is in");
    if (depth > kDeepestFbxNode) fail("its records are nested too deep");
    const auto nodeEnd = static_cast<std::size_t>(end);
    if (at_ > nodeEnd) fail("a record of it is cut off");
    FbxNode& node = list.emplace_back();
    const ByteSpan name = take(nameLength, nodeEnd);
    node.name.assign(name.begin(), name.end());
    if (valueBytes > nodeEnd - at_) fail("a record of it ends before its values");
    const std::size_t valuesEnd = at_ + static_cast<std::size_t>(valueBytes);
    if (valueCount > valueBytes / 2) fail("a record of it has more values than bytes");  // a value takes 2 at least
    node.values.reserve(static_cast<std::size_t>(valueCount));
    for (std::uint64_t i = 0; i < valueCount; ++i) node.values.push_back(value(valuesEnd));
    if (at_ != valuesEnd) fail("the values of a record are not as long as it says");
    while (at_ < nodeEnd && addNode(node.children, nodeEnd, depth + 1)) {
    }
    if (at_ != nodeEnd) fail("a record of it does not end where it says");
    return true;
  }

  template <typename T>
  T scalar(std::size_t end) {
    T result;
    std::memcpy(&result, take(sizeof result, end).data(), sizeof result);
    return result;
  }

  FbxValue value(std::size_t end) {
    switch (take(1, end)[0]) {
      case 'C': {
        const auto byte = scalar<std::uint8_t>(end);
        if (byte > 1) return std::int16_t{byte};  // a letter
        return byte == 1;
      }
      case 'Y':
        return scalar<std::int16_t>(end);
      case 'I':
        return scalar<std::int32_t>(end);
      case 'L':
        return scalar<std::int64_t>(end);
      case 'F':
        return scalar<float>(end);
      case 'D':
        return scalar<double>(end);
      case 'S': {
        const ByteSpan text = take(scalar<std::uint32_t>(end), end);
        return std::string(text.begin(), text.end());
      }
      case 'R': {
        const ByteSpan raw = take(scalar<std::uint32_t>(end), end);
        return Bytes(raw.begin(), raw.end());
      }
      case 'i':
        return array<std::int32_t>(end);
      case 'l':
        return array<std::int64_t>(end);
      case 'f':
        return array<float>(end);
      case 'd':
        return array<double>(end);
      case 'b':
      case 'c': {
        const std::vector<std::uint8_t> bytes = array<std::uint8_t>(end);
        std::vector<bool> truths(bytes.size());
        std::transform(bytes.begin(), bytes.end(), truths.begin(), [](std::uint8_t b) { return b != 0; });
        return truths;
      }
      default:
        --at_;
        fail("it has a value of a type that is not known");
    }
  }

  template <typename T>
  std::vector<T> array(std::size_t end) {
    const auto count = scalar<std::uint32_t>(end);
    const auto encoding = scalar<std::uint32_t>(end);
    const ByteSpan stored = take(scalar<std::uint32_t>(end), end);
    const std::uint64_t size = std::uint64_t{count} * sizeof(T);
    if (encoding > 1) fail("an array of it is packed in a way that is not known");
    if (encoding == 0 && size != stored.size()) fail("an array of it is not as long as it says");
    if (encoding == 1) {
      if (size / kMaxInflatedPerByte > stored.size()) fail("an array of it is not as long as it says");
      if (size > inflationLeft_) {
        throw Error(ErrorCode::kLimit, "its arrays inflate to more than those of a file of its size should", {},
                    "export it again without compression");
      }
      inflationLeft_ -= static_cast<std::size_t>(size);
    }
    std::vector<T> result(count);
    const std::span<std::uint8_t> out(reinterpret_cast<std::uint8_t*>(result.data()), static_cast<std::size_t>(size));
    if (encoding == 1) {
      inflateZlib(stored, out);
    } else if (size > 0) {
      std::memcpy(out.data(), stored.data(), stored.size());
    }
    return result;
  }

  ByteSpan bytes_;
  std::size_t at_ = 0, inflationLeft_;
  bool hasLongOffsets_ = false;
};

}  // namespace

bool isBinaryFbx(ByteSpan bytes) {
  const ByteSpan magic = asBytes(kFbxMagic);
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

FbxFile parseBinaryFbx(ByteSpan bytes) {
  return BinaryParser(bytes).parse();
}

void checkFbxVersion(std::uint32_t version) {
  if (version >= kOldestFbxVersion && version < 8000) return;
  throw Error(ErrorCode::kUnsupported,
              fmt::format("is FBX {}.{}, which limber does not read", version / 1000, version / 100 % 10), {},
              "save it as FBX 2011 or later (7.1 to 7.7), or as GLB");
}

}  // namespace limber
