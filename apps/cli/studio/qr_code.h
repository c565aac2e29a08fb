// A QR code (ISO/IEC 18004) of an address.
#pragma once

#include <string>

#include "half_blocks.h"

namespace limber::cli {

constexpr int kQrMargin = 4;  // light squares that a reader expects around it

// The smallest that holds the text, with correction of 7 % of it. Throws Error kLimit for more than 2900 bytes.
Squares qrCode(const std::string& text);

}  // namespace limber::cli
