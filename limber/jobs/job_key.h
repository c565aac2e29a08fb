// The name of a job's result: equal for equal inputs, arguments and programs, wherever their files lie.
#pragma once

#include <string>
#include <string_view>

#include "limber/jobs/sha256.h"

namespace limber {

// A digest of pieces in order; where one ends and the next begins counts.
class JobKey {
 public:
  JobKey& add(std::string_view piece);
  // The piece's 64 hexadecimal digits; nothing may be added after.
  std::string hex() { return hash_.hex(); }

 private:
  Sha256 hash_;
};

}  // namespace limber
