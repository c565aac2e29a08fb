// Text out of files that need not be UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace limber {

// The same text with every byte that is not UTF-8 replaced, so that it may stand in JSON.
std::string validUtf8(std::string_view text);

}  // namespace limber
