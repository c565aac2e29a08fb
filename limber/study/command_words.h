// What a command of limber's said of itself when it failed.
#pragma once

#include <string>
#include <string_view>

namespace limber {

inline constexpr std::string_view kSpeaker = "limber: ";  // before all that a command says

// The last line of what it wrote (lastLine), at most 1000 bytes of it, without who says it, as UTF-8.
std::string commandWords(std::string_view text);

// The text with every `name` in it replaced.
std::string replaced(std::string text, std::string_view name, std::string_view by);

}  // namespace limber
