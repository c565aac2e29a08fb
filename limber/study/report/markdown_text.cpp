#include "limber/study/report/markdown_text.h"

#include "limber/document/utf8.h"

namespace limber {

std::string markdownText(std::string_view text) {
  constexpr std::string_view kMarks = "\\`*_{}[]<>#|~&";
  std::string escaped;
  for (const char c : validUtf8(text)) {
    const bool isControl = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (kMarks.find(c) != std::string_view::npos) escaped += '\\';
    escaped += isControl ? ' ' : c;
  }
  return escaped;
}

}  // namespace limber
