// Text inside Markdown.
#pragma once

#include <string>
#include <string_view>

namespace limber {

// For use in a line of text or in a cell of a table: what has a meaning in Markdown is escaped, what is not UTF-8 is
// replaced, and control characters become spaces.
std::string markdownText(std::string_view text);

}  // namespace limber
