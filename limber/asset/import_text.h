// Strings out of Assimp.
#pragma once

#include <string>

#include "limber/asset/utf8.h"

struct aiString;

namespace limber {

// Valid UTF-8.
std::string textOf(const aiString& text);

}  // namespace limber
