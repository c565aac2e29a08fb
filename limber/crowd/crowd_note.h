// What a crowd's file says of each of its bodies, in the extras of the node that it hangs on.
#pragma once

#include <string_view>

namespace limber {

// An object: "build" from 1, "clip" its name, "offset" in seconds and "offset_frames" in keys.
inline constexpr std::string_view kCrowdNote = "limber_crowd";

}  // namespace limber
