// Strings out of Assimp.
#pragma once

#include <string>

#include "limber/document/utf8.h"

struct aiString;

namespace limber {

// As UTF-8. A text that is not is taken for Latin-1, as older programs write it.
std::string textOf(const aiString& text);

}  // namespace limber
