// cpp-httplib's server within limits that it has none for: how many connections there are, how many bytes a request
// has and how long it may take to come. Plain or through TLS.
//
// It has no use for a request's body and reads none, so a body would be taken for the next request, of whatever headers
// its sender likes. Hence the connection ends with each answer that is no success or redirection, and with each request
// that says that more follows its headers. Ranges are not looked at: the answer is the whole file.
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

// Whether a request says that something follows its headers.
bool hasBody(const httplib::Request& request);

}  // namespace limber::cli
