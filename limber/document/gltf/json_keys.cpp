#include "limber/document/gltf/json_keys.h"

#include <algorithm>

#include <fmt/format.h>

namespace limber {

void allowKeys(const JsonView& object, std::initializer_list<std::string_view> keys) {
  object.forEachMember([&](std::string_view key, const JsonView&) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) return;
    object.fail(fmt::format("has a key that is not known: '{}'; there are: {}", key, fmt::join(keys, ", ")));
  });
}

}  // namespace limber
