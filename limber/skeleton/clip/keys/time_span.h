// A stretch of time.
#pragma once

namespace limber {

struct TimeSpan {
  double from = 0, to = 0;  // seconds
};

}  // namespace limber
