// Packets of Open Sound Control 1.0 (opensoundcontrol.stanford.edu), as VMC sends them: messages, alone or in bundles.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <variant>
#include <vector>

#include "limber/core/file/file.h"

namespace limber {

// A number or a text; the text is the packet's own memory.
using OscValue = std::variant<std::int32_t, float, std::string_view>;

struct OscMessage {
  std::string_view address;  // "/VMC/Ext/Bone/Pos", in the packet's own memory
  std::vector<OscValue> values;
};

// Calls `take` for each message, in their order, including those of nested bundles (8 deep); the time at which a bundle
// is due is ignored. False where the packet is invalid, from the first error on: a text without its end, sizes that are
// no multiples of four or exceed the packet, values of other types than i, f, s, T, F, N and I, more than 32 of them.
// Memory is that of one message.
bool readOscPacket(ByteSpan packet, const std::function<void(const OscMessage&)>& take);

}  // namespace limber
