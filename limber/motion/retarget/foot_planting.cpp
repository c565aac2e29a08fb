#include "limber/motion/retarget/foot_planting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limber {

namespace {

// All by the judge on half of the shared motions.
// Weights against that of bones: a pelvis that feet carry rises and sinks freely, so that legs keep their bend (0 to
// 0.1); it hardly goes aside, nor does one in flight rise or sink, which nothing would hold back (1 to 100). A foot has
// no position of its own (0 to 0.1): its leg's bones tell where it is to be. A planted one has a weight of its squared
// speed along the ground (hip heights a second; 1e3 to 1e6), and keeps its height (1e3 to 1e6). Bounds are found in 3
// to 20 rounds (set by hand).
constexpr ChangeWeights kWeights = {
    .pelvisLevel = 10, .pelvisUp = 0.02, .feet = 0.02, .bones = 1, .hold = 1e5, .rest = 3e4, .rounds = 8};
// Hip heights; 0.05 to 0.3; over which it is seen how bones follow a foot, without the kink of nearly straight legs.
constexpr double kBoneProbe = 0.2;
constexpr double kAheadSeconds = 0.5;  // seconds; 0.3 to 2, several times kChangeSeconds; that a part sees of the next

ChangeWeights weightsFor(double frameSeconds) {
  ChangeWeights weights = kWeights;
  weights.hold /= frameSeconds * frameSeconds;
  return weights;
}

// Frames [first, end), seen with those from `begin` up to `seen`; the changes of all these.
struct PlantedPart {
  std::size_t begin = 0, first = 0, end = 0, seen = 0;
  Changes changes;
};

class PartPlanter {
 public:
  PartPlanter(const MovedLegs& legs, const FootPlanting& planting) : legs_(legs), planting_(planting) {}

  void run() {
    const std::size_t frames = planting_.end - planting_.begin;
    const auto ahead = static_cast<std::size_t>(std::round(kAheadSeconds / planting_.frameSeconds));
    const std::size_t parts = (frames + kPartFrames - 1) / kPartFrames;
    PlantedPart before;
    for (std::size_t i = 0; i < parts; ++i) {
      PlantedPart part;
      part.first = planting_.begin + i * frames / parts;
      part.begin = i == 0 ? part.first : part.first - kJoinedFrames;
      part.end = planting_.begin + (i + 1) * frames / parts;
      part.seen = std::min(planting_.end, part.end + ahead);
      plant(before, part);
      before = std::move(part);
    }
  }

 private:
  void plant(const PlantedPart& before, PlantedPart& part) {
    MovedLegs moved = legs_;
    const ChangeLayout layout = moved.layoutOf(part.seen - part.begin);
    std::vector<FootFrame> asked;
    for (std::size_t f = part.begin; f < part.seen; ++f) {
      const BodyFrame& frame = f < part.first ? known_[f - part.begin] : planting_.frameAt(f);
      moved.add(frame);
      for (std::size_t leg = 0; leg < layout.legs(); ++leg) asked.push_back(planting_.askedOf(f, leg, frame));
    }
    // Paths of nothing: what counts is what the changes make of them.
    ChangedMotion now;
    now.changes.assign(layout.frames() * layout.perFrame(), 0.0);
    now.paths.assign(1 + 2 * layout.legs(), Path(layout.frames(), Vec3(Vec3::Zero())));
    moved.findSlopes(layout, kBoneProbe, now);
    const auto cut = planting_.cuts.begin() + static_cast<std::ptrdiff_t>(part.begin - planting_.begin);
    LeastChanges least(layout, std::move(asked), {cut, cut + static_cast<std::ptrdiff_t>(layout.frames())},
                       endsOf(before, part, layout), weightsFor(planting_.frameSeconds));
    least.start(now);
    part.changes = least.find(smoothnessWeight(planting_.changeSeconds, planting_.frameSeconds));
    known_.clear();
    for (std::size_t f = part.end - kJoinedFrames; f < part.end && part.end < planting_.end; ++f) {
      known_.push_back(planting_.frameAt(f));
    }
    for (std::size_t f = part.first; f < part.end; ++f) {
      planting_.change(moved, layout, part.changes, f - part.begin, f);
    }
  }

  MotionEnds endsOf(const PlantedPart& before, const PlantedPart& part, const ChangeLayout& layout) const {
    MotionEnds ends = planting_.ends;
    ends.endsJoined = ends.endsJoined && part.seen == planting_.end;
    ends.loops = ends.loops && part.first == planting_.begin && part.end == planting_.end;
    if (part.begin == part.first) return ends;
    ends.startsJoined = true;
    const auto known =
        before.changes.begin() + static_cast<std::ptrdiff_t>((part.begin - before.begin) * layout.perFrame());
    ends.start.assign(known, known + static_cast<std::ptrdiff_t>(kJoinedFrames * layout.perFrame()));
    return ends;
  }

  const MovedLegs& legs_;
  const FootPlanting& planting_;
  std::vector<BodyFrame> known_;  // the last of the part before, as they were
};

}  // namespace

void plantFeet(const MovedLegs& legs, const FootPlanting& planting) {
  PartPlanter(legs, planting).run();
}

}  // namespace limber
