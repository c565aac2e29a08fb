#include "qr_code.h"

#include <qrencode.h>

#include <memory>

#include "limber/core/error.h"

namespace limber::cli {

Squares qrCode(const std::string& text) {
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_L, QR_MODE_8, 1), QRcode_free);
  if (!code) throw Error(ErrorCode::kLimit, "the address is too long for a QR code");
  Squares squares{code->width, {}};
  // The lowest bit of each byte is the colour.
  for (int i = 0; i < code->width * code->width; ++i) squares.dark.push_back((code->data[i] & 1) != 0);
  return squares;
}

}  // namespace limber::cli
