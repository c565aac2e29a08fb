// Pairing one to one at the least cost.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// For each row of `costs` (all rows equally long, finite) its column, so that the sum of the costs is the least; none
// for rows that are left over where there are more rows than columns. The Hungarian method (Kuhn 1955, Munkres 1957):
// O(rows^2 columns).
std::vector<std::optional<Index>> cheapestPairs(const std::vector<std::vector<double>>& costs);

}  // namespace limber
