#include "network.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "limber/core/error.h"

namespace limber::cli {

namespace {

std::string written(int family, const void* bytes) {
  char text[INET6_ADDRSTRLEN] = {};
  inet_ntop(family, bytes, text, sizeof text);
  return text;
}

std::string written(const sockaddr* address) {
  if (address->sa_family == AF_INET) return written(AF_INET, &reinterpret_cast<const sockaddr_in*>(address)->sin_addr);
  return written(AF_INET6, &reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr);
}

bool isOfOneLink(const sockaddr* address) {
  return address->sa_family == AF_INET6 &&
         IN6_IS_ADDR_LINKLOCAL(&reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr);
}

// From which this machine would send to the world; asking the routes sends nothing (192.0.2.1 is no machine, RFC 5737).
std::optional<std::string> addressOfDefaultRoute() {
  const int asking = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (asking < 0) return std::nullopt;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(9);
  inet_pton(AF_INET, "192.0.2.1", &address.sin_addr);
  socklen_t size = sizeof address;
  const bool known = connect(asking, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(asking, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(asking);
  if (!known) return std::nullopt;
  return written(reinterpret_cast<sockaddr*>(&address));
}

}  // namespace

std::optional<std::string> numericAddress(std::string_view text) {
  const std::string bare(text.starts_with('[') && text.ends_with(']') ? text.substr(1, text.size() - 2) : text);
  for (const int family : {AF_INET, AF_INET6}) {
    in6_addr bytes;
    if (inet_pton(family, bare.c_str(), &bytes) == 1) return written(family, &bytes);
  }
  return std::nullopt;
}

bool isLoopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

std::string inAddressBar(const std::string& address) {
  return address.find(':') == address.npos ? address : '[' + address + ']';
}

std::vector<std::string> networkAddresses() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> all(first, freeifaddrs);
  std::vector<std::string> addresses;
  for (const int family : {AF_INET, AF_INET6}) {
    for (const ifaddrs* one = first; one; one = one->ifa_next) {
      if (!one->ifa_addr || one->ifa_addr->sa_family != family || !(one->ifa_flags & IFF_UP)) continue;
      if (one->ifa_flags & IFF_LOOPBACK || isOfOneLink(one->ifa_addr)) continue;
      addresses.push_back(written(one->ifa_addr));
    }
  }
  return addresses;
}

std::string mainNetworkAddress() {
  const std::vector<std::string> addresses = networkAddresses();
  if (addresses.empty()) {
    throw Error(ErrorCode::kUnsupported, "this machine has no address in a network", {},
                "connect it to the network that the phone is in");
  }
  const std::optional<std::string> main = addressOfDefaultRoute();
  return main && std::find(addresses.begin(), addresses.end(), *main) != addresses.end() ? *main : addresses.front();
}

}  // namespace limber::cli
