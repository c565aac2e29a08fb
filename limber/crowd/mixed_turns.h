// Who comes next where all have their turns, mixed by chance.
#pragma once

#include <vector>

#include "limber/core/random.h"
#include "limber/core/types.h"

namespace limber {

// Numbers below `count`, 1 or more: each once in an order by chance, then each once in another. What the first n draws
// give does not depend on how many follow; the same on every machine.
class MixedTurns {
 public:
  MixedTurns(Index count, std::uint64_t seed);
  Index next();

 private:
  Random random_;
  std::vector<Index> order_;
  std::size_t drawn_ = 0;  // of this order
};

}  // namespace limber
