// Numbers of things in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limber {

// "1 joint", "3 joints"; `many` where an s behind `one` does not make it: "1 vertex", "3 vertices".
std::string counted(std::size_t count, std::string_view one, std::string_view many = {});

}  // namespace limber
