// One line of a BVH file, word by word.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "limber/core/error.h"
#include "limber/core/text/parse_number.h"

namespace limber {

class BvhLine {
 public:
  BvhLine(std::string_view text, std::size_t number) : at_(text.data()), end_(at_ + text.size()), number_(number) {}

  // Blanks and lone commas stand between words.
  bool atEnd() {
    while (at_ != end_ && isBlank(*at_)) ++at_;
    return at_ == end_;
  }

  // The next word; a brace or a colon is one of its own. Empty at the end.
  std::string_view word() {
    if (atEnd()) return {};
    const char* begin = at_;
    do ++at_;
    while (!isMark(*begin) && at_ != end_ && !isBlank(*at_) && !isMark(*at_));
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  // What is left up to an opening brace, without blanks round it.
  std::string_view rest() {
    atEnd();
    const char* begin = at_;
    at_ = std::find(at_, end_, '{');
    const char* last = at_;
    while (last != begin && isBlank(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
  }

  // The next number, which may be infinite or none at all (NaN). Throws where there is something else, or nothing.
  double number() {
    if (atEnd()) throw error("ends where a number is wanted");
    const char* begin = at_;
    const std::optional<double> value = parseNumber(at_, end_, &decimalComma_);
    if (value && (at_ == end_ || isBlank(*at_) || isMark(*at_))) return *value;
    at_ = begin;
    throw error("\"" + shown(word()) + "\" is no number");
  }

  double finiteNumber() {
    const double value = number();
    constexpr double kLargest = 1e30;  // leaves single precision room for products
    if (!(std::abs(value) <= kLargest)) throw error("a number is not finite");
    return value;
  }

  // Was a number written with a comma as its decimal point?
  bool decimalComma() const { return decimalComma_; }

  Error error(const std::string& what, const std::string& remedy = {}) const {
    return Error(ErrorCode::kBadData, what, "line " + std::to_string(number_), remedy);
  }

  std::size_t lineNumber() const { return number_; }

  // A word as it may stand in a message: short, printable.
  static std::string shown(std::string_view word) {
    constexpr std::size_t kMax = 40;
    std::string text(word.substr(0, kMax));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
    return word.size() > kMax ? text + "..." : text;
  }

 private:
  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\v' || c == '\f'; }
  static bool isMark(char c) { return c == '{' || c == '}' || c == ':'; }

  const char *at_, *end_;
  std::size_t number_;
  bool decimalComma_ = false;
};

// Equal but for the case of ASCII letters; `lower` is in lower case.
inline bool isWord(std::string_view word, std::string_view lower) {
  return word.size() == lower.size() && std::equal(word.begin(), word.end(), lower.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

}  // namespace limber
