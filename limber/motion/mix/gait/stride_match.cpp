#include "limber/motion/mix/gait/stride_match.h"

#include <algorithm>
#include <set>

namespace limber {

namespace {

using Falls = std::vector<Footfall>;

// Seconds; 1e-6 to 1e-3; of two feet that come down at once the later one counts as so much later: below what is seen.
constexpr double kSameMoment = 1e-4;

std::vector<double> momentsOf(const Falls& falls) {
  std::vector<double> moments;
  for (const Footfall& fall : falls) {
    moments.push_back(moments.empty() ? fall.seconds : std::max(fall.seconds, moments.back() + kSameMoment));
  }
  return moments;
}

Falls ofFoot(std::span<const Footfall> falls, Index foot) {
  Falls result;
  std::copy_if(falls.begin(), falls.end(), std::back_inserter(result),
               [&](const Footfall& fall) { return fall.foot == foot; });
  return result;
}

// How many meet where a's first meets the one of b with that number, 0 where feet differ.
std::size_t meetingAt(const Falls& a, const Falls& b, std::ptrdiff_t offset) {
  std::size_t meeting = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::ptrdiff_t k = offset + static_cast<std::ptrdiff_t>(i);
    if (k < 0 || k >= static_cast<std::ptrdiff_t>(b.size())) continue;
    if (a[i].foot != b[static_cast<std::size_t>(k)].foot) return 0;
    ++meeting;
  }
  return meeting;
}

std::vector<StridePhases> laidOnto(const Falls& a, const Falls& b) {
  std::vector<StridePhases> found;
  if (a.size() < 2 || b.size() < 2) return found;
  std::set<Index> feet;
  for (const Footfall& fall : a) feet.insert(fall.foot);
  const std::vector<double> ofA = momentsOf(a), ofB = momentsOf(b);
  // Outwards from aligning the first of both, so that the same two motions in the other order are aligned the same.
  const auto furthest = static_cast<std::ptrdiff_t>(std::max(a.size(), b.size()));
  const std::ptrdiff_t side = a.front().foot < b.front().foot ? 1 : -1;
  for (std::ptrdiff_t i = 0; i < 2 * furthest; ++i) {
    const std::ptrdiff_t offset = side * (i % 2 == 0 ? -i / 2 : (i + 1) / 2);
    const std::size_t meeting = meetingAt(a, b, offset);
    if (meeting == 0) continue;
    found.push_back(
        {GaitPhase(ofA, 0), GaitPhase(ofB, -static_cast<double>(offset)), meeting, static_cast<double>(feet.size())});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const StridePhases& one, const StridePhases& other) { return one.matched > other.matched; });
  return found;
}

}  // namespace

std::vector<StridePhases> matchStrides(std::span<const Footfall> a, std::span<const Footfall> b) {
  std::vector<StridePhases> found = laidOnto({a.begin(), a.end()}, {b.begin(), b.end()});
  // One order: but for one of the ends they agree wherever they lie.
  if (!found.empty() && found.front().matched + 1 >= std::min(a.size(), b.size())) return found;
  Falls maxA, maxB;
  std::set<Index> feet;
  for (const Footfall& fall : a) feet.insert(fall.foot);
  for (const Index foot : feet) {
    Falls ofA = ofFoot(a, foot), ofB = ofFoot(b, foot);
    if (std::min(ofA.size(), ofB.size()) <= std::min(maxA.size(), maxB.size())) continue;
    maxA = std::move(ofA);
    maxB = std::move(ofB);
  }
  return laidOnto(maxA, maxB);
}

}  // namespace limber
