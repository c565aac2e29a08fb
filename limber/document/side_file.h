// Files that a model of another format refers to by a path that need not be true here.
#pragma once

#include <optional>
#include <string_view>

#include "limber/document/read.h"

namespace limber {

// By the path that the model gives: as it is if that is relative, else by its last part beside the model. None where it
// is not there, leads out of the model's folder or cannot be read.
std::optional<Bytes> sideFile(const Resolver& resolver, std::string_view path);

// As it is only.
std::optional<Bytes> sideFileThere(const Resolver& resolver, std::string_view path);

}  // namespace limber
