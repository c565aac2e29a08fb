// What a user asked for makes no sense now.
#pragma once

#include <string>
#include <utility>

#include "limber/core/error.h"

namespace limber {

// Throws Error kBadArgument.
[[noreturn]] inline void refuse(std::string message, std::string where = {}, std::string remedy = {}) {
  throw Error(ErrorCode::kBadArgument, std::move(message), std::move(where), std::move(remedy));
}

}  // namespace limber
