// Keys taken to other moments, for everything that has keys.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

// Key has `seconds`, and `retimed` where time stretched by a scale changes more of it; `chosen` says whether the key at
// a time is meant. Returns whether one was. A key that arrives replaces one that is there.
template <class Key, class Chosen>
bool retime(std::vector<Key>& keys, const Chosen& chosen, const KeyRetiming& retiming) {
  std::vector<Key> stay, arrive;
  for (const Key& key : keys) {
    const bool meant = chosen(key.seconds);
    if (!meant || retiming.copy) stay.push_back(key);
    if (!meant) continue;
    arrive.push_back(key);
    arrive.back().seconds = retiming.at(key.seconds);
    if constexpr (requires { arrive.back().retimed(retiming.scale); }) arrive.back().retimed(retiming.scale);
  }
  if (arrive.empty()) return false;
  for (const Key& key : arrive) {
    std::erase_if(stay, [&](const Key& other) { return std::abs(other.seconds - key.seconds) < kKeySnap; });
    stay.push_back(key);
  }
  std::sort(stay.begin(), stay.end(), [](const Key& a, const Key& b) { return a.seconds < b.seconds; });
  keys = std::move(stay);
  return true;
}

}  // namespace limber
