#include "limber/core/text/parse_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

namespace limber {
namespace {

// The value and how many characters it took; NaN and 0 where there is no number.
std::pair<double, std::size_t> parse(const std::string& text, bool* comma = nullptr) {
  const char* at = text.data();
  const std::optional<double> value = parseNumber(at, text.data() + text.size(), comma);
  return {value.value_or(std::nan("")), static_cast<std::size_t>(at - text.data())};
}

TEST(ParseNumber, AgreesWithStrtodToTheBitForNumbersAsFilesHoldThem) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> mantissa(0.1, 1);
  std::uniform_int_distribution<int> exponent(-6, 7), digits(0, 14);
  const char* kFormats[] = {"%.*f", "%.*e", "%.*g"};
  for (int i = 0; i < 100000; ++i) {
    char text[64];
    const int digitCount = i % 3 == 0 ? digits(random) / 2 : digits(random);  // at most 15 significant ones
    std::snprintf(text, sizeof text, kFormats[i % 3], digitCount,
                  (i % 2 ? 1 : -1) * mantissa(random) * std::pow(10.0, exponent(random)));
    const auto [value, length] = parse(text);
    EXPECT_EQ(value, std::strtod(text, nullptr)) << text;
    EXPECT_EQ(length, std::string(text).size()) << text;
  }
}

TEST(ParseNumber, IsTheNearestDouble) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 100000; ++i) {
    double expected = 0;
    const std::uint64_t bits = random();
    std::memcpy(&expected, &bits, sizeof expected);
    if (!std::isfinite(expected)) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", expected);
    EXPECT_EQ(parse(text).first, expected) << text;
  }
}

TEST(ParseNumber, StopsBehindTheNumber) {
  EXPECT_EQ(parse("12 13"), std::make_pair(12.0, std::size_t{2}));
  EXPECT_EQ(parse("-.5e1x"), std::make_pair(-5.0, std::size_t{5}));
  EXPECT_EQ(parse("+3.\t"), std::make_pair(3.0, std::size_t{3}));
  EXPECT_EQ(parse("1e"), std::make_pair(1.0, std::size_t{1}));
  EXPECT_EQ(parse("1e+-2"), std::make_pair(1.0, std::size_t{1}));
  EXPECT_EQ(parse("1.2.3"), std::make_pair(1.2, std::size_t{3}));
  EXPECT_EQ(parse("1,5"), std::make_pair(1.0, std::size_t{1}));
}

TEST(ParseNumber, ReadsWhatWindowsProgramsWriteForNoNumber) {
  for (const char* text : {"nan", "-nan(ind)", "nan(snan)", "-1.#IND", "1.#QNAN0", "1.#IND00", "1.#SNAN"}) {
    const auto [value, length] = parse(text);
    EXPECT_TRUE(std::isnan(value)) << text;
    EXPECT_EQ(length, std::string(text).size()) << text;
  }
  EXPECT_EQ(parse("1.#INF00"), std::make_pair(double{INFINITY}, std::size_t{8}));
  EXPECT_EQ(parse("-1.#INF"), std::make_pair(-double{INFINITY}, std::size_t{7}));
  EXPECT_EQ(parse("1.#OTHER"), std::make_pair(1.0, std::size_t{2}));
  EXPECT_EQ(parse("nan(1").second, 3u);
}

TEST(ParseNumber, RefusesWhatIsNone) {
  for (const char* text : {"", "-", "+", ".", "-.", "e5", "abc", "--1", "\xff", "in", "na"}) {
    EXPECT_EQ(parse(text).second, 0u) << text;
  }
}

TEST(FiniteNumber, IsAllOfTheWord) {
  EXPECT_EQ(finiteNumber("-1.5e2"), -150.0);
  for (const char* text : {"", "1 ", " 1", "1,5", "1x", "inf", "nan", "1e999"})
    EXPECT_FALSE(finiteNumber(text)) << text;
}

TEST(ParseNumber, TakesACommaForAPointOnRequest) {
  bool comma = false;
  EXPECT_EQ(parse("1.5,5", &comma), std::make_pair(1.5, std::size_t{3}));
  EXPECT_EQ(parse("1, 5", &comma), std::make_pair(1.0, std::size_t{1}));
  EXPECT_FALSE(comma);
  EXPECT_EQ(parse("-1,25e2", &comma), std::make_pair(-125.0, std::size_t{7}));
  EXPECT_TRUE(comma);
}

TEST(ParseNumber, HoldsOutAtTheEndsOfTheRange) {
  EXPECT_EQ(parse("1e999999999999").first, INFINITY);
  EXPECT_EQ(parse("-1e999999999999").first, -INFINITY);
  EXPECT_EQ(parse("1e-999999999999").first, 0);
  EXPECT_EQ(parse("0e999999999999").first, 0);
  EXPECT_EQ(parse("0." + std::string(300, '0') + "1e301").first, 1);
  EXPECT_EQ(parse("1" + std::string(300, '0') + "e-300").first, 1);
  EXPECT_EQ(parse(std::string(100000, '9')).first, INFINITY);
  EXPECT_EQ(parse("123456789012345678901234567890").first, 123456789012345678901234567890.0);
  EXPECT_TRUE(std::isnan(parse("-NaN").first));
  EXPECT_EQ(parse("-Infinity").first, -INFINITY);
}

}  // namespace
}  // namespace limber
