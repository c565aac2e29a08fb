#include "limber/core/text/printable.h"

#include <fmt/format.h>

namespace limber {

namespace {

std::string withoutControls(std::string_view text, std::string_view kept) {
  constexpr unsigned char kDelete = 0x7f, kLead = 0xc2, kFirst = 0x80, kLast = 0x9f;  // U+0080 to U+009F in UTF-8
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if ((byte < ' ' && kept.find(text[i]) == kept.npos) || byte == kDelete) {
      plain += fmt::format("\\x{:02x}", byte);
    } else if (byte == kLead && next >= kFirst && next <= kLast) {
      plain += fmt::format("\\u{:04x}", next);
      ++i;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

}  // namespace

std::string printable(std::string_view line) {
  return withoutControls(line, "");
}

std::string shortened(std::string_view word, std::size_t most) {
  if (word.size() <= most) return printable(word);
  const auto isInside = [&](std::size_t at) { return (static_cast<unsigned char>(word[at]) & 0xc0) == 0x80; };
  std::size_t end = most;
  while (end > 0 && most - end < 3 && isInside(end)) --end;
  return printable(word.substr(0, end)) + "...";
}

std::string printableText(std::string_view text) {
  return withoutControls(text, "\n\t");
}

}  // namespace limber
