// What a program said last.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limber {

// The last line with anything but blanks, without blanks around it, control characters made blanks, cut to `most`
// bytes; empty where there is none. Not necessarily UTF-8.
std::string lastLine(std::string_view text, std::size_t most);

}  // namespace limber
