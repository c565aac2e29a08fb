// Which files no constant is set by.
#pragma once

#include <filesystem>
#include <string>

namespace limber {

// Who made a file, by its name: what comes before the first '_', or the folder's where that has one ("acme" of
// acme_robots/walker.gltf), without digits at its end.
std::string makerOf(const std::filesystem::path& file);
// Half of the makers, by the lowest bit of their names' FNV-1a hash: no constant is set by what their files show.
bool isHeldOut(const std::filesystem::path& file);

}  // namespace limber
