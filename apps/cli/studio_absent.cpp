// Stands in for studio_server.cpp where the program is built without the page.
#include "limber/core/error.h"
#include "studio_server.h"

namespace limber::cli {

std::span<const StudioFile> studioFiles() {
  return {};
}

void serveStudio(int, const std::function<void(const std::string&)>&) {
  throw Error(ErrorCode::kUnsupported, "this limber was built without the studio", {},
              "./dev studio serves it from the source folder; ./dev studio --program puts it into the program");
}

}  // namespace limber::cli
