// The style and the script of a study's page.
#pragma once

#include <string_view>

namespace limber {

extern const std::string_view kReportStyle, kReportScript;

}  // namespace limber
