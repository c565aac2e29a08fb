// The studio's page, out of the program itself.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace limber::cli {

struct StudioFile {
  std::string_view path;  // "/index.html"
  std::string_view bytes;
};

// What vite made of apps/studio; empty where the program was built without LIMBER_STUDIO.
std::span<const StudioFile> studioFiles();

// Serves them on the loopback address alone, until the program is interrupted. Port 0 takes one that is free. Calls
// `listening` with the address once a browser can ask. Throws Error kFile where the port is taken, kUnsupported where
// the program holds no page.
void serveStudio(int port, const std::function<void(const std::string&)>& listening);

}  // namespace limber::cli
