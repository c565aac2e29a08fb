#include "source_folder.h"

namespace limber::testing {

std::filesystem::path sourceFolder() {
  return LIMBER_SOURCE_DIR;
}

}  // namespace limber::testing
