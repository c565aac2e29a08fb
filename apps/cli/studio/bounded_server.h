// cpp-httplib's server within limits that it has none for: how many connections there are, how many bytes a request
// has and how long it may take to come. Plain or through TLS.
#pragma once

#include <httplib.h>

#include <cstddef>

namespace limber::cli {

class BoundedServer : public httplib::Server {
 public:
  // `tls` outlives the server; null is plain http. Connections beyond `most` wait in the system's short queue.
  // stop() ends every connection within a tenth of a second.
  BoundedServer(SSL_CTX* tls, std::size_t most);

 private:
  bool process_and_close_socket(socket_t socket) override;

  SSL_CTX* tls_;
};

}  // namespace limber::cli
