#include "limber/templates/template_embedding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/error.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

// Weights of the penalties, each of which is about 1 for what is unusual. Heights are body heights.
constexpr double kOutside = 40;         // for each height of a bone that runs outside
constexpr double kOutsideDepth = 0.02;  // heights outside that count in full
constexpr double kSample = 0.03;        // heights between two looks along a bone
constexpr double kLongestBone = 0.7;    // heights
constexpr double kOffMiddle = 1.5;      // for a place beside the deepest of its part
constexpr double kPlaceSpread = 0.22;   // heights, of joints about their place in the template
constexpr double kTipSpread = 0.12;     // heights up, of tips on the ground and on top
constexpr double kHandSpread = 0.3;     // of other tips
constexpr double kNearEnd = 0.12;       // heights from the ground or the top
constexpr double kMiddleSpread = 0.02;  // heights, of joints of the middle to the sides
constexpr double kTipReach = 0.04;      // heights from an end of the model
constexpr double kNoTip = 4;            // most that a tip away from every end costs
constexpr double kNearPlane = 0.03;     // heights: such spheres count for the middle
constexpr double kLineSpacing = 0.02;   // heights of places along the middle line
constexpr double kWorstBone = 25;       // most that length and direction of a bone cost
constexpr double kWorstTip = 5;         // of the way to a tip: stumps have no hands and feet

constexpr double kPinnedEvenly = 1e-3;  // heights between a pin and the mirror image of its like

constexpr double kDescentSteps[] = {0.01, 0.005};  // heights
constexpr int kDescentRounds = 2;                  // with each

struct Candidate {
  Vec3 place = Vec3::Zero();
  double radius = 0;
  double offMiddle = 0;  // 0 for the deepest of its part, up to 1
  double toTip = 0;      // heights to the nearest end of the model
};

class Embedder {
 public:
  // `skeleton` says which joints there are; their places do not matter yet.
  Embedder(const TemplateSkeleton& skeleton, const BodyVolume& body, const BodyFrame& frame, const TemplatePins& pins,
           const EmbeddingOptions& options)
      : skeleton_(skeleton), body_(body), frame_(frame), pins_(pins), options_(options), half_(frame.symmetric()) {
    half_ = half_ && pinnedEvenly(skeleton, pins);
    chooseJoints();
    if (half_ && !hangsTogether()) {
      half_ = false;
      chooseJoints();
    }
    gatherCandidates();
    measurePairs();
  }

  TemplateEmbedding embed(const TemplateSkeleton& variant) {
    skeleton_ = variant;
    solve();
    return readOff();
  }

 private:
  bool isLeftOrMiddle(const TemplateJoint& joint) const { return !joint.mirror || joint.place.x() > 0; }

  // Placed joints and tips that are searched for, each with the one above it.
  void chooseJoints() {
    chosen_.clear();
    above_.assign(skeleton_.jointCount(), kNoIndex);
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const TemplateJoint& joint = skeleton_.joints[j];
      if (joint.role == TemplateRole::kBetween || (half_ && !isLeftOrMiddle(joint))) continue;
      std::optional<Index> parent = joint.parent;
      while (parent && skeleton_.joints[*parent].role == TemplateRole::kBetween)
        parent = skeleton_.joints[*parent].parent;
      if (parent) above_[j] = *parent;
      chosen_.push_back(j);
    }
  }

  // Not where a joint of the left or the middle hangs on one of the right.
  bool hangsTogether() const {
    return std::all_of(chosen_.begin(), chosen_.end(), [&](Index j) {
      return above_[j] == kNoIndex || std::find(chosen_.begin(), chosen_.end(), above_[j]) != chosen_.end();
    });
  }

  Candidate candidateAt(const Vec3& point) const {
    Candidate candidate;
    candidate.place = frame_.toBody(point);
    candidate.radius = -body_.distance->at(point) / frame_.height;
    candidate.toTip = std::numeric_limits<double>::infinity();
    for (const BodyTip& tip : body_.tips) {
      candidate.toTip = std::min(candidate.toTip, (tip.position - point).norm() / frame_.height);
      if (half_)
        candidate.toTip = std::min(candidate.toTip, (frame_.mirrored(tip.position) - point).norm() / frame_.height);
    }
    return candidate;
  }

  double offMiddle(const Candidate& c) const {
    double deepest = c.radius;
    for (const Candidate& other : candidates_) {
      if ((other.place - c.place).squaredNorm() < 2.25 * c.radius * c.radius) deepest = std::max(deepest, other.radius);
    }
    return deepest > 0 && c.radius > 0 ? 1 - c.radius / deepest : 1;
  }

  void add(const Vec3& point) { candidates_.push_back(candidateAt(point)); }

  void gatherCandidates() {
    std::vector<Vec3> points;
    // Of many spheres every second, third, ...: the deepest alone may all lie in a large head.
    const std::size_t stride = (body_.spheres.size() + options_.mostSpheres - 1) / options_.mostSpheres;
    for (std::size_t s = 0; s < body_.spheres.size(); s += stride) points.push_back(body_.spheres[s].center);
    for (const BodyTip& tip : body_.tips) points.push_back(tip.position);
    const Vec3 left = frame_.axes.row(0).transpose();
    for (const Vec3& point : points) {
      if (!half_) {
        add(point);
        continue;
      }
      const double x = left.dot(point - frame_.origin) / frame_.height;
      const Vec3 onPlane = point - x * frame_.height * left;
      const double depth = -body_.distance->at(onPlane);
      if (std::abs(x) < kNearPlane && depth > 0) add(onPlane);
      if (std::abs(x) > 0.015 && (x > 0 || body_.distance->at(frame_.mirrored(point)) < 0)) {
        add(x > 0 ? point : frame_.mirrored(point));
      }
    }
    if (half_) addMiddleLine();
    for (Candidate& c : candidates_) c.offMiddle = offMiddle(c);
    pinned_.assign(skeleton_.jointCount(), kNoIndex);
    for (const Index j : chosen_) {
      if (!pins_[j]) continue;
      pinned_[j] = static_cast<Index>(candidates_.size());
      add(frame_.fromBody(*pins_[j]));
      candidates_.back().offMiddle = 0;
    }
  }

  // Necks, heads and hips of bulky bodies lie where no medial sphere has its centre: for each height the deepest
  // places between left and right.
  void addMiddleLine() {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const MedialSphere& sphere : body_.spheres) {
      const Vec3 place = frame_.toBody(sphere.center);
      const double radius = sphere.radius / frame_.height;
      low = std::min(low, place.z() - radius);
      high = std::max(high, place.z() + radius);
    }
    const double step = 0.5 * body_.distance->spacing() / frame_.height;
    for (double y = 0.5 * kLineSpacing; y < 1; y += kLineSpacing) {
      Vec3 deepest = Vec3::Zero();
      double depth = 0;
      for (double z = low; z <= high; z += step) {
        const Vec3 place(0, y, z);
        const double here = -body_.distance->at(frame_.fromBody(place));
        if (here > depth) {
          depth = here;
          deepest = place;
        }
      }
      if (depth > 0) add(frame_.fromBody(deepest));
    }
  }

  double outsidePenalty(const Vec3& a, const Vec3& b) const {
    const double length = (b - a).norm();
    if (length > kLongestBone) return kOutside * length;
    const int steps = std::max(1, static_cast<int>(length / kSample));
    double outside = 0;
    for (int s = 0; s < steps; ++s) {
      const Vec3 place = a + (s + 0.5) / steps * (b - a);
      const double value = body_.distance->at(frame_.fromBody(place)) / frame_.height;
      outside += std::clamp(value / kOutsideDepth, 0.0, 1.0);
    }
    return kOutside * outside * length / steps;
  }

  void measurePairs() {
    const std::size_t count = candidates_.size();
    pairs_.resize(count * count);
    parallelFor(count, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) {
        for (std::size_t b = 0; b < count; ++b) {
          Pair& pair = pairs_[a * count + b];
          const Vec3 bone = candidates_[b].place - candidates_[a].place;
          const double length = std::max(bone.norm(), 1e-3);
          pair.direction = (bone / length).cast<float>();
          pair.logLength = static_cast<float>(std::log(length));
          if (b > a) pair.outside = static_cast<float>(outsidePenalty(candidates_[a].place, candidates_[b].place));
        }
      }
    });
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < a; ++b) pairs_[a * count + b].outside = pairs_[b * count + a].outside;
    }
  }

  double placePenalty(Index j, const Candidate& c) const {
    const TemplateJoint& joint = skeleton_.joints[j];
    const bool tip = joint.role == TemplateRole::kTip;
    const Vec3 off = c.place - joint.place;
    double penalty = kOffMiddle * (tip ? 0 : c.offMiddle * c.offMiddle);
    // Feet are on the ground and the head is on top; hands hang or reach out.
    const bool outermost = tip && (joint.place.y() < kNearEnd || joint.place.y() > 1 - kNearEnd);
    const double up = off.y() / (outermost ? kTipSpread : tip ? kHandSpread : kPlaceSpread);
    penalty += up * up + off.z() * off.z() / (4 * kPlaceSpread * kPlaceSpread);
    if (skeleton_.bent()) {
      penalty += off.x() * off.x() / (4 * kPlaceSpread * kPlaceSpread);
    } else if (!joint.mirror) {
      penalty += c.place.x() * c.place.x() / (kMiddleSpread * kMiddleSpread);
    } else {
      const double inside = joint.place.x() > 0 ? c.place.x() : -c.place.x();
      const double over = std::min(0.0, inside - 0.01) / kMiddleSpread;
      penalty += over * over + off.x() * off.x() / (4 * kPlaceSpread * kPlaceSpread);
    }
    if (tip) penalty += std::min(kNoTip, c.toTip * c.toTip / (kTipReach * kTipReach));
    return penalty;
  }

  struct BoneShape {
    Vec3f direction;
    float logLength, lengthWeight, turnWeight, worst;
  };
  BoneShape shapeOf(Index j) const {
    const TemplateJoint& joint = skeleton_.joints[j];
    const Vec3 bone = joint.place - skeleton_.joints[above_[j]].place;
    const double length = std::max(bone.norm(), 1e-3);
    return {(bone / length).cast<float>(), static_cast<float>(std::log(length)),
            static_cast<float>(1 / (joint.lengthSpread * joint.lengthSpread)),
            static_cast<float>(2 / (joint.turnSpread * joint.turnSpread)),
            static_cast<float>(joint.role == TemplateRole::kTip ? kWorstTip : kWorstBone)};
  }

  static float bonePenalty(const BoneShape& shape, float logLength, const Vec3f& direction) {
    const float stretch = logLength - shape.logLength;
    const float shapePenalty =
        shape.lengthWeight * stretch * stretch + shape.turnWeight * (1 - shape.direction.dot(direction));
    return std::min(shape.worst, shapePenalty);
  }

  // From the leaves up: what the tree below a joint costs at best, for each place of the joint.
  void solve() {
    const std::size_t count = candidates_.size();
    below_.assign(skeleton_.jointCount(), {});
    choice_.assign(skeleton_.jointCount(), {});
    for (const Index j : chosen_) {
      below_[j].resize(count);
      for (std::size_t c = 0; c < count; ++c) {
        const bool allowed = pinned_[j] == kNoIndex || pinned_[j] == c;
        below_[j][c] = allowed ? static_cast<float>(placePenalty(j, candidates_[c])) : 1e9f;
      }
    }
    for (auto j = chosen_.rbegin(); j != chosen_.rend(); ++j) {
      if (above_[*j] == kNoIndex) continue;
      const BoneShape shape = shapeOf(*j);
      const std::vector<float>& own = below_[*j];
      std::vector<float>& parent = below_[above_[*j]];
      choice_[*j].resize(count);
      parallelFor(count, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; a < end; ++a) {
          float best = std::numeric_limits<float>::infinity();
          for (std::size_t b = 0; b < count; ++b) {
            const Pair& pair = pairs_[a * count + b];
            const float least = own[b] + pair.outside;
            if (least >= best) continue;
            const float cost = least + bonePenalty(shape, pair.logLength, pair.direction);
            if (cost >= best) continue;
            best = cost;
            choice_[*j][a] = static_cast<Index>(b);
          }
          parent[a] += best;
        }
      });
    }
  }

  double boneCost(Index j, const Candidate& above, const Candidate& below) const {
    const Vec3 bone = below.place - above.place;
    const double length = std::max(bone.norm(), 1e-3);
    return outsidePenalty(above.place, below.place) +
           bonePenalty(shapeOf(j), static_cast<float>(std::log(length)), (bone / length).cast<float>());
  }

  // Of a joint at a place, and of the bones that meet there.
  double costAround(Index j, const Candidate& place, const std::vector<Candidate>& found) const {
    double cost = placePenalty(j, place);
    if (above_[j] != kNoIndex) cost += boneCost(j, found[above_[j]], place);
    for (const Index other : chosen_) {
      if (above_[other] == j) cost += boneCost(other, place, found[other]);
    }
    return cost;
  }

  // Joints leave the candidates for places nearby that cost less, one after the other, by smaller and smaller steps.
  void descend(std::vector<Candidate>& found) const {
    for (const double step : kDescentSteps) {
      for (int round = 0; round < kDescentRounds; ++round) {
        for (const Index j : chosen_) {
          if (skeleton_.joints[j].role != TemplateRole::kTip && pinned_[j] == kNoIndex) stepDown(j, step, found);
        }
      }
    }
  }

  void stepDown(Index j, double step, std::vector<Candidate>& found) const {
    const bool onPlane = half_ && !skeleton_.joints[j].mirror;
    double least = costAround(j, found[j], found);
    for (int axis = onPlane ? 1 : 0; axis < 3; ++axis) {
      for (const double way : {step, -step}) {
        Candidate other = candidateAt(frame_.fromBody(found[j].place + way * Vec3::Unit(axis)));
        other.offMiddle = offMiddle(other);
        const double cost = costAround(j, other, found);
        if (cost >= least) continue;
        least = cost;
        found[j] = other;
        break;
      }
    }
  }

  TemplateEmbedding readOff() {
    TemplateEmbedding result;
    result.places.assign(skeleton_.jointCount(), Vec3::Zero());
    result.costs.assign(skeleton_.jointCount(), 0.0);
    std::vector<Index> at(skeleton_.jointCount(), 0);
    std::vector<Candidate> found(skeleton_.jointCount());
    for (const Index j : chosen_) {
      at[j] = above_[j] == kNoIndex
                  ? static_cast<Index>(std::min_element(below_[j].begin(), below_[j].end()) - below_[j].begin())
                  : choice_[j][at[above_[j]]];
      found[j] = candidates_[at[j]];
    }
    for (const Index j : chosen_) {
      if (above_[j] != kNoIndex) result.costs[j] = boneCost(j, found[above_[j]], found[j]);
      result.costs[j] += placePenalty(j, found[j]);
      result.cost += result.costs[j] / static_cast<double>(chosen_.size());
    }
    if (options_.refine) descend(found);
    for (const Index j : chosen_) result.places[j] = found[j].place;
    if (half_) {
      for (const Index j : chosen_) {
        const std::optional<Index> mirror = skeleton_.joints[j].mirror;
        if (!mirror) continue;
        result.places[*mirror] = result.places[j].cwiseProduct(Vec3(-1, 1, 1));
        result.costs[*mirror] = result.costs[j];
      }
    }
    placeBetween(skeleton_, result.places);
    return result;
  }

  struct Pair {
    Vec3f direction = Vec3f::Zero();
    float logLength = 0, outside = 0;
  };

  TemplateSkeleton skeleton_;
  const BodyVolume& body_;
  const BodyFrame& frame_;
  const TemplatePins& pins_;
  EmbeddingOptions options_;
  bool half_;  // the right side mirrors the left one
  std::vector<Index> chosen_, above_, pinned_;
  std::vector<Candidate> candidates_;
  std::vector<Pair> pairs_;                // [above][below]
  std::vector<std::vector<float>> below_;  // [joint][candidate]
  std::vector<std::vector<Index>> choice_;
};

}  // namespace

bool pinnedEvenly(const TemplateSkeleton& skeleton, const TemplatePins& pins) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!pins[j]) continue;
    const std::optional<Vec3>& other = pins[skeleton.joints[j].mirror.value_or(j)];
    if (!other || (other->cwiseProduct(Vec3(-1, 1, 1)) - *pins[j]).norm() > kPinnedEvenly) return false;
  }
  return true;
}

std::vector<TemplateEmbedding> embedTemplate(std::span<const TemplateVariant> variants, const BodyVolume& body,
                                             const BodyFrame& frame, const TemplatePins& pins,
                                             const EmbeddingOptions& options) {
  std::vector<TemplateEmbedding> embeddings;
  if (variants.empty()) return embeddings;
  for (const auto& [variant, cost] : variants) {
    if (variant.jointCount() != variants.front().skeleton.jointCount() || pins.size() != variant.jointCount()) {
      throw Error(ErrorCode::kBadArgument, "variants of a template and its pins must have the same joints",
                  variant.name);
    }
  }
  Embedder embedder(variants.front().skeleton, body, frame, pins, options);
  for (const TemplateVariant& variant : variants) {
    embeddings.push_back(embedder.embed(variant.skeleton));
    embeddings.back().cost += variant.cost;
  }
  return embeddings;
}

void placeBetween(const TemplateSkeleton& skeleton, std::vector<Vec3>& places) {
  const Index count = skeleton.jointCount();
  const auto between = [&](Index j) { return skeleton.joints[j].role == TemplateRole::kBetween; };
  // The placed joint above each joint, and below it: a joint between that leads to none goes along with the bone that
  // the placed joint above it has.
  std::vector<std::optional<Index>> above(count), below(count), firstBelow(count);
  for (Index j = 0; j < count; ++j) {
    if (!skeleton.joints[j].parent) continue;
    const Index parent = *skeleton.joints[j].parent;
    above[j] = between(parent) ? above[parent] : std::optional(parent);
    if (!between(j) && above[j] && !firstBelow[*above[j]]) firstBelow[*above[j]] = j;
  }
  for (Index j = count; j-- > 0;) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const std::optional<Index> own = between(j) ? below[j] : std::optional(j);
    if (parent && between(*parent) && own) below[*parent] = own;
  }
  const auto highest = std::max_element(
      skeleton.joints.begin(), skeleton.joints.end(), [](const TemplateJoint& a, const TemplateJoint& b) {
        const bool known[] = {a.role != TemplateRole::kBetween, b.role != TemplateRole::kBetween};
        return known[0] == known[1] ? a.place.y() < b.place.y() : known[1];
      });
  for (Index j = 0; j < count; ++j) {
    if (!between(j)) continue;
    if (!above[j]) {
      // Above all that are placed: what is on the ground stays there.
      const Vec3& found = places[highest - skeleton.joints.begin()];
      places[j] = found + found.y() / std::max(highest->place.y(), 1e-6) * (skeleton.joints[j].place - highest->place);
      continue;
    }
    const Vec3 &from = skeleton.joints[*above[j]].place, &start = places[*above[j]];
    const Vec3 offset = skeleton.joints[j].place - from;
    const std::optional<Index> end = below[j] ? below[j] : firstBelow[*above[j]];
    if (!end) {
      places[j] = start + offset;
      continue;
    }
    const Vec3 bone = skeleton.joints[*end].place - from, found = places[*end] - start;
    const double squared = std::max(bone.squaredNorm(), 1e-12);
    const double part = offset.dot(bone) / squared;
    const double scale = std::sqrt(found.squaredNorm() / squared);
    places[j] = start + part * found + scale * (Quat::FromTwoVectors(bone, found) * (offset - part * bone));
  }
}

}  // namespace limber
