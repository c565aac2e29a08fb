#include "server.h"

#include <openssl/ssl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "admission.h"
#include "bounded_server.h"
#include "certificate.h"
#include "limber/core/error.h"
#include "network.h"

namespace limber::cli {

namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kMaxConnections = 64;   // a browser opens up to six
constexpr std::string_view kJoin = "/join/";  // the token follows

// What the page needs and no more: it can send nothing away. Only a document that was asked for with the address of a
// model (?model=, app/beginning.ts) may fetch from other sites, since such an address may redirect anywhere.
constexpr std::string_view kContentPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; "
    "img-src 'self' data: blob:; media-src 'self' data: blob:; connect-src 'self'{} data: blob:; "
    "manifest-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

std::string contentPolicy(bool fetches_models) {
  return fmt::format(kContentPolicy, fetches_models ? " http: https:" : "");
}

// For whoever has no key: what to do, in the languages of the page.
constexpr const char* kRefusal =
    "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>limber studio</title></head><body>"
    "<h1>This address is used up</h1>"
    "<p>Each address from <code>limber studio --host</code> opens the studio on one device. End it with Ctrl+C, start "
    "it again and scan the new code. <code>--devices 5</code> lets five devices in.</p>"
    "<div lang=\"de\"><h1>Diese Adresse ist verbraucht</h1>"
    "<p>Jede Adresse von <code>limber studio --host</code> öffnet das Studio auf einem Gerät. Beende es mit Strg+C, "
    "starte es neu und scanne den neuen Code. <code>--devices 5</code> lässt fünf Geräte hinein.</p></div>"
    "</body></html>\n";

const char* typeOf(std::string_view path) {
  const std::string_view extension = path.substr(std::min(path.rfind('.'), path.size()));
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".js") return "text/javascript; charset=utf-8";
  if (extension == ".css") return "text/css; charset=utf-8";
  if (extension == ".wasm") return "application/wasm";
  if (extension == ".png") return "image/png";
  if (extension == ".svg") return "image/svg+xml";
  if (extension == ".webmanifest") return "application/manifest+json";
  return "application/octet-stream";  // the packed engine
}

void answerWithFile(const httplib::Request& request, httplib::Response& response) {
  const std::string_view path = request.path == "/" ? "/index.html" : std::string_view(request.path);
  for (const StudioFile& file : studioFiles()) {
    if (file.path != path) continue;
    const bool fetches = path == "/index.html" && request.has_param("model");
    response.headers.erase("Content-Security-Policy");
    response.set_header("Content-Security-Policy", contentPolicy(fetches));
    response.set_content(file.bytes.data(), file.bytes.size(), typeOf(path));
    return;
  }
  response.status = 404;
}

void setHeaders(httplib::Server& server) {
  // Other pages may not look into this one; its engine may then use threads.
  server.set_default_headers({{"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Cross-Origin-Embedder-Policy", "require-corp"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Content-Security-Policy", contentPolicy(false)},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-cache"},
                              {"X-Content-Type-Options", "nosniff"}});
}

using Handled = httplib::Server::HandlerResponse;

Handled refuse(httplib::Response& response, int status) {
  response.status = status;
  response.set_header("Connection", "close");
  return Handled::Handled;
}

// Everything that has to hold whatever is asked for.
Handled checkRequest(const Site& site, const httplib::Request& request, httplib::Response& response) {
  if (request.method != "GET" && request.method != "HEAD") {
    response.set_header("Allow", "GET, HEAD");
    return refuse(response, 405);
  }
  if (hasBody(request)) return refuse(response, 400);
  // Two of them would be read by one part as this and by another as that.
  if (request.get_header_value_count("Host") != 1 || request.get_header_value_count("Origin") > 1 ||
      !isForSite(site, request.get_header_value("Host"), request.get_header_value("Origin"))) {
    return refuse(response, 403);
  }
  return Handled::Unhandled;
}

// Lets a device in that brings the token, and knows it again by a cookie.
class Door {
 public:
  Door(int devices, int port, std::function<void(const std::string&, int)> let_in)
      : admission_(devices), cookie_(fmt::format("__Host-limber-{}", port)), let_in_(std::move(let_in)) {}

  const std::string& token() const { return admission_.token(); }

  Handled check(const httplib::Request& request, httplib::Response& response) {
    const bool is_known = admission_.knows(cookieValue(request.get_header_value("Cookie"), cookie_));
    const std::string_view path = request.path;
    if (!path.starts_with(kJoin)) return is_known ? Handled::Unhandled : turnAway(response);
    // A look at the address from a messenger's preview does not use it up.
    if (!is_known && (request.method != "GET" || !join(request, response, path.substr(kJoin.size())))) {
      return turnAway(response);
    }
    response.set_redirect("/", 303);
    return Handled::Handled;
  }

 private:
  bool join(const httplib::Request& request, httplib::Response& response, std::string_view token) {
    const auto key = admission_.exchange(token);
    if (!key) return false;
    // Lax, since a link that is tapped in another page would come without a strict one.
    response.set_header("Set-Cookie",
                        fmt::format("{}={}; Path=/; Secure; HttpOnly; SameSite=Lax", cookie_, key->value));
    if (let_in_) let_in_(request.remote_addr, key->device);
    return true;
  }

  static Handled turnAway(httplib::Response& response) {
    response.status = 403;
    response.set_content(kRefusal, "text/html; charset=utf-8");
    return Handled::Handled;
  }

  Admission admission_;
  const std::string cookie_;  // the prefix keeps other servers of this machine from setting it; each port its own
  const std::function<void(const std::string&, int)> let_in_;
};

using TlsContext = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;

TlsContext tlsContext(const Certificate& certificate) {
  TlsContext context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context || SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION) != 1 ||
      SSL_CTX_use_certificate(context.get(), certificate.x509.get()) != 1 ||
      SSL_CTX_use_PrivateKey(context.get(), certificate.key.get()) != 1) {
    throw Error(ErrorCode::kUnsupported, "TLS cannot be set up");
  }
  SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  return context;
}

// The port that it listens on.
int bindTo(httplib::Server& server, const std::string& address, int port) {
  // Two programs on one port, which the library's own options allow, would take turns in answering.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  if (port == 0) {
    port = server.bind_to_any_port(address);
  } else if (!server.bind_to_port(address, port)) {
    port = -1;
  }
  if (port < 0) {
    throw Error(ErrorCode::kFile, "the port cannot be listened on", address,
                "another program has it: choose one by --port");
  }
  return port;
}

// Stops a server at Ctrl+C, also at one that comes before it runs: a thread waits for the signals, which all others
// leave to it.
class StopAtInterrupt {
 public:
  explicit StopAtInterrupt(httplib::Server& server) {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    waiting_ = std::thread([this, &server] {
      int signal = 0;
      sigwait(&signals_, &signal);
      while (!over_ && !server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!over_) server.stop();
    });
  }
  ~StopAtInterrupt() {
    over_ = true;
    pthread_kill(waiting_.native_handle(), SIGTERM);
    waiting_.join();
  }
  StopAtInterrupt(const StopAtInterrupt&) = delete;
  StopAtInterrupt& operator=(const StopAtInterrupt&) = delete;

 private:
  sigset_t signals_;
  std::atomic<bool> over_ = false;
  std::thread waiting_;
};

void runUntilInterrupted(httplib::Server& server, const std::function<void()>& listening) {
  const StopAtInterrupt stop(server);
  listening();
  server.listen_after_bind();
}

// A page that listens gets events until it goes or the server stops.
void answerWithLive(httplib::Server& server, LiveFeed& feed, httplib::Response& response) {
  std::optional<LiveFeed::Listener> free = feed.enter();
  if (!free) {
    response.status = 503;
    return;
  }
  const auto listener = std::make_shared<LiveFeed::Listener>(std::move(*free));
  const auto seen = std::make_shared<LiveFeed::Seen>();
  response.set_chunked_content_provider(
      "text/event-stream", [&server, &feed, listener, seen](std::size_t, httplib::DataSink& sink) {
        constexpr std::chrono::milliseconds kLook(100);
        const std::string events = feed.next(*seen, kLook);
        if (!server.is_running()) return false;
        // A comment, by which the server finds out that the page has gone.
        return events.empty() ? sink.write(":\n\n", 3) : sink.write(events.data(), events.size());
      });
}

void serveThisMachine(const ServeOptions& options, const ServeEvents& events) {
  BoundedServer server(nullptr, kMaxConnections);
  setHeaders(server);
  const Site site{"http", {kLoopback, "localhost"}};
  server.set_pre_routing_handler([&](const httplib::Request& request, httplib::Response& response) {
    return checkRequest(site, request, response);
  });
  LiveFeed feed;
  std::optional<LiveReceiver> receiver;
  if (options.live) {
    receiver.emplace(*options.live, feed, events.refused);
    server.Get("/live",
               [&](const httplib::Request&, httplib::Response& response) { answerWithLive(server, feed, response); });
  }
  server.Get(".*", answerWithFile);
  const int port = bindTo(server, kLoopback, options.port);
  runUntilInterrupted(server, [&] {
    ServeEvents::Listening now{fmt::format("http://{}:{}/{}", kLoopback, port, receiver ? "?live" : ""), "", false};
    if (receiver) now.live = receiver->ports();
    events.listening(now);
  });
}

// That other machines reach this one by: the one that is wished for where this machine has it.
std::string addressToServe(const std::string& wished) {
  if (wished.empty()) return mainNetworkAddress();
  const std::optional<std::string> address = numericAddress(wished);
  std::vector<std::string> own = networkAddresses();
  if (address && (isLoopback(*address) || std::find(own.begin(), own.end(), *address) != own.end())) return *address;
  throw Error(ErrorCode::kBadArgument, "is no address of this machine", wished,
              own.empty() ? "it has none in a network" : fmt::format("it has: {}", fmt::join(own, ", ")));
}

void serveNetwork(const ServeOptions& options, const ServeEvents& events) {
  const std::string address = addressToServe(*options.host), name = inAddressBar(address);
  const Certificate certificate = certificateAt(certificatePath(), address, networkAddresses());
  const TlsContext tls = tlsContext(certificate);
  BoundedServer server(tls.get(), kMaxConnections);
  setHeaders(server);
  const int port = bindTo(server, address, options.port);
  const Site site{"https", {name}};
  Door door(options.devices, port, events.letIn);
  server.set_pre_routing_handler([&](const httplib::Request& request, httplib::Response& response) {
    const Handled refused = checkRequest(site, request, response);
    return refused == Handled::Handled ? refused : door.check(request, response);
  });
  server.Get(".*", answerWithFile);
  runUntilInterrupted(server, [&] {
    events.listening({fmt::format("https://{}:{}{}{}", name, port, kJoin, door.token()), certificate.fingerprint,
                      certificate.is_new});
  });
}

}  // namespace

void serveStudio(const ServeOptions& options, const ServeEvents& events) {
  if (options.host && options.live) {
    throw Error(ErrorCode::kBadArgument, "live motion is for this machine alone", "", "leave out --host or --live");
  }
  if (options.host) return serveNetwork(options, events);
  serveThisMachine(options, events);
}

}  // namespace limber::cli
