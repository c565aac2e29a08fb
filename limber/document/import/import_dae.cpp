#include "limber/document/import/import_dae.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr std::string_view kXmlSpace = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kXmlSpace);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kXmlSpace) + 1 - begin);
}

// The length of what a text begins with, a '<' its first letter: a tag, a comment, a section of plain text.
std::size_t markupLength(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kOthers = {
      {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}};
  for (const auto& [begin, end] : kOthers) {
    if (!text.starts_with(begin)) continue;
    const std::size_t at = text.find(end, begin.size());
    return at == text.npos ? text.size() : at + end.size();
  }
  char quote = '\0';  // within which a '>' ends nothing
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i + 1;
    }
  }
  return text.size();
}

// Names of interpolations and nothing else, not all of them LINEAR.
bool areCurvedInterpolations(std::string_view text) {
  constexpr std::array<std::string_view, 6> kNames = {"LINEAR", "STEP", "BEZIER", "HERMITE", "CARDINAL", "BSPLINE"};
  bool isCurved = false;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find_first_of(kXmlSpace), text.size());
    const std::string_view name = text.substr(0, length);
    if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) return false;
    isCurved = isCurved || name != kNames[0];
    text = trimmed(text.substr(length));
  }
  return isCurved;
}

}  // namespace

DaeText prepareDae(ByteSpan bytes) {
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (rest.substr(0, 4).find('\0') != rest.npos) {
    throw Error(ErrorCode::kUnsupported, "is text in UTF-16", {}, "save it as UTF-8");
  }
  DaeText result;
  result.text.reserve(rest.size());
  std::string_view tag;
  while (!rest.empty()) {
    const bool isMarkup = rest.front() == '<';
    const std::size_t length = isMarkup ? markupLength(rest) : std::min(rest.find('<'), rest.size());
    const std::string_view part = rest.substr(0, length);
    const std::string_view kept = isMarkup ? part : trimmed(part);
    if (isMarkup) tag = part;
    if (!isMarkup && tag.starts_with("<Name_array") && areCurvedInterpolations(kept)) ++result.curvedSamplers;
    result.text += kept;
    rest.remove_prefix(length);
  }
  return result;
}

}  // namespace limber
