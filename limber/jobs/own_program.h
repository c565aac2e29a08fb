// The program that is running.
#pragma once

#include <filesystem>

namespace limber {

// Its file, for starting it again. Throws Error kUnsupported where the system does not tell.
std::filesystem::path ownProgram();

}  // namespace limber
