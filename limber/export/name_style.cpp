#include "limber/export/name_style.h"

#include <cctype>

namespace limber {

namespace {

constexpr std::string_view kMixamoPrefix = "mixamorig:";

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::string capitalized(std::string_view word) {
  std::string text(word);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

bool hasSeparators(NameStyle style) {
  return style == NameStyle::kSnake || style == NameStyle::kDotted;
}

}  // namespace

std::string spellStem(std::span<const std::string> words, NameStyle style) {
  std::string stem;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    const bool number = isDigit(word.front());
    if (hasSeparators(style)) {
      if (!stem.empty()) stem += number && style == NameStyle::kDotted ? '.' : '_';
      stem += word;
    } else {
      if (number && !stem.empty() && isDigit(stem.back())) stem += '_';
      stem += capitalized(word);
    }
  }
  return stem;
}

std::string spellName(std::string_view stem, Side side, NameStyle style) {
  const bool isSided = side != Side::kCenter, isLeft = side == Side::kLeft;
  std::string name(stem);
  switch (style) {
    case NameStyle::kSnake:
      return isSided ? name + (isLeft ? "_l" : "_r") : name;
    case NameStyle::kDotted:
      return isSided ? name + (isLeft ? ".L" : ".R") : name;
    case NameStyle::kPascal:
      return isSided ? (isLeft ? "Left" : "Right") + name : name;
    case NameStyle::kMixamo:
      return std::string(kMixamoPrefix) + spellName(stem, side, NameStyle::kPascal);
    case NameStyle::kCamel:
      break;
  }
  if (isSided) return (isLeft ? "left" : "right") + name;
  if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
  return name;
}

}  // namespace limber
