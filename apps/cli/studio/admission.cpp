#include "admission.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

#include "limber/core/error.h"

namespace limber::cli {

namespace {

std::string lowered(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return lower;
}

// Without the port; empty where it is no name and port.
std::string_view nameOf(std::string_view authority) {
  const std::size_t name_end = authority.starts_with('[') ? authority.find(']') : 0;
  if (name_end == authority.npos) return {};
  const std::size_t colon = authority.find(':', name_end);
  if (colon == authority.npos) return authority;
  const std::string_view port = authority.substr(colon + 1);
  const bool is_port = std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return is_port ? authority.substr(0, colon) : std::string_view();
}

// Takes as long wherever two texts of one length differ, so that its time says nothing about a secret.
bool isSameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

}  // namespace

bool isForSite(const Site& site, std::string_view host, std::string_view origin) {
  const std::string name = lowered(nameOf(host));
  if (std::find(site.names.begin(), site.names.end(), name) == site.names.end()) return false;
  return origin.empty() || lowered(origin) == site.scheme + "://" + lowered(host);
}

std::string makeSecret(std::size_t bytes) {
  static constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::array<std::uint8_t, 256> random;  // all that getentropy gives at once
  if (bytes > random.size() || getentropy(random.data(), bytes) != 0) {
    throw Error(ErrorCode::kUnsupported, "the system gives no random numbers");
  }
  std::string secret;
  unsigned bits = 0;
  int bitCount = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    bits = bits << 8 | random[i];
    for (bitCount += 8; bitCount >= 6; bitCount -= 6) secret += kLetters[bits >> (bitCount - 6) & 63];
  }
  if (bitCount > 0) secret += kLetters[bits << (6 - bitCount) & 63];
  return secret;
}

std::string_view cookieValue(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) return pair.substr(name.size() + 1);
  }
  return {};
}

Admission::Admission(int devices) : devices_(devices) {}

std::optional<Admission::Key> Admission::exchange(std::string_view token) {
  if (!isSameSecret(token, token_)) return std::nullopt;
  const std::lock_guard lock(mutex_);
  if (static_cast<int>(keys_.size()) >= devices_) return std::nullopt;
  keys_.push_back(makeSecret(32));
  return Key{keys_.back(), static_cast<int>(keys_.size())};
}

bool Admission::knows(std::string_view key) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(keys_.begin(), keys_.end(), [&](const std::string& known) { return isSameSecret(key, known); });
}

}  // namespace limber::cli
