#include "limber/jobs/own_program.h"

#include <system_error>

#include "limber/core/error.h"

namespace limber {

std::filesystem::path ownProgram() {
  std::error_code problem;
  std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", problem);
  if (problem) {
    throw Error(ErrorCode::kUnsupported, "this system does not tell a program where its own file is");
  }
  return program;
}

}  // namespace limber
