// What a user asked for makes no sense now.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "limber/core/known_error.h"

namespace limber {

// Throws Error kBadArgument.
[[noreturn]] inline void refuse(std::string message, std::string where = {}, std::string remedy = {}) {
  throw Error(ErrorCode::kBadArgument, std::move(message), std::move(where), std::move(remedy));
}

// The same, of a kind that programs have words for.
[[noreturn]] inline void refuse(ErrorKind kind, std::string message, std::vector<ErrorValue> values = {},
                                std::string where = {}, std::string remedy = {}) {
  throw KnownError(kind, {ErrorCode::kBadArgument, std::move(message), std::move(where), std::move(remedy)},
                   std::move(values));
}

[[noreturn]] inline void refuseDragged() {
  refuse(ErrorKind::kJointDragged, "a joint is being dragged", {}, {}, "end_drag or cancel_drag comes first");
}

// A name that is missing, or that another of those has: "joint", "clip".
[[noreturn]] inline void refuseNoName(const char* what) {
  refuse(ErrorKind::kNameMissing, std::string("a ") + what + " needs a name");
}
[[noreturn]] inline void refuseNameTaken(const char* what, const std::string& name) {
  refuse(ErrorKind::kNameTaken, std::string("there is a ") + what + " called '" + name + "' already", {{"name", name}});
}

}  // namespace limber
