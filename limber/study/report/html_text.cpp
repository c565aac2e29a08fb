#include "limber/study/report/html_text.h"

#include "limber/document/utf8.h"

namespace limber {

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
        html += static_cast<unsigned char>(c) < ' ' && c != '\n' ? ' ' : c;
    }
  }
  return html;
}

}  // namespace limber
