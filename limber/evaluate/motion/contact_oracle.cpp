#include "limber/evaluate/motion/contact_oracle.h"

#include <algorithm>
#include <cmath>

#include "limber/core/types.h"

namespace limber {

namespace {

double spreadOf(const Box& box) {
  return (box.max - box.min).sum();
}

bool anyNear(const std::vector<bool>& frames, std::size_t frame, std::size_t slack) {
  const std::size_t first = frame > slack ? frame - slack : 0, last = std::min(frame + slack, frames.size() - 1);
  for (std::size_t f = first; f <= last; ++f) {
    if (frames[f]) return true;
  }
  return false;
}

}  // namespace

std::vector<bool> restingFrames(std::span<const Vec3> path, std::span<const double> above,
                                const std::vector<bool>& cuts, double frameSeconds, const RestOptions& options) {
  const std::size_t count = path.size();
  const auto least = static_cast<std::size_t>(std::max(2.0, std::ceil(options.seconds / frameSeconds)));
  std::vector<bool> rests(count, false);
  for (std::size_t begin = 0; begin + least <= count;) {
    Box box;
    std::size_t end = begin;
    for (; end < count; ++end) {
      if (end > begin && cuts[end]) break;
      if (!above.empty() && above[end] > options.height) break;
      Box more = box;
      more.add(path[end]);
      if (spreadOf(more) > options.spread) break;
      box = more;
    }
    if (end - begin >= least) {
      std::fill(rests.begin() + static_cast<std::ptrdiff_t>(begin), rests.begin() + static_cast<std::ptrdiff_t>(end),
                true);
      begin = end;
    } else {
      ++begin;
    }
  }
  return rests;
}

void ContactAgreement::count(const std::vector<bool>& meantFrames, const std::vector<bool>& foundFrames,
                             std::size_t slack) {
  for (std::size_t f = 0; f < meantFrames.size(); ++f) {
    if (foundFrames[f]) {
      ++found;
      foundRight += anyNear(meantFrames, f, slack);
    }
    if (meantFrames[f]) {
      ++meant;
      meantFound += anyNear(foundFrames, f, slack);
    }
  }
}

}  // namespace limber
