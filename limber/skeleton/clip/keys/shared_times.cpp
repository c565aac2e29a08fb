#include "limber/skeleton/clip/keys/shared_times.h"

#include <bit>
#include <cstdint>

namespace limber {

namespace {

constexpr double kBytesOfList = 110, kBytesOfTime = 4;

struct Group {
  std::vector<std::uint64_t> frames;  // a bit each
  std::vector<std::size_t> tracks;
  double bytesPerKey = 0, bytes = 0;
};

double bytesOf(double keys, double bytesPerKey) {
  return kBytesOfList + keys * (kBytesOfTime + bytesPerKey);
}

double savedByPairing(const Group& a, const Group& b) {
  int keys = 0;
  for (std::size_t w = 0; w < a.frames.size(); ++w) keys += std::popcount(a.frames[w] | b.frames[w]);
  return a.bytes + b.bytes - bytesOf(keys, a.bytesPerKey + b.bytesPerKey);
}

}  // namespace

std::vector<std::vector<Index>> alignKeyFrames(const std::vector<KeyFrames>& tracks, Index frameCount) {
  std::vector<Group> groups;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    Group group;
    group.frames.assign((frameCount + 63) / 64, 0);
    for (const Index frame : tracks[t].frames) group.frames[frame / 64] |= std::uint64_t{1} << (frame % 64);
    group.tracks = {t};
    group.bytesPerKey = static_cast<double>(tracks[t].bytesPerKey);
    group.bytes = bytesOf(static_cast<double>(tracks[t].frames.size()), group.bytesPerKey);
    groups.push_back(std::move(group));
  }
  // saved[a][b], a < b
  std::vector<std::vector<double>> saved(groups.size(), std::vector<double>(groups.size(), 0));
  const auto measure = [&](std::size_t a, std::size_t b) {
    saved[std::min(a, b)][std::max(a, b)] = savedByPairing(groups[a], groups[b]);
  };
  for (std::size_t a = 0; a < groups.size(); ++a) {
    for (std::size_t b = a + 1; b < groups.size(); ++b) measure(a, b);
  }
  while (true) {
    std::size_t bestA = 0, bestB = 0;
    double best = 0;
    for (std::size_t a = 0; a < groups.size(); ++a) {
      if (groups[a].tracks.empty()) continue;
      for (std::size_t b = a + 1; b < groups.size(); ++b) {
        if (groups[b].tracks.empty() || saved[a][b] <= best) continue;
        best = saved[a][b], bestA = a, bestB = b;
      }
    }
    if (!(best > 0)) break;
    Group &into = groups[bestA], &from = groups[bestB];
    int keys = 0;
    for (std::size_t w = 0; w < into.frames.size(); ++w) keys += std::popcount(into.frames[w] |= from.frames[w]);
    into.tracks.insert(into.tracks.end(), from.tracks.begin(), from.tracks.end());
    into.bytesPerKey += from.bytesPerKey;
    into.bytes = bytesOf(keys, into.bytesPerKey);
    from = {};
    for (std::size_t other = 0; other < groups.size(); ++other) {
      if (other != bestA && !groups[other].tracks.empty()) measure(bestA, other);
    }
  }
  std::vector<std::vector<Index>> result(tracks.size());
  for (const Group& group : groups) {
    std::vector<Index> frames;
    for (Index frame = 0; frame < frameCount && !group.tracks.empty(); ++frame) {
      if (group.frames[frame / 64] >> (frame % 64) & 1) frames.push_back(frame);
    }
    for (const std::size_t track : group.tracks) result[track] = frames;
  }
  return result;
}

}  // namespace limber
