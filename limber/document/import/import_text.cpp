#include "limber/document/import/import_text.h"

#include <assimp/types.h>

namespace limber {

std::string textOf(const aiString& text) {
  const std::string_view bytes(text.data, text.length);
  if (validUtf8(bytes) == bytes) return std::string(bytes);
  std::string result;
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      result += c;
    } else {
      result += static_cast<char>(0xc0 | code >> 6);
      result += static_cast<char>(0x80 | (code & 0x3f));
    }
  }
  return result;
}

}  // namespace limber
