// A crowd of the small dragon.
#pragma once

#include <vector>

#include "limber/crowd/crowd.h"
#include "limber/crowd/testing/dragon.h"
#include "limber/samples/motions/sample_motions.h"

namespace limber {

inline Crowd dragonCrowd(const CrowdOptions& options, const std::vector<Motion>& motions = {makeSampleMotion("flap")}) {
  std::vector<Asset> characters;
  characters.push_back(dragon());
  Progress progress;
  return makeCrowd(characters, motions, options, progress);
}

}  // namespace limber
