// Who gets the page where it is served to a network: whoever came by the address with the token in it, once.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limber::cli {

// How this server is addressed.
struct Site {
  std::string scheme;              // "https"
  std::vector<std::string> names;  // in lower case, as in an address: "127.0.0.1", "[fe80::1]", "localhost"
};

// Whether a request's Host is one of the site's names, on whatever port (it may be forwarded), and its Origin, where it
// has one, the site itself. A page of another site whose name was made to point here (DNS rebinding) fails on the
// first, one that sends requests here on the second. Empty: the header is missing.
bool isForSite(const Site& site, std::string_view host, std::string_view origin);

// A random secret of so many bytes in the letters of base64url, which need no escaping in an address or a cookie.
std::string makeSecret(std::size_t bytes);

// The cookie of that name in a Cookie header; empty where there is none.
std::string_view cookieValue(std::string_view header, std::string_view name);

// A token, and the devices that came by it. All calls may come from several threads.
class Admission {
 public:
  explicit Admission(int devices);

  const std::string& token() const { return token_; }
  int devices() const { return devices_; }

  // A key for one more device, the number of devices let in with it; nothing where the token is another one, or has let
  // in as many as it may.
  struct Key {
    std::string value;
    int device;
  };
  std::optional<Key> exchange(std::string_view token);
  bool knows(std::string_view key) const;

 private:
  const std::string token_ = makeSecret(16);
  const int devices_;
  mutable std::mutex mutex_;
  std::vector<std::string> keys_;
};

}  // namespace limber::cli
