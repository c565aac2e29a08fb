// What the texts of pose edits have in common: joints by name, numbers, errors that quote the text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

std::string inQuotes(std::string_view text);
// Throws Error kBadArgument at the text.
[[noreturn]] void failText(std::string_view text, std::string message, std::string remedy);

// "1,2,3": exactly `count` numbers, else empty.
std::vector<double> numbersOf(std::string_view text, std::size_t count);

// The joint of that name, or that plays the bone of that VRM 1.0 name ("leftHand") in a skeleton with other names
// (humanoidJoints). Throws Error kBadArgument with `where` otherwise, and lists some names that there are.
Index requireJoint(const Skeleton& skeleton, const std::string& name, const std::string& where);

}  // namespace limber
