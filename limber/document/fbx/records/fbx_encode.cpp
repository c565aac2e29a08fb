// The layout is the one that A. Gessler describes ("FBX binary file format specification", Blender's developer blog,
// 2013); the footer was compared with files of the FBX SDK 2015 to 2020.
#include "limber/document/fbx/records/fbx_encode.h"

#include <array>
#include <limits>
#include <type_traits>

#include "limber/core/error.h"
#include "limber/core/file/bits.h"
#include "limber/core/file/deflate.h"
#include "limber/document/fbx/records/fbx_binary.h"

namespace limber {

namespace {

constexpr std::uint32_t kVersion = 7400;
constexpr std::size_t kEndOfList = 13;  // bytes of an empty record

constexpr std::array<std::uint8_t, 16> kFileId = {0x28, 0xb3, 0x2a, 0xeb, 0xb6, 0x24, 0xcc, 0xc2,
                                                  0xbf, 0xc8, 0xb0, 0x2a, 0xa9, 0x2b, 0xfc, 0xf1};
constexpr std::array<std::uint8_t, 16> kFootId = {0xfa, 0xbc, 0xab, 0x09, 0xd0, 0xc8, 0xd4, 0x66,
                                                  0xb1, 0x76, 0xfb, 0x83, 0x1c, 0xf7, 0x26, 0x7e};
constexpr std::array<std::uint8_t, 16> kFootMagic = {0xf8, 0x5a, 0x8c, 0x6a, 0xde, 0xf5, 0xd9, 0x7e,
                                                     0xec, 0xe9, 0x0c, 0xe3, 0x75, 0x8f, 0x29, 0x0b};

// The letter that tells a value's type.
template <typename Value>
constexpr char letterOf() {
  if constexpr (std::is_same_v<Value, bool>) return 'C';
  if constexpr (std::is_same_v<Value, std::int16_t>) return 'Y';
  if constexpr (std::is_same_v<Value, std::int32_t>) return 'I';
  if constexpr (std::is_same_v<Value, std::int64_t>) return 'L';
  if constexpr (std::is_same_v<Value, float>) return 'F';
  if constexpr (std::is_same_v<Value, double>) return 'D';
  if constexpr (std::is_same_v<Value, std::string>) return 'S';
  if constexpr (std::is_same_v<Value, Bytes>) return 'R';
  if constexpr (std::is_same_v<Value, std::vector<bool>>) return 'b';
  if constexpr (std::is_same_v<Value, std::vector<std::int32_t>>) return 'i';
  if constexpr (std::is_same_v<Value, std::vector<std::int64_t>>) return 'l';
  if constexpr (std::is_same_v<Value, std::vector<float>>) return 'f';
  if constexpr (std::is_same_v<Value, std::vector<double>>) return 'd';
}

template <typename Number>
void append(Bytes& out, Number number) {
  const auto bytes = bitCast<std::array<std::uint8_t, sizeof(Number)>>(number);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::uint32_t inFourBytes(std::size_t size) {
  if (size < std::numeric_limits<std::uint32_t>::max()) return static_cast<std::uint32_t>(size);
  throw Error(ErrorCode::kLimit, "an FBX file of this version ends at 4 GB", {}, "write fewer clips into one file");
}

class FbxEncoder {
 public:
  Bytes encode(std::span<const FbxNode> records) {
    out_.assign(kFbxMagic.begin(), kFbxMagic.end());
    out_.insert(out_.end(), {0, 0x1a, 0});
    append(out_, kVersion);
    for (const FbxNode& record : records) write(record);
    out_.resize(out_.size() + kEndOfList);
    writeFooter();
    inFourBytes(out_.size());
    return std::move(out_);
  }

 private:
  void write(const FbxNode& record) {
    const std::size_t start = out_.size();
    out_.resize(start + 12);  // its end, the number of its values, their bytes
    out_.push_back(static_cast<std::uint8_t>(record.name.size()));
    out_.insert(out_.end(), record.name.begin(), record.name.end());
    const std::size_t values = out_.size();
    for (const FbxValue& value : record.values) {
      std::visit([&](const auto& known) { writeValue(known); }, value);
    }
    const std::size_t valueBytes = out_.size() - values;
    for (const FbxNode& child : record.children) write(child);
    if (!record.children.empty() || record.values.empty()) out_.resize(out_.size() + kEndOfList);
    const std::array<std::uint32_t, 3> head = {inFourBytes(out_.size()), inFourBytes(record.values.size()),
                                               inFourBytes(valueBytes)};
    std::memcpy(&out_[start], head.data(), sizeof(head));
  }

  template <typename Value>
  void writeValue(const Value& value) {
    out_.push_back(static_cast<std::uint8_t>(letterOf<Value>()));
    if constexpr (std::is_same_v<Value, bool>) {
      out_.push_back(value ? 'Y' : 'T');  // as Autodesk's readers want it: odd is true
    } else if constexpr (std::is_arithmetic_v<Value>) {
      append(out_, value);
    } else if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, Bytes>) {
      append(out_, inFourBytes(value.size()));
      out_.insert(out_.end(), value.begin(), value.end());
    } else if constexpr (std::is_same_v<Value, std::vector<bool>>) {
      writeArray(value.size(), Bytes(value.begin(), value.end()));
    } else {
      writeArray(value.size(), {reinterpret_cast<const std::uint8_t*>(value.data()),
                                value.size() * sizeof(typename Value::value_type)});
    }
  }

  void writeArray(std::size_t count, ByteSpan bytes) {
    const Bytes packed = deflateZlib(bytes);
    const bool isPacked = packed.size() < bytes.size();
    const ByteSpan stored = isPacked ? ByteSpan(packed) : bytes;
    append(out_, inFourBytes(count));
    append(out_, std::uint32_t{isPacked});
    append(out_, inFourBytes(stored.size()));
    out_.insert(out_.end(), stored.begin(), stored.end());
  }

  // In files of the SDK the length is a multiple of 16.
  void writeFooter() {
    out_.insert(out_.end(), kFootId.begin(), kFootId.end());
    out_.resize((out_.size() + 15) / 16 * 16 + 4);
    append(out_, kVersion);
    out_.resize(out_.size() + 120);
    out_.insert(out_.end(), kFootMagic.begin(), kFootMagic.end());
  }

  Bytes out_;
};

}  // namespace

ByteSpan fbxFileId() {
  return kFileId;
}

Bytes encodeFbxFile(std::span<const FbxNode> records) {
  return FbxEncoder().encode(records);
}

}  // namespace limber
