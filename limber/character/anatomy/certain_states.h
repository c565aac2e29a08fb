// Which states the field may give each joint, by what is certain of it. Internal to the module.
#pragma once

#include <cstdint>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/character/anatomy/body_reading.h"

namespace limber {

// #half joints, a bit mask of states each. What the user has set and what is declared (BodyReading::declared) is one
// kind of part and one segment. Where declared joints make a leg, an arm or a head, no other joint of the body is of
// one: what is attached beside them is clothing, hair, a tail, or nothing.
std::vector<std::uint32_t> certainStates(const BodyReading& reading, const AnatomyOptions& options);

}  // namespace limber
