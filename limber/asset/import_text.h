// Strings out of Assimp.
#pragma once

#include <string>
#include <string_view>

struct aiString;

namespace limber {

// The same text with every byte that is not UTF-8 replaced, so that it may stand in JSON.
std::string validUtf8(std::string_view text);
std::string textOf(const aiString& text);

}  // namespace limber
