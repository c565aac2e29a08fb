// The studio's page, out of the program itself.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "live_receiver.h"

namespace limber::cli {

struct StudioFile {
  std::string_view path;  // "/index.html"
  std::string_view bytes;
};

// What vite made of apps/studio; empty where the program was built without LIMBER_STUDIO.
std::span<const StudioFile> studioFiles();

struct ServeOptions {
  int port = 8080;  // 0 takes one that is free
  // Serves other machines on this address through https, numeric; empty takes the one that they reach this machine by.
  // Without it, this machine alone is served, through http on 127.0.0.1.
  std::optional<std::string> host;
  int devices = 1;  // how many the address lets in
  // Gives the page what other programs of this machine send to these ports. Not where other machines are served.
  std::optional<LivePorts> live;
};

// What is said while it runs.
struct ServeEvents {
  // A browser can ask. `address` has the token in it where other machines are served; `fingerprint` is that of the
  // certificate (SHA-256), else empty.
  struct Listening {
    std::string address, fingerprint;
    bool is_certificate_new = false;
    std::optional<LivePorts> live = std::nullopt;
  };
  std::function<void(const Listening&)> listening;
  std::function<void(const std::string& from, int device)> letIn;  // on a thread of its own
  std::function<void(const std::string& what)> refused = nullptr;  // of a live sender; likewise
};

// Serves the files to whoever may have them, and nothing else, until the program is interrupted. Other machines: the
// address that `listening` gets has a token in it, which a browser exchanges for a cookie. Throws Error kFile where the
// port is taken or the certificate cannot be kept, kBadArgument where this machine has no such address or live motion
// is to go to a network, kUnsupported where it has no address at all or the program holds no page.
void serveStudio(const ServeOptions& options, const ServeEvents& events);

}  // namespace limber::cli
