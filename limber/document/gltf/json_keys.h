// Which keys a JSON object may have.
#pragma once

#include <initializer_list>
#include <string_view>

#include "limber/document/gltf/json_access.h"

namespace limber {

// Throws Error kBadData, at the object's path, where it has another key: a misspelt one would silently do nothing.
void allowKeys(const JsonView& object, std::initializer_list<std::string_view> keys);

}  // namespace limber
