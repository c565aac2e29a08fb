// Text inside HTML.
#pragma once

#include <string>
#include <string_view>

namespace limber {

// For use between tags and in quoted attributes: what has a meaning in HTML is escaped, what is not UTF-8 is replaced,
// and control characters become spaces.
std::string htmlText(std::string_view text);

}  // namespace limber
