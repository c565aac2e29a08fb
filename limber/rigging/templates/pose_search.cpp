#include "limber/rigging/templates/pose_search.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/rigging/templates/bent_template.h"

namespace limber {

namespace {

constexpr double kDoubtful = 1;         // cost of a fit from which it is bent
constexpr double kWorthBending = 0.65;  // of the cost of the unbent template
constexpr double kMaxCost = 1.9;        // of a pose that nobody pinned
constexpr double kHopeless = 1.5;       // times that cost: no limb that reaches for another end makes up for it
constexpr int kMaxBends = 6;
constexpr int kMaxReaches = 4;
constexpr double kSizeSteps[] = {0.8, 1, 1.25};
constexpr double kLeftOut = 0.5;  // of being far from all bones: such ends are reached for
constexpr std::size_t kMaxEnds = 3;

TemplateFit nearestOf(const std::vector<TemplateVariant>& variants, TemplateEmbedder& embedder) {
  std::vector<TemplateFit> fits = fitVariants(variants, embedder);
  return std::move(*std::min_element(fits.begin(), fits.end(), cheaper));
}

// Pinned joints to their pins, placed ones to where they were found.
std::vector<BendTarget> foundTargets(const TemplateFit& fit) {
  std::vector<BendTarget> targets;
  for (Index j = 0; j < fit.skeleton.jointCount(); ++j) {
    if (fit.pins[j]) {
      targets.push_back({j, *fit.pins[j], true});
    } else if (fit.skeleton.joints[j].role == TemplateRole::kPlaced) {
      targets.push_back({j, fit.embedding.positions[j], false});
    }
  }
  return targets;
}

template <class Make>
std::vector<TemplateVariant> madeInParallel(std::size_t count, const Make& make) {
  std::vector<TemplateVariant> variants(count);
  parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) variants[i] = make(i);
  });
  return variants;
}

void bendNearer(TemplateEmbedder& embedder, TemplateFit& fit) {
  for (int bend = 0; bend < kMaxBends; ++bend) {
    const std::vector<TemplateVariant> variants = madeInParallel(std::size(kSizeSteps), [&](std::size_t i) {
      return bentTemplate(fit.skeleton, foundTargets(fit), kSizeSteps[i] * sizeOf(fit.skeleton));
    });
    TemplateFit nearest = nearestOf(variants, embedder);
    if (!cheaper(nearest, fit)) return;
    fit = std::move(nearest);
  }
}

// Ends of the body, in body space, that no bone comes near; the longest first.
std::vector<Vec3> endsLeftOut(const BodyVolume& body, const TemplateFit& fit) {
  std::vector<Vec3> ends;
  for (const BodyTip& tip : body.tips) {
    const Vec3 position = fit.frame.toBody(tip.position);
    if (ends.size() < kMaxEnds && farFromBones(fit.skeleton, fit.embedding.positions, position, 0) > kLeftOut) {
      ends.push_back(position);
    }
  }
  return ends;
}

// The joints that a tip hangs on, up to where the body parts. Fingers are no parts: nobody searches for them.
std::vector<Index> limbAbove(const TemplateSkeleton& skeleton, Index tip) {
  std::vector<Index> parts(skeleton.jointCount(), 0);
  for (Index j = skeleton.jointCount(); j-- > 0;) {
    const bool searched = skeleton.joints[j].role != TemplateRole::kBetween || parts[j] > 0;
    if (searched && skeleton.joints[j].parent) ++parts[*skeleton.joints[j].parent];
  }
  std::vector<Index> limb;
  for (std::optional<Index> j = skeleton.joints[tip].parent; j && parts[*j] == 1; j = skeleton.joints[*j].parent) {
    limb.push_back(*j);
  }
  return limb;
}

// The template with a tip at `end`, its limb as it comes and the rest as it was found.
TemplateVariant reaching(const TemplateFit& fit, Index tip, const Vec3& end) {
  std::vector<BendTarget> targets = foundTargets(fit);
  const std::vector<Index> limb = limbAbove(fit.skeleton, tip);
  const auto isIn = [&](Index joint) { return std::find(limb.begin(), limb.end(), joint) != limb.end(); };
  const std::optional<Index> mirror = fit.skeleton.joints[tip].mirror;
  const bool both = mirror && fit.frame.symmetric();
  std::erase_if(targets, [&](const BendTarget& target) {
    const Index other = fit.skeleton.joints[target.joint].mirror.value_or(target.joint);
    return !target.firm && (isIn(target.joint) || (both && isIn(other)));
  });
  targets.push_back({tip, end, true});
  if (both) targets.push_back({*mirror, end.cwiseProduct(Vec3(-1, 1, 1)), true});
  return bentTemplate(fit.skeleton, targets, sizeOf(fit.skeleton));
}

// Whether a limb that reached for an end left out made the fit cheaper.
bool reachOut(TemplateEmbedder& embedder, TemplateFit& fit) {
  std::vector<std::pair<Index, Vec3>> reaches;
  for (const Vec3& end : endsLeftOut(embedder.body(), fit)) {
    for (Index j = 0; j < fit.skeleton.jointCount(); ++j) {
      const bool isTip = fit.skeleton.joints[j].role == TemplateRole::kTip;
      if (isTip && !fit.pins[j]) reaches.emplace_back(j, end);
    }
  }
  if (reaches.empty()) return false;
  const std::vector<TemplateVariant> variants =
      madeInParallel(reaches.size(), [&](std::size_t i) { return reaching(fit, reaches[i].first, reaches[i].second); });
  TemplateFit nearest = nearestOf(variants, embedder);
  bendNearer(embedder, nearest);
  if (!cheaper(nearest, fit)) return false;
  fit = std::move(nearest);
  return true;
}

}  // namespace

void searchPose(TemplateEmbedder& embedder, TemplateFit& fit) {
  const bool pinned = fit.skeleton.bent();
  if (!pinned && (fit.cost < kDoubtful || fit.frame.symmetric())) return;
  TemplateFit bent = fit;
  bendNearer(embedder, bent);
  if (!pinned && bent.cost > kHopeless * kMaxCost) return;
  for (int reach = 0; reach < kMaxReaches && reachOut(embedder, bent); ++reach) {
  }
  if (pinned || bent.cost < std::min(kMaxCost, kWorthBending * fit.cost)) fit = std::move(bent);
}

}  // namespace limber
