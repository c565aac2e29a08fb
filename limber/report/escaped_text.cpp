#include "limber/report/escaped_text.h"

#include "limber/document/utf8.h"

namespace limber {

namespace {

bool isControl(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

}  // namespace

std::string htmlText(std::string_view text) {
  std::string html;
  for (const char c : validUtf8(text)) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += isControl(c) && c != '\n' ? ' ' : c;
    }
  }
  return html;
}

std::string markdownText(std::string_view text) {
  constexpr std::string_view kMarks = "\\`*_{}[]<>#|~&";
  std::string escaped;
  for (const char c : validUtf8(text)) {
    if (kMarks.find(c) != std::string_view::npos) escaped += '\\';
    escaped += isControl(c) ? ' ' : c;
  }
  return escaped;
}

}  // namespace limber
