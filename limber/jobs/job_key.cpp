#include "limber/jobs/job_key.h"

namespace limber {

JobKey& JobKey::add(std::string_view piece) {
  hash_.add(asBytes(std::to_string(piece.size()) + ":"));
  hash_.add(asBytes(piece));
  return *this;
}

}  // namespace limber
