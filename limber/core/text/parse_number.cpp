// An exact power of ten times an integer that a double holds exactly is rounded once (Clinger 1990, "How to read
// floating point numbers accurately", the fast path); nothing that writes 15 digits or fewer needs more.
#include "limber/core/text/parse_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace limber {

namespace {

constexpr int kExactPower = 22;  // 10^22 is the largest power of ten that a double holds exactly
constexpr std::array<double, kExactPower + 1> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                         1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                         1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int kMaxDigits = 19;         // that 64 bits hold
constexpr int kLargestExponent = 400;  // beyond it everything is 0 or infinite, whatever the digits

bool isDigit(const char* at, const char* end) {
  return at != end && *at >= '0' && *at <= '9';
}

struct Decimal {
  std::uint64_t digits = 0;
  int count = 0;              // of significant digits in `digits`
  std::int64_t exponent = 0;  // of ten
  bool any = false;

  void add(char c, bool afterPoint) {
    any = true;
    if (count < kMaxDigits) {
      digits = 10 * digits + static_cast<std::uint64_t>(c - '0');
      if (digits != 0) ++count;
      if (afterPoint) --exponent;
    } else if (!afterPoint) {
      ++exponent;
    }
  }
};

double scaled(std::uint64_t digits, std::int64_t wideExponent) {
  if (digits == 0 || wideExponent < -kLargestExponent) return 0;
  if (wideExponent > kLargestExponent) return std::numeric_limits<double>::infinity();
  auto value = static_cast<double>(digits);
  auto exponent = static_cast<int>(wideExponent);
  // In steps that stay in range as long as the result does.
  while (exponent != 0) {
    const int step = std::min(std::abs(exponent), kExactPower);
    const double power = kPowers[static_cast<std::size_t>(step)];
    value = exponent > 0 ? value * power : value / power;
    exponent += exponent > 0 ? -step : step;
  }
  return value;
}

// The exponent behind an 'e'; `at` stays where none follows.
int parseExponent(const char*& at, const char* end) {
  if (at == end || (*at != 'e' && *at != 'E')) return 0;
  const char* next = at + 1;
  const bool negative = next != end && *next == '-';
  if (next != end && (*next == '-' || *next == '+')) ++next;
  if (!isDigit(next, end)) return 0;
  int exponent = 0;
  for (; isDigit(next, end); ++next) {
    if (exponent < 100000) exponent = 10 * exponent + (*next - '0');
  }
  at = next;
  return negative ? -exponent : exponent;
}

bool isLetter(char c) {
  return (c | 0x20) >= 'a' && (c | 0x20) <= 'z';
}

// "(ind)", "(snan)" behind a "nan", as Windows programs write it.
void skipKindOfNan(const char*& at, const char* end) {
  if (at == end || *at != '(') return;
  const char* next = at + 1;
  while (next != end && isLetter(*next)) ++next;
  if (next != end && *next == ')') at = next + 1;
}

std::optional<double> parseWord(const char*& at, const char* end) {
  struct Word {
    std::string_view text;
    double value;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array<Word, 3> kWords = {
      {{"infinity", kInfinity}, {"inf", kInfinity}, {"nan", std::numeric_limits<double>::quiet_NaN()}}};
  for (const Word& word : kWords) {
    if (static_cast<std::size_t>(end - at) < word.text.size()) continue;
    bool same = true;
    for (std::size_t i = 0; i < word.text.size(); ++i) same = same && (at[i] | 0x20) == word.text[i];
    if (!same) continue;
    at += word.text.size();
    if (std::isnan(word.value)) skipKindOfNan(at, end);
    return word.value;
  }
  return std::nullopt;
}

// "1.#IND", "1.#QNAN00", "1.#INF" of older Windows programs; `at` is behind the point.
std::optional<double> parseWindowsWord(const char*& at, const char* end) {
  if (at == end || *at != '#') return std::nullopt;
  const char* next = at + 1;
  const char* const word = next;
  while (next != end && isLetter(*next)) ++next;
  std::string name(word, next);
  for (char& c : name) c = static_cast<char>(c & ~0x20);
  const bool isInfinite = name == "INF";
  if (!isInfinite && name != "IND" && name != "QNAN" && name != "SNAN") return std::nullopt;
  while (isDigit(next, end)) ++next;
  at = next;
  return isInfinite ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<double> parseNumber(const char*& at, const char* end, bool* commaIsPoint) {
  const char* next = at;
  const bool negative = next != end && *next == '-';
  if (next != end && (*next == '-' || *next == '+')) ++next;
  Decimal number;
  for (; isDigit(next, end); ++next) number.add(*next, false);
  const bool point = next != end && *next == '.';
  const bool comma = !point && commaIsPoint && next != end && *next == ',' && isDigit(next + 1, end);
  if (comma) *commaIsPoint = true;
  if (point || comma) {
    for (++next; isDigit(next, end); ++next) number.add(*next, true);
  }
  double value = 0;
  if (const std::optional<double> none = point ? parseWindowsWord(next, end) : std::nullopt) {
    value = *none;
  } else if (number.any) {
    value = scaled(number.digits, number.exponent + parseExponent(next, end));
  } else {
    const std::optional<double> word = point || comma ? std::nullopt : parseWord(next, end);
    if (!word) return std::nullopt;
    value = *word;
  }
  at = next;
  return negative ? -value : value;
}

}  // namespace limber
