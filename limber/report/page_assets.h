// How pages look, and what their tables and filters do.
#pragma once

#include <string_view>

namespace limber {

extern const std::string_view kPageStyle, kPageScript;

}  // namespace limber
