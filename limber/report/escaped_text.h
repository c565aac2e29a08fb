// Words out of files, for the forms of a report. What is not UTF-8 is replaced, control characters become spaces.
#pragma once

#include <string>
#include <string_view>

namespace limber {

// For use between tags and within quoted attributes. A line break stays.
std::string htmlText(std::string_view text);

// For use in a line of text or in a cell of a table: what has a meaning in Markdown is escaped.
std::string markdownText(std::string_view text);

}  // namespace limber
