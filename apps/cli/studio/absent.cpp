// Replaces the server where the program is built without the page.
#include "limber/core/error.h"
#include "qr_code.h"
#include "server.h"

namespace limber::cli {

std::span<const StudioFile> studioFiles() {
  return {};
}

void serveStudio(const ServeOptions&, const ServeEvents&) {
  throw Error(ErrorCode::kUnsupported, "this limber was built without the studio", {},
              "./dev studio serves it from the source folder; ./dev studio --program puts it into the program");
}

Squares qrCode(const std::string&) {
  return {};
}

}  // namespace limber::cli
