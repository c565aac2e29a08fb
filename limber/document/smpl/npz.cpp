#include "limber/document/smpl/npz.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr std::array<std::uint8_t, 6> kNpyMagic = {0x93, 'N', 'U', 'M', 'P', 'Y'};
constexpr std::size_t kMaxAxes = 32;  // NumPy's own limit

struct NpyHeader {
  std::string type;  // "<f8"
  bool isFortran = false;
  std::vector<std::size_t> shape;
};

// {'descr': '<f8', 'fortran_order': False, 'shape': (6890, 3), }: a Python literal of which only this much may be
// there.
class NpyHeaderText {
 public:
  NpyHeaderText(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  NpyHeader read() {
    NpyHeader header;
    std::array<bool, 3> seen = {};
    expect('{');
    while (!take('}')) {
      const std::string key = quoted();
      expect(':');
      const std::size_t number = key == "descr" ? 0 : key == "fortran_order" ? 1 : key == "shape" ? 2 : 3;
      if (number == 3 || seen[number]) refuse();
      seen[number] = true;
      if (number == 0) header.type = type();
      if (number == 1) header.isFortran = truth();
      if (number == 2) header.shape = tuple();
      if (!take(',')) {
        expect('}');
        break;
      }
    }
    skipSpace();
    if (at_ != text_.size() || !(seen[0] && seen[1] && seen[2])) refuse();
    return header;
  }

 private:
  [[noreturn]] void refuse() const {
    throw Error(ErrorCode::kBadData, "has a header that is no NumPy array's", std::string(name_));
  }

  void skipSpace() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }

  bool take(char wanted) {
    skipSpace();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }

  void expect(char wanted) {
    if (!take(wanted)) refuse();
  }

  std::string quoted() {
    const char quote = take('\'') ? '\'' : '"';
    if (quote == '"') expect('"');
    const std::size_t end = text_.find(quote, at_);
    if (end == text_.npos) refuse();
    const std::string result(text_.substr(at_, end - at_));
    at_ = end + 1;
    return result;
  }

  std::string type() {
    if (take('[')) {
      throw Error(ErrorCode::kUnsupported, "holds records, not numbers", std::string(name_));
    }
    return quoted();
  }

  bool truth() {
    skipSpace();
    for (const std::string_view word : {"True", "False"}) {
      if (!text_.substr(at_).starts_with(word)) continue;
      at_ += word.size();
      return word == "True";
    }
    refuse();
  }

  std::size_t length() {
    skipSpace();
    constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max() / 10 - 1;
    std::size_t value = 0;
    const std::size_t begin = at_;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
      if (value > kMax) refuse();
      value = 10 * value + static_cast<std::size_t>(text_[at_] - '0');
    }
    if (at_ == begin) refuse();
    return value;
  }

  std::vector<std::size_t> tuple() {
    std::vector<std::size_t> shape;
    expect('(');
    while (!take(')')) {
      if (shape.size() == kMaxAxes) refuse();
      shape.push_back(length());
      if (!take(',')) {
        expect(')');
        break;
      }
    }
    return shape;
  }

  std::string_view text_, name_;
  std::size_t at_ = 0;
};

std::uint64_t littleEndian(ByteSpan bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

using DecodeNumber = double (*)(std::uint64_t);

struct NpyType {
  std::string_view name;  // without the byte order
  std::size_t size;
  DecodeNumber decode;
};

template <typename Number, typename Bits>
double decodeNumber(std::uint64_t bits) {
  const auto own = static_cast<Bits>(bits);
  Number number;
  std::memcpy(&number, &own, sizeof number);
  return static_cast<double>(number);
}

constexpr NpyType kNpyTypes[] = {
    {"f8", 8, decodeNumber<double, std::uint64_t>},       {"f4", 4, decodeNumber<float, std::uint32_t>},
    {"i8", 8, decodeNumber<std::int64_t, std::uint64_t>}, {"u8", 8, decodeNumber<std::uint64_t, std::uint64_t>},
    {"i4", 4, decodeNumber<std::int32_t, std::uint32_t>}, {"u4", 4, decodeNumber<std::uint32_t, std::uint32_t>},
    {"i2", 2, decodeNumber<std::int16_t, std::uint16_t>}, {"u2", 2, decodeNumber<std::uint16_t, std::uint16_t>},
    {"i1", 1, decodeNumber<std::int8_t, std::uint8_t>},   {"u1", 1, decodeNumber<std::uint8_t, std::uint8_t>},
};

const NpyType& typeOf(const std::string& type, std::string_view name) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::kUnsupported, what, std::string(name), "save it as an array of little-endian float64");
  };
  if (type.size() > 1 && type[1] == 'O') refuse("holds Python objects, which are never unpacked");
  const auto found = std::find_if(std::begin(kNpyTypes), std::end(kNpyTypes), [&](const NpyType& known) {
    return type.size() > 1 && type.substr(1) == known.name;
  });
  if (found == std::end(kNpyTypes)) refuse("holds values of a type that is not read");
  if (type[0] == '>') refuse("holds big-endian numbers");
  if (type[0] != '<' && !(type[0] == '|' && found->size == 1)) refuse("holds values of a type that is not read");
  return *found;
}

// The header's text, and where the numbers begin.
std::pair<std::string_view, std::size_t> headerText(ByteSpan bytes, std::string_view name) {
  const auto refuse = [&](const char* what) { throw Error(ErrorCode::kBadData, what, std::string(name)); };
  if (bytes.size() < kNpyMagic.size() + 2 || !std::equal(kNpyMagic.begin(), kNpyMagic.end(), bytes.begin())) {
    refuse("is no NumPy array: it does not start as one");
  }
  const std::uint8_t version = bytes[kNpyMagic.size()];
  if (version < 1 || version > 3 || bytes[kNpyMagic.size() + 1] != 0) {
    throw Error(ErrorCode::kUnsupported, "is of a version of NumPy's format that is not read", std::string(name));
  }
  const std::size_t lengthAt = kNpyMagic.size() + 2, lengthSize = version == 1 ? 2 : 4, begin = lengthAt + lengthSize;
  if (bytes.size() < begin) refuse("is cut off");
  const std::uint64_t length = littleEndian(bytes.subspan(lengthAt, lengthSize));
  if (length > bytes.size() - begin) refuse("is cut off");
  return {{reinterpret_cast<const char*>(bytes.data()) + begin, static_cast<std::size_t>(length)},
          begin + static_cast<std::size_t>(length)};
}

// How many numbers there are, at most `most`.
std::size_t countOf(const std::vector<std::size_t>& shape, std::size_t most, std::string_view name) {
  if (std::find(shape.begin(), shape.end(), std::size_t{0}) != shape.end()) return 0;
  std::size_t count = 1;
  for (const std::size_t length : shape) {
    if (length > most / count) throw Error(ErrorCode::kBadData, "is cut off", std::string(name));
    count *= length;
  }
  return count;
}

// From Fortran's order, where the first axis runs fastest.
std::vector<double> inRowOrder(const std::vector<double>& values, const std::vector<std::size_t>& shape) {
  std::vector<double> result;
  result.reserve(values.size());
  std::vector<std::size_t> at(shape.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::size_t from = 0;
    for (std::size_t axis = shape.size(); axis-- > 0;) from = from * shape[axis] + at[axis];
    result.push_back(values[from]);
    for (std::size_t axis = shape.size(); axis-- > 0 && ++at[axis] == shape[axis];) at[axis] = 0;
  }
  return result;
}

}  // namespace

bool NpyArray::hasShape(std::span<const std::size_t> wanted) const {
  return std::equal(shape.begin(), shape.end(), wanted.begin(), wanted.end());
}

NpyArray readNpy(ByteSpan bytes, std::string_view name) {
  const auto [text, begin] = headerText(bytes, name);
  NpyHeader header = NpyHeaderText(text, name).read();
  const NpyType& type = typeOf(header.type, name);
  const ByteSpan data = bytes.subspan(begin);
  const std::size_t count = countOf(header.shape, data.size() / type.size, name);
  if (data.size() < count * type.size) throw Error(ErrorCode::kBadData, "is cut off", std::string(name));
  if (data.size() > count * type.size) {
    throw Error(ErrorCode::kBadData, "is longer than its shape says", std::string(name));
  }
  NpyArray array;
  array.values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    array.values.push_back(type.decode(littleEndian(data.subspan(i * type.size, type.size))));
  }
  if (header.isFortran && header.shape.size() > 1) array.values = inRowOrder(array.values, header.shape);
  array.shape = std::move(header.shape);
  return array;
}

std::vector<std::size_t> readNpyShape(ByteSpan bytes, std::string_view name) {
  return NpyHeaderText(headerText(bytes, name).first, name).read().shape;
}

std::optional<NpyArray> npzArray(const NpzFiles& files, const std::string& array) {
  const std::string path = array + ".npy";
  const auto found = files.find(path);
  if (found == files.end()) return std::nullopt;
  return readNpy(found->second, path);
}

}  // namespace limber
