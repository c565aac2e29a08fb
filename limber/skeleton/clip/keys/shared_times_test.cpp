#include "limber/skeleton/clip/keys/shared_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "random_values.h"

namespace limber {
namespace {

// As it is in a file: each list of times once, the values of each track.
double bytesOf(const std::vector<KeyFrames>& tracks, const std::vector<std::vector<Index>>& frames) {
  double bytes = 0;
  for (const std::vector<Index>& list : std::set<std::vector<Index>>(frames.begin(), frames.end())) {
    bytes += 110 + 4.0 * static_cast<double>(list.size());
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    bytes += static_cast<double>(tracks[t].bytesPerKey * frames[t].size());
  }
  return bytes;
}

TEST(AlignKeyFrames, TakesFewerBytesAndLosesNoKey) {
  testing::RandomValues random(7);
  std::vector<KeyFrames> tracks;
  std::vector<std::vector<Index>> own;
  for (int t = 0; t < 20; ++t) {
    std::set<Index> frames = {0, 199};
    const Index count = random.below(t % 3 == 0 ? 5 : 80);
    for (Index k = 0; k < count; ++k) frames.insert(random.below(200));
    tracks.push_back({{frames.begin(), frames.end()}, t % 2 == 0 ? 8u : 12u});
    own.push_back(tracks.back().frames);
  }
  const std::vector<std::vector<Index>> shared = alignKeyFrames(tracks, 200);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    EXPECT_TRUE(std::includes(shared[t].begin(), shared[t].end(), own[t].begin(), own[t].end()));
  }
  EXPECT_LT(bytesOf(tracks, shared), bytesOf(tracks, own));
}

TEST(AlignKeyFrames, OnlyWhatSaves) {
  const std::vector<Index> few = {0, 63, 64, 999};
  std::vector<Index> many;
  for (Index f = 0; f < 1000; f += 2) many.push_back(f);
  many.push_back(999);
  const auto shared = alignKeyFrames({{few, 12}, {many, 12}, {few, 8}}, 1000);
  EXPECT_EQ(shared[0], few);
  EXPECT_EQ(shared[1], many);
  EXPECT_EQ(shared[2], few);
  EXPECT_TRUE(alignKeyFrames({}, 10).empty());
}

}  // namespace
}  // namespace limber
