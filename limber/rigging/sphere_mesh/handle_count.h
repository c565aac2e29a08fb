// How many handles a model can have.
#pragma once

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

[[noreturn]] inline void refuseHandleCount(Index asked, Index most) {
  throw KnownError(ErrorKind::kHandleCount,
                   {ErrorCode::kBadArgument,
                    fmt::format("{} handles are asked for", asked),
                    {},
                    fmt::format("this model can have 1 to {}", most)},
                   {{"count", fmt::to_string(asked)}, {"most", fmt::to_string(most)}});
}

}  // namespace limber
