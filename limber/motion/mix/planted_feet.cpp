#include "limber/motion/mix/planted_feet.h"

#include <vector>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/motion/limbs/limb_goals.h"

namespace limber {

namespace {

// Seconds; 0.03 to 0.08; contacts of a sprinter's foot take 0.08 s and more, and its flight longer (Novacheck 1998).
constexpr double kShortestPhase = 0.06;

using Spans = std::vector<TimeSpan>;

// Gaps that are too short close, then spans that are too short go.
Spans steadySpans(const Spans& spans) {
  Spans steady;
  for (const TimeSpan& span : spans) {
    if (!steady.empty() && span.from - steady.back().to < kShortestPhase) {
      steady.back().to = span.to;
    } else {
      steady.push_back(span);
    }
  }
  std::erase_if(steady, [](const TimeSpan& span) { return span.to - span.from < kShortestPhase; });
  return steady;
}

}  // namespace

std::vector<FootSpans> plantedFeet(const RetargetSetup& setup, const PoseSequence& source) {
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  const std::vector<WatchedFoot> watched = goals.watchedFeet();
  const ContactTrack track(setup, watched, source);
  std::vector<FootSpans> feet;
  for (std::size_t i = 0; i < watched.size(); ++i) feet.push_back({goals.legs()[i].spec.end, track.spans(i)});
  return feet;
}

std::vector<FootSpans> plantedFeet(const Skeleton& source, const Clip& clip, const Skeleton& target,
                                   const SkeletonMap& map, const RetargetOptions& options, double frameRate) {
  const PlainSkeleton from(source), to(target);
  const PoseSequence frames = from.plain(sampleFrames(source, clip, frameRate));
  return plantedFeet(RetargetSetup(from.skeleton(), to.skeleton(), map, options, &frames), frames);
}

std::vector<FootSpans> steadied(std::vector<FootSpans> feet) {
  for (FootSpans& foot : feet) foot.planted = steadySpans(foot.planted);
  return feet;
}

}  // namespace limber
