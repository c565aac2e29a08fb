// Words out of files on their way to a terminal.
#pragma once

#include <string>
#include <string_view>

namespace limber {

// The text with every control character as it is written in C ("\x1b", of UTF-8 "\u009b"): a terminal would obey it.
std::string printable(std::string_view line);

// The same of a text of several lines with tabs, which stay.
std::string printableText(std::string_view text);

}  // namespace limber
