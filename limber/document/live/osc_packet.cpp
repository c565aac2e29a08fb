#include "limber/document/live/osc_packet.h"

#include <algorithm>
#include <optional>

#include "limber/core/file/bits.h"

namespace limber {

namespace {

constexpr std::string_view kBundle = "#bundle";
constexpr std::size_t kTimeTag = 8;  // bytes
constexpr int kDeepest = 8;
constexpr std::size_t kMaxValues = 32;

// Reads a packet from its front; nothing where it ends before.
class OscReader {
 public:
  explicit OscReader(ByteSpan bytes) : bytes_(bytes) {}

  bool atEnd() const { return bytes_.empty(); }

  std::optional<ByteSpan> bytes(std::size_t count) {
    if (count > bytes_.size()) return std::nullopt;
    const ByteSpan front = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return front;
  }

  std::optional<std::uint32_t> number() {
    const std::optional<ByteSpan> four = bytes(4);
    if (!four) return std::nullopt;
    std::uint32_t value = 0;
    for (const std::uint8_t byte : *four) value = value << 8 | byte;
    return value;
  }

  // Up to its zero, which fills up to a multiple of four bytes.
  std::optional<std::string_view> text() {
    const auto end = std::find(bytes_.begin(), bytes_.end(), std::uint8_t{0});
    if (end == bytes_.end()) return std::nullopt;
    const auto length = static_cast<std::size_t>(end - bytes_.begin());
    const std::optional<ByteSpan> padded = bytes(length / 4 * 4 + 4);
    if (!padded) return std::nullopt;
    return std::string_view(reinterpret_cast<const char*>(padded->data()), length);
  }

 private:
  ByteSpan bytes_;
};

std::optional<OscMessage> readMessage(ByteSpan packet) {
  OscReader reader(packet);
  const std::optional<std::string_view> address = reader.text();
  if (!address || !address->starts_with('/')) return std::nullopt;
  OscMessage message{*address, {}};
  if (reader.atEnd()) return message;  // old senders leave the types out where there are no values
  const std::optional<std::string_view> types = reader.text();
  if (!types || !types->starts_with(',') || types->size() > kMaxValues + 1) return std::nullopt;
  for (const char type : types->substr(1)) {
    if (type == 'T' || type == 'F' || type == 'N' || type == 'I') {
      message.values.emplace_back(std::int32_t{type == 'T'});
    } else if (type == 's') {
      const std::optional<std::string_view> text = reader.text();
      if (!text) return std::nullopt;
      message.values.emplace_back(*text);
    } else {
      const std::optional<std::uint32_t> bits = reader.number();
      if (!bits || (type != 'i' && type != 'f')) return std::nullopt;
      if (type == 'f') message.values.emplace_back(bitCast<float>(*bits));
      if (type == 'i') message.values.emplace_back(static_cast<std::int32_t>(*bits));
    }
  }
  if (!reader.atEnd()) return std::nullopt;
  return message;
}

bool readElement(ByteSpan packet, int depth, const std::function<void(const OscMessage&)>& take) {
  OscReader reader(packet);
  if (packet.size() % 4 != 0) return false;
  const std::optional<std::string_view> begin = reader.text();
  if (begin != kBundle) {
    const std::optional<OscMessage> message = readMessage(packet);
    if (message) take(*message);
    return message.has_value();
  }
  if (depth == kDeepest || !reader.bytes(kTimeTag)) return false;
  while (!reader.atEnd()) {
    const std::optional<std::uint32_t> size = reader.number();
    const std::optional<ByteSpan> element = size ? reader.bytes(*size) : std::nullopt;
    if (!element || element->empty() || !readElement(*element, depth + 1, take)) return false;
  }
  return true;
}

}  // namespace

bool readOscPacket(ByteSpan packet, const std::function<void(const OscMessage&)>& take) {
  return readElement(packet, 0, take);
}

}  // namespace limber
