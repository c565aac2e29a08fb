#include "limber/actions/export/name_style.h"

#include <cctype>

namespace limber {

namespace {

constexpr std::string_view kMixamoPrefix = "mixamorig:", kRigifyPrefix = "DEF-", kActorCorePrefix = "CC_Base_";

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string capitalized(std::string_view word) {
  std::string text(word);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

bool hasSeparators(NameStyle style) {
  return style == NameStyle::kSnake || style == NameStyle::kDotted || style == NameStyle::kRigify;
}

// Before the word that comes next.
std::string_view separatorBefore(const std::string& word, const std::string& stem, NameStyle style) {
  if (stem.empty()) return "";
  const bool isNumber = isDigit(word.front());
  if (hasSeparators(style)) return isNumber && style != NameStyle::kSnake ? "." : "_";
  const bool isEnd = style == NameStyle::kMixamo && word == "end";  // mixamorig:HeadTop_End
  return isEnd || (isNumber && isDigit(stem.back())) ? "_" : "";
}

}  // namespace

std::string spellStem(std::span<const std::string> words, NameStyle style) {
  std::string stem;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    stem += separatorBefore(word, stem, style);
    stem += hasSeparators(style) ? word : capitalized(word);
  }
  return stem;
}

std::string_view sideWord(Side side, NameStyle style) {
  if (side == Side::kCenter) return "";
  const bool isLeft = side == Side::kLeft;
  switch (style) {
    case NameStyle::kSnake:
      return isLeft ? "l" : "r";
    case NameStyle::kDotted:
    case NameStyle::kRigify:
    case NameStyle::kActorCore:
      return isLeft ? "L" : "R";
    case NameStyle::kCamel:
      return isLeft ? "left" : "right";
    case NameStyle::kPascal:
    case NameStyle::kMixamo:
      break;
  }
  return isLeft ? "Left" : "Right";
}

std::string spellName(std::string_view stem, Side side, NameStyle style) {
  const bool isSided = side != Side::kCenter;
  const std::string word(sideWord(side, style));
  std::string name(stem);
  switch (style) {
    case NameStyle::kSnake:
      return isSided ? name + "_" + word : name;
    case NameStyle::kDotted:
      return isSided ? name + "." + word : name;
    case NameStyle::kRigify:
      return std::string(kRigifyPrefix) + spellName(stem, side, NameStyle::kDotted);
    case NameStyle::kPascal:
      return word + name;
    case NameStyle::kMixamo:
      return std::string(kMixamoPrefix) + word + name;
    case NameStyle::kActorCore:
      return std::string(kActorCorePrefix) + (isSided ? word + "_" : "") + name;
    case NameStyle::kCamel:
      break;
  }
  if (isSided) return word + name;
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

}  // namespace limber
