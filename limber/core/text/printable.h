// Prepares text from files for printing on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limber {

// The text with every control character as it is written in C ("\x1b", of UTF-8 "\u009b"): a terminal would obey it.
std::string printable(std::string_view line);

// A name or a number out of a file as an error quotes it: printable, and cut to `most` bytes and "..." where it is
// longer, between characters of UTF-8.
std::string shortened(std::string_view word, std::size_t most = 100);

// printable of a text of several lines with tabs, which stay.
std::string printableText(std::string_view text);

}  // namespace limber
