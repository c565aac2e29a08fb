// The addresses of this machine.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limber::cli {

// "192.168.1.20" or "fd00::5", in the system's canonical form; nothing where it is no numeric address.
std::optional<std::string> numericAddress(std::string_view text);

bool isLoopback(const std::string& address);

// As written in a URL: "192.168.1.20", "[fd00::5]".
std::string inAddressBar(const std::string& address);

// Those of interfaces that are up, IPv4 first, without loopback and IPv6 addresses of one link alone, which a browser
// cannot open.
std::vector<std::string> networkAddresses();

// The one that other machines are reached from. Throws Error kUnsupported where there is no network.
std::string mainNetworkAddress();

}  // namespace limber::cli
