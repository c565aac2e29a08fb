#include "limber/core/text/parse_number.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <fast_float/fast_float.h>

namespace limber {

namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

// What "1.#IND", "1.#QNAN00", "1.#INF" of older Windows programs say; `at` is behind the point.
std::optional<double> parseWindowsWord(const char*& at, const char* end) {
  if (at == end || *at != '#') return std::nullopt;
  const char* const word = at + 1;
  const char* next = std::find_if(word, end, [](char c) { return (c | 0x20) < 'a' || (c | 0x20) > 'z'; });
  const auto is = [&](std::string_view upper) {
    return std::equal(word, next, upper.begin(), upper.end(), [](char a, char b) { return (a & ~0x20) == b; });
  };
  if (!is("INF") && !is("IND") && !is("QNAN") && !is("SNAN")) return std::nullopt;
  at = std::find_if_not(next, end, isDigit);
  return is("INF") ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<double> parseNumber(const char*& at, const char* end, bool* commaIsPoint) {
  const char* begin = at;
  if (begin != end && *begin == '+' && (++begin == end || *begin == '-')) return std::nullopt;
  fast_float::parse_options options;
  if (commaIsPoint) {
    const char* const comma = std::find_if_not(begin != end && *begin == '-' ? begin + 1 : begin, end, isDigit);
    if (end - comma >= 2 && *comma == ',' && isDigit(comma[1])) options.decimal_point = ',';
  }
  double value = 0;
  const auto [behind, problem] = fast_float::from_chars_advanced(begin, end, value, options);
  if (problem == std::errc::invalid_argument) return std::nullopt;
  if (options.decimal_point == ',') *commaIsPoint = true;
  const char* next = behind;
  if (next[-1] == '.') {
    if (const std::optional<double> word = parseWindowsWord(next, end)) value = std::copysign(*word, value);
  }
  at = next;
  return value;
}

std::optional<double> finiteNumber(std::string_view word) {
  const char* at = word.data();
  const char* const end = at + word.size();
  const std::optional<double> value = parseNumber(at, end);
  return value && at == end && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace limber
