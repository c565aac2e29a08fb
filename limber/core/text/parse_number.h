// Numbers out of text, quickly: the same in every locale, natively and as WebAssembly.
#pragma once

#include <optional>
#include <string_view>

namespace limber {

// The decimal number at `at`, which is moved past it; nullopt, and `at` unchanged, where there is none. Reads "12",
// "-.5", "+3.", "1e-3", also "nan", "inf" and "infinity" in any case; no blanks before it, no hexadecimal. The result is
// the nearest double; beyond the range of a double it is infinite or 0.
//
// commaIsPoint  also "1,5" is one number, if a digit follows the comma and no point has come yet; set to true where
//               that was used, else left alone. Null: a comma ends the number.
std::optional<double> parseNumber(const char*& at, const char* end, bool* commaIsPoint = nullptr);

// The number that the whole word is; nullopt where it is none, or not finite.
std::optional<double> finiteNumber(std::string_view word);

}  // namespace limber
