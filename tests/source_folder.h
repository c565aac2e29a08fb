// Where the checkout that the tests were built from lies.
#pragma once

#include <filesystem>

namespace limber::testing {

std::filesystem::path sourceFolder();

}  // namespace limber::testing
