#include "studio_server.h"

#include <algorithm>
#include <csignal>

#include <fmt/format.h>
#include <httplib.h>

#include "limber/core/error.h"

namespace limber::cli {

namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr std::size_t kServers = 4;  // requests at once

const char* typeOf(std::string_view path) {
  const std::string_view extension = path.substr(std::min(path.rfind('.'), path.size()));
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".wasm") return "application/wasm";
  return "application/octet-stream";  // the packed engine
}

void answer(const httplib::Request& request, httplib::Response& response) {
  const std::string_view path = request.path == "/" ? "/index.html" : std::string_view(request.path);
  for (const StudioFile& file : studioFiles()) {
    if (file.path != path) continue;
    response.set_content(file.bytes.data(), file.bytes.size(), typeOf(path));
    return;
  }
  response.status = 404;
}

httplib::Server* running = nullptr;

}  // namespace

void serveStudio(int port, const std::function<void(const std::string&)>& listening) {
  httplib::Server server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kServers); };
  // Other pages may not look into this one; its engine may then use threads.
  server.set_default_headers({{"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Cross-Origin-Embedder-Policy", "require-corp"},
                              {"Cache-Control", "no-cache"},
                              {"X-Content-Type-Options", "nosniff"}});
  // Two programs on one port, which the library's own options allow, would take turns in answering.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.Get(".*", answer);
  if (port == 0) {
    port = server.bind_to_any_port(kHost);
  } else if (!server.bind_to_port(kHost, port)) {
    port = -1;
  }
  if (port < 0) {
    throw Error(ErrorCode::kFile, "the port cannot be listened on", kHost,
                "another program has it: choose one by --port");
  }
  running = &server;
  const auto stop = [](int) {
    if (running) running->stop();
  };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  listening(fmt::format("http://{}:{}/", kHost, port));
  server.listen_after_bind();
  running = nullptr;
}

}  // namespace limber::cli
