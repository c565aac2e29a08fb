// Four numbers side by side that compilers turn into one register where the target has such.
#pragma once

namespace limber {

using Float4 = float __attribute__((vector_size(16)));

}  // namespace limber
