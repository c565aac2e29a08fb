// JSON that people write, such as plans: nothing in it is passed over.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "limber/document/gltf/json_access.h"

namespace limber {

// Throws Error kBadData, at the object's path, where it has another key: a misspelt one would silently do nothing.
void allowKeys(const JsonView& object, std::initializer_list<std::string_view> keys);

// The text of a value. Throws Error kBadData, at its path, where it is none or empty.
std::string requiredText(const JsonView& value);

// As parseJson, but what that warns of is an Error.
Json parseStrictly(std::string_view text);

}  // namespace limber
