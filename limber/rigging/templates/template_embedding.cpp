#include "limber/rigging/templates/template_embedding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/rigging/templates/joints_between.h"

namespace limber {

namespace {

// Weights of the penalties, each of which is about 1 for what is unusual. Heights are body heights.
constexpr double kOutside = 40;           // for each height of a bone that runs outside
constexpr double kOutsideDepth = 0.02;    // heights outside that count in full
constexpr double kSample = 0.03;          // heights between two looks along a bone
constexpr double kLongestBone = 0.7;      // heights
constexpr double kOffMiddle = 1.5;        // for a position beside the deepest of its part
constexpr double kPositionSpread = 0.22;  // heights, of joints about their position in the template
constexpr double kTipSpread = 0.12;       // heights up, of tips on the ground and on top
constexpr double kHandSpread = 0.3;       // of other tips
constexpr double kNearEnd = 0.12;         // heights from the ground or the top
constexpr double kMiddleSpread = 0.02;    // heights, of joints of the middle to the sides
constexpr double kTipReach = 0.04;        // heights from an end of the model
constexpr double kNoTip = 4;              // most that a tip away from every end costs
constexpr double kNearPlane = 0.03;       // heights: such spheres count for the middle
constexpr double kLineSpacing = 0.02;     // heights between positions along the middle line
constexpr double kWorstBone = 25;         // most that length and direction of a bone cost
constexpr double kWorstTip = 5;           // of the bone to a tip: stumps have no hands and feet

constexpr double kPinnedEvenly = 1e-3;  // heights between a pin and the mirror image of its like

constexpr double kDescentSteps[] = {0.01, 0.005};  // heights
constexpr int kDescentRounds = 2;                  // with each

constexpr std::size_t kLanes = 32;  // side by side: compilers make no vector instructions of 16 or less
constexpr float kNever = 1e30f;     // cost

void checkJoints(const TemplateSkeleton& variant, std::size_t joints) {
  if (variant.jointCount() == joints) return;
  throw Error(ErrorCode::kBadArgument, "variants of a template and its pins must have the same joints", variant.name);
}

}  // namespace

class TemplateEmbedder::Search {
 public:
  // `skeleton` defines the joints; their positions do not matter yet.
  Search(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
         const TemplatePins& pins, const EmbeddingOptions& options)
      : skeleton_(skeleton), body_(body), frame_(frame), pins_(pins), options_(options), half_(frame.symmetric()) {
    half_ = half_ && pinnedEvenly(skeleton, pins);
    chooseJoints();
    if (half_ && !hangsTogether()) {
      half_ = false;
      chooseJoints();
    }
    gatherCandidates();
    measureBones();
  }

  std::vector<TemplateEmbedding> embed(std::span<const TemplateVariant> variants) {
    std::vector<Tree> trees;
    for (const TemplateVariant& variant : variants) {
      skeleton_ = variant.skeleton;
      trees.push_back(treeOf());
    }
    solve(trees);
    std::vector<TemplateEmbedding> embeddings;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      skeleton_ = variants[v].skeleton;
      embeddings.push_back(readOff(trees[v]));
      embeddings.back().cost += variants[v].cost;
    }
    return embeddings;
  }

 private:
  struct Candidate {
    Vec3 position = Vec3::Zero();
    double radius = 0;
    double offMiddle = 0;  // 0 for the deepest of its part, up to 1
    double toTip = 0;      // heights to the nearest end of the model
  };

  bool isLeftOrMiddle(const TemplateJoint& joint) const { return !joint.mirror || joint.position.x() > 0; }

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
    candidate.position = frame_.toBody(point);
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
      if ((other.position - c.position).squaredNorm() < 2.25 * c.radius * c.radius)
        deepest = std::max(deepest, other.radius);
    }
    return deepest > 0 && c.radius > 0 ? 1 - c.radius / deepest : 1;
  }

  void add(const Vec3& point) { candidates_.push_back(candidateAt(point)); }

  void gatherCandidates() {
    std::vector<Vec3> points;
    // Of many spheres every second, third, ...: the deepest alone may all lie in a large head.
    const std::size_t stride = (body_.spheres.size() + options_.maxSpheres - 1) / options_.maxSpheres;
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
  // positions between left and right.
  void addMiddleLine() {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const MedialSphere& sphere : body_.spheres) {
      const Vec3 position = frame_.toBody(sphere.center);
      const double radius = sphere.radius / frame_.height;
      low = std::min(low, position.z() - radius);
      high = std::max(high, position.z() + radius);
    }
    const double step = 0.5 * body_.distance->spacing() / frame_.height;
    for (double y = 0.5 * kLineSpacing; y < 1; y += kLineSpacing) {
      Vec3 deepest = Vec3::Zero();
      double depth = 0;
      for (double z = low; z <= high; z += step) {
        const Vec3 position(0, y, z);
        const double here = -body_.distance->at(frame_.fromBody(position));
        if (here > depth) {
          depth = here;
          deepest = position;
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
      const Vec3 position = a + (s + 0.5) / steps * (b - a);
      const double value = body_.distance->at(frame_.fromBody(position)) / frame_.height;
      outside += std::clamp(value / kOutsideDepth, 0.0, 1.0);
    }
    return kOutside * outside * length / steps;
  }

  void measureBones() {
    const std::size_t count = candidates_.size();
    bones_.assign(count, Bones(padded(count)));
    parallelFor(count, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) {
        Bones& bones = bones_[a];
        for (std::size_t b = 0; b < count; ++b) {
          const Vec3 displacement = candidates_[b].position - candidates_[a].position;
          const double length = std::max(displacement.norm(), 1e-3);
          for (int axis = 0; axis < 3; ++axis)
            bones.direction[axis][b] = static_cast<float>(displacement[axis] / length);
          bones.logLength[b] = static_cast<float>(std::log(length));
          if (b > a)
            bones.outside[b] = static_cast<float>(outsidePenalty(candidates_[a].position, candidates_[b].position));
        }
      }
    });
    for (std::size_t a = 0; a < count; ++a) {
      bones_[a].outside[a] = 0;
      for (std::size_t b = 0; b < a; ++b) bones_[a].outside[b] = bones_[b].outside[a];
    }
  }

  double positionPenalty(Index j, const Candidate& c) const {
    const TemplateJoint& joint = skeleton_.joints[j];
    const bool tip = joint.role == TemplateRole::kTip;
    const Vec3 off = c.position - joint.position;
    double penalty = kOffMiddle * (tip ? 0 : c.offMiddle * c.offMiddle);
    // Feet are on the ground and the head is on top; hands hang or reach out.
    const bool outermost = tip && (joint.position.y() < kNearEnd || joint.position.y() > 1 - kNearEnd);
    const double up = off.y() / (outermost ? kTipSpread : tip ? kHandSpread : kPositionSpread);
    penalty += up * up + off.z() * off.z() / (4 * kPositionSpread * kPositionSpread);
    if (skeleton_.bent()) {
      penalty += off.x() * off.x() / (4 * kPositionSpread * kPositionSpread);
    } else if (!joint.mirror) {
      penalty += c.position.x() * c.position.x() / (kMiddleSpread * kMiddleSpread);
    } else {
      const double inside = joint.position.x() > 0 ? c.position.x() : -c.position.x();
      const double over = std::min(0.0, inside - 0.01) / kMiddleSpread;
      penalty += over * over + off.x() * off.x() / (4 * kPositionSpread * kPositionSpread);
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
    const Vec3 bone = joint.position - skeleton_.joints[above_[j]].position;
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

  // A variant while it is solved.
  struct Tree {
    std::vector<BoneShape> shapes;          // by joint
    std::vector<std::vector<float>> below;  // [joint][candidate]: what the tree from there on costs at best
  };

  Tree treeOf() const {
    const std::size_t count = candidates_.size();
    Tree tree;
    tree.shapes.resize(skeleton_.jointCount());
    tree.below.resize(skeleton_.jointCount());
    for (const Index j : chosen_) {
      tree.below[j].resize(padded(count));
      for (std::size_t c = 0; c < count; ++c) {
        const bool allowed = pinned_[j] == kNoIndex || pinned_[j] == c;
        tree.below[j][c] = allowed ? static_cast<float>(positionPenalty(j, candidates_[c])) : 1e9f;
      }
      if (above_[j] != kNoIndex) tree.shapes[j] = shapeOf(j);
    }
    return tree;
  }

  // Joints by how many others hang on them one below the other: ends first.
  std::vector<std::vector<Index>> levels() const {
    std::vector<std::size_t> level(skeleton_.jointCount(), 0);
    std::vector<std::vector<Index>> levels;
    for (auto j = chosen_.rbegin(); j != chosen_.rend(); ++j) {
      if (above_[*j] == kNoIndex) continue;
      if (level[*j] >= levels.size()) levels.resize(level[*j] + 1);
      levels[level[*j]].push_back(*j);
      level[above_[*j]] = std::max(level[above_[*j]], level[*j] + 1);
    }
    return levels;
  }

  // From the leaves up, all trees together: the bones of a candidate are many, and better used often while they are at
  // hand.
  void solve(std::vector<Tree>& trees) const {
    for (const std::vector<Index>& joints : levels()) {
      parallelFor(candidates_.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; a < end; ++a) {
          for (Tree& tree : trees) {
            for (const Index j : joints) tree.below[above_[j]][a] += minFrom(tree, j, a);
          }
        }
      });
    }
  }

  // What the bones from a candidate and the tree below them cost, for some candidates below in a row. Loops without
  // branches, which compilers turn into vector instructions.
  using Lanes = std::array<float, kLanes>;
  Lanes costsFrom(const Tree& tree, Index j, std::size_t above, std::size_t first) const {
    const BoneShape& shape = tree.shapes[j];
    const Bones& bones = bones_[above];
    Lanes costs;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t b = first + lane;
      const float stretch = bones.logLength[b] - shape.logLength;
      const float along = shape.direction.x() * bones.direction[0][b] + shape.direction.y() * bones.direction[1][b] +
                          shape.direction.z() * bones.direction[2][b];
      costs[lane] = shape.lengthWeight * stretch * stretch + shape.turnWeight * (1 - along);
    }
    for (float& cost : costs) cost = cost < shape.worst ? cost : shape.worst;
    const float* below = tree.below[j].data() + first;
    for (std::size_t lane = 0; lane < kLanes; ++lane) costs[lane] += below[lane] + bones.outside[first + lane];
    return costs;
  }

  float minFrom(const Tree& tree, Index j, std::size_t above) const {
    Lanes least;
    least.fill(kNever);
    for (std::size_t first = 0; first < bones_[above].outside.size(); first += kLanes) {
      const Lanes costs = costsFrom(tree, j, above, first);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        least[lane] = costs[lane] < least[lane] ? costs[lane] : least[lane];
      }
    }
    return *std::min_element(least.begin(), least.end());
  }

  // The first candidate that has the least costs.
  std::size_t choiceFrom(const Tree& tree, Index j, std::size_t above) const {
    const float least = minFrom(tree, j, above);
    for (std::size_t first = 0; first < bones_[above].outside.size(); first += kLanes) {
      const Lanes costs = costsFrom(tree, j, above, first);
      const auto found = std::find(costs.begin(), costs.end(), least);
      if (found != costs.end()) return first + static_cast<std::size_t>(found - costs.begin());
    }
    return 0;
  }

  double boneCost(Index j, const Candidate& above, const Candidate& below) const {
    const Vec3 bone = below.position - above.position;
    const double length = std::max(bone.norm(), 1e-3);
    return outsidePenalty(above.position, below.position) +
           bonePenalty(shapeOf(j), static_cast<float>(std::log(length)), (bone / length).cast<float>());
  }

  // Of a joint at a position, and of the bones that meet there.
  double costAround(Index j, const Candidate& position, const std::vector<Candidate>& found) const {
    double cost = positionPenalty(j, position);
    if (above_[j] != kNoIndex) cost += boneCost(j, found[above_[j]], position);
    for (const Index other : chosen_) {
      if (above_[other] == j) cost += boneCost(other, position, found[other]);
    }
    return cost;
  }

  // Joints leave the candidates for positions nearby that cost less, one after the other, by smaller and smaller steps.
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
      for (const double displacement : {step, -step}) {
        Candidate other = candidateAt(frame_.fromBody(found[j].position + displacement * Vec3::Unit(axis)));
        other.offMiddle = offMiddle(other);
        const double cost = costAround(j, other, found);
        if (cost >= least) continue;
        least = cost;
        found[j] = other;
        break;
      }
    }
  }

  TemplateEmbedding readOff(const Tree& tree) const {
    TemplateEmbedding result;
    result.positions.assign(skeleton_.jointCount(), Vec3::Zero());
    result.costs.assign(skeleton_.jointCount(), 0.0);
    std::vector<std::size_t> at(skeleton_.jointCount(), 0);
    std::vector<Candidate> found(skeleton_.jointCount());
    for (const Index j : chosen_) {
      const auto first = tree.below[j].begin(), last = first + static_cast<std::ptrdiff_t>(candidates_.size());
      at[j] = above_[j] == kNoIndex ? static_cast<std::size_t>(std::min_element(first, last) - first)
                                    : choiceFrom(tree, j, at[above_[j]]);
      found[j] = candidates_[at[j]];
    }
    for (const Index j : chosen_) {
      if (above_[j] != kNoIndex) result.costs[j] = boneCost(j, found[above_[j]], found[j]);
      result.costs[j] += positionPenalty(j, found[j]);
      result.cost += result.costs[j] / static_cast<double>(chosen_.size());
    }
    if (options_.refine) descend(found);
    for (const Index j : chosen_) result.positions[j] = found[j].position;
    if (half_) {
      for (const Index j : chosen_) {
        const std::optional<Index> mirror = skeleton_.joints[j].mirror;
        if (!mirror) continue;
        result.positions[*mirror] = result.positions[j].cwiseProduct(Vec3(-1, 1, 1));
        result.costs[*mirror] = result.costs[j];
      }
    }
    placeBetween(skeleton_, result.positions);
    return result;
  }

  static std::size_t padded(std::size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

  // From one candidate to each, and to some more that are never chosen.
  struct Bones {
    std::vector<float> outside, logLength;
    std::array<std::vector<float>, 3> direction;  // x, y and z

    explicit Bones(std::size_t count) : outside(count, kNever), logLength(count, 0.0f) {
      direction.fill(std::vector<float>(count, 0.0f));
    }
  };

  TemplateSkeleton skeleton_;
  const BodyVolume& body_;
  AnatomicalFrame frame_;
  TemplatePins pins_;
  EmbeddingOptions options_;
  bool half_;  // the right side mirrors the left one
  std::vector<Index> chosen_, above_, pinned_;
  std::vector<Candidate> candidates_;
  std::vector<Bones> bones_;  // by the candidate above
};

bool pinnedEvenly(const TemplateSkeleton& skeleton, const TemplatePins& pins) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!pins[j]) continue;
    const std::optional<Vec3>& other = pins[skeleton.joints[j].mirror.value_or(j)];
    if (!other || (other->cwiseProduct(Vec3(-1, 1, 1)) - *pins[j]).norm() > kPinnedEvenly) return false;
  }
  return true;
}

TemplateEmbedder::TemplateEmbedder(const TemplateSkeleton& skeleton, const BodyVolume& body,
                                   const AnatomicalFrame& frame, const TemplatePins& pins,
                                   const EmbeddingOptions& options)
    : body_(&body), frame_(frame), pins_(pins) {
  checkJoints(skeleton, pins.size());
  search_ = std::make_unique<Search>(skeleton, body, frame, pins, options);
}

TemplateEmbedder::~TemplateEmbedder() = default;
TemplateEmbedder::TemplateEmbedder(TemplateEmbedder&&) noexcept = default;
TemplateEmbedder& TemplateEmbedder::operator=(TemplateEmbedder&&) noexcept = default;

std::vector<TemplateEmbedding> TemplateEmbedder::embed(std::span<const TemplateVariant> variants) {
  for (const TemplateVariant& variant : variants) checkJoints(variant.skeleton, pins_.size());
  return search_->embed(variants);
}

}  // namespace limber
