#include "limber/document/fbx/import_fbx_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/core/sort_unique.h"
#include "limber/document/gltf/accessor.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 3> kKinds = {"Lcl Translation", "Lcl Rotation", "Lcl Scaling"};
constexpr std::array<std::string_view, 3> kAxes = {"d|X", "d|Y", "d|Z"};
constexpr std::string_view kPercent = "d|DeformPercent";

constexpr double kTolerance = 1e-4;  // radians, or of what a track moves through
constexpr double kMinMove = 0.1;     // of its values: what moves through less is mostly noise of the numbers
// Keys of the file that are no farther apart than a picture of a film takes were baked: nothing comes between them.
// Parts as short of longer spans are divided for a larger error only.
constexpr std::int64_t kShortSpan = kFbxTicksPerSecond / 24;
constexpr double kShortSpanTolerance = 5;                          // times as large
constexpr std::int64_t kShortestSplit = kFbxTicksPerSecond / 120;  // spans up to here are not divided
constexpr int kMaxHalvings = 10;
constexpr std::size_t kNumbersOfAKey = 4;  // of a rotation; longer rows count as several keys

[[noreturn]] void failShared(const std::string& clip) {
  throw Error(ErrorCode::kLimit, "shares its curves among so much that its keys take too much memory",
              fmt::format("clip '{}'", clip), "export it with fewer clips, models or blend shapes");
}

// What the clips of a document may still take.
struct ClipBudget {
  std::size_t moreKeys = 0, numbers = 0;
};

// In what glTF can say of it: files have the same number in several precisions.
bool differs(double a, double b) {
  return static_cast<float>(a) != static_cast<float>(b);
}

using Row = Eigen::VectorXd;

enum class TrackPath { kTranslation, kRotation, kScale, kWeights };

// One path of one node over time.
struct FbxTrack {
  std::vector<std::int64_t> ticks;
  std::vector<float> times;
  std::vector<Row> rows;
  Interpolation interpolation = Interpolation::kLinear;
};

// What a track shows at a moment; `fromLeft` as FbxCurve::at has it.
using RowAt = std::function<Row(std::int64_t ticks, bool fromLeft)>;

Row between(const Row& a, const Row& b, double x, bool isRotation) {
  if (!isRotation) return a + x * (b - a);
  const Quat from(a.data()), to(b.data());
  return from.slerp(x, to).coeffs();
}

double distanceOf(const Row& a, const Row& b, bool isRotation) {
  const double apart = (a - b).norm();
  return isRotation ? 2 * std::min(apart, (a + b).norm()) : apart;
}

class TrackSampler {
 public:
  TrackSampler(const RowAt& at, Eigen::Index components, bool isRotation, ClipBudget& budget)
      : at_(at), components_(components), isRotation_(isRotation), budget_(budget) {}

  // `keys` ascending, at least one.
  FbxTrack sample(const std::vector<std::int64_t>& keys) {
    const auto count = static_cast<Eigen::Index>(keys.size());
    Eigen::MatrixXd here(components_, count), left(components_, count);  // at each key, and its limit from the left
    for (Eigen::Index k = 0; k < count; ++k) {
      here.col(k) = at_(keys[static_cast<std::size_t>(k)], false);
      left.col(k) = at_(keys[static_cast<std::size_t>(k)], true);
    }
    double reach = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      reach = std::max({reach, (here.col(k) - here.col(0)).norm(), kMinMove * here.col(k).norm()});
    }
    tolerance_ = isRotation_ ? kTolerance : kTolerance * reach;
    // Whether it is constant between all keys and jumps at some.
    bool steps = false, isConstant = true;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
      const auto from = static_cast<Eigen::Index>(k), to = from + 1;
      steps = steps || here.col(to) != left.col(to);
      isConstant = isConstant && here.col(from) == left.col(to) &&
                   at_(keys[k] + (keys[k + 1] - keys[k]) / 2, false) == here.col(from);
    }
    FbxTrack track;
    if (steps && isConstant) track.interpolation = Interpolation::kStep;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Row row = here.col(column), before = left.col(column);
      if (k > 0 && track.interpolation == Interpolation::kLinear) {
        const bool isBaked = keys[k] - keys[k - 1] <= kShortSpan;
        addBetween(track, {keys[k - 1], keys[k]}, here.col(column - 1), before, isBaked ? 0 : kMaxHalvings);
        // One tick before: as floats the two times may be equal; the next float down then represents this one.
        if (before != row && keys[k] - 1 > keys[k - 1]) add(track, keys[k] - 1, before);
      }
      add(track, keys[k], row);
    }
    return track;
  }

 private:
  struct Span {
    std::int64_t from, to;
  };

  static void add(FbxTrack& track, std::int64_t ticks, const Row& row) {
    track.ticks.push_back(ticks);
    track.rows.push_back(row);
  }

  void addBetween(FbxTrack& track, const Span& span, const Row& from, const Row& to, int halvings) {
    const std::int64_t length = span.to - span.from, middle = span.from + length / 2;
    if (length <= kShortestSplit || halvings == 0 || budget_.moreKeys == 0) return;
    const Row half = at_(middle, false);
    const double tolerance = length > kShortSpan ? tolerance_ : kShortSpanTolerance * tolerance_;
    const bool fits = distanceOf(between(from, to, 0.5, isRotation_), half, isRotation_) <= tolerance &&
                      fitsAt(span, from, to, 0.25, tolerance) && fitsAt(span, from, to, 0.75, tolerance);
    if (fits) return;
    const std::size_t cost = std::max<std::size_t>(1, static_cast<std::size_t>(components_) / kNumbersOfAKey);
    budget_.moreKeys -= std::min(budget_.moreKeys, cost);
    addBetween(track, {span.from, middle}, from, half, halvings - 1);
    add(track, middle, half);
    addBetween(track, {middle, span.to}, half, to, halvings - 1);
  }

  bool fitsAt(const Span& span, const Row& from, const Row& to, double x, double tolerance) const {
    const auto ticks = span.from + static_cast<std::int64_t>(x * static_cast<double>(span.to - span.from));
    return distanceOf(between(from, to, x, isRotation_), at_(ticks, false), isRotation_) <= tolerance;
  }

  const RowAt& at_;
  Eigen::Index components_;
  bool isRotation_;
  ClipBudget& budget_;
  double tolerance_ = 0;
};

// q and -q are the same rotation, but interpolation to them takes different paths.
void keepNearSide(FbxTrack& track) {
  for (std::size_t k = 1; k < track.rows.size(); ++k) {
    if (track.rows[k].dot(track.rows[k - 1]) < 0) track.rows[k] = -track.rows[k];
  }
}

// A value that does not change needs no more than the first and the last of its keys.
void dropRepeated(FbxTrack& track) {
  const bool isStill =
      std::all_of(track.rows.begin(), track.rows.end(), [&](const Row& row) { return row == track.rows[0]; });
  if (!isStill || track.rows.size() < 3) return;
  track.ticks = {track.ticks.front(), track.ticks.back()};
  track.rows.resize(2);
}

// Seconds in single precision, strictly increasing: where keys fall together the earlier one goes down.
void setTimes(FbxTrack& track, std::int64_t start) {
  track.times.clear();
  for (const std::int64_t ticks : track.ticks) {
    track.times.push_back(
        static_cast<float>(static_cast<double>(ticks - start) / static_cast<double>(kFbxTicksPerSecond)));
  }
  for (std::size_t k = track.times.size(); k-- > 1;) {
    if (track.times[k - 1] >= track.times[k]) {
      track.times[k - 1] = std::nextafter(track.times[k], -std::numeric_limits<float>::infinity());
    }
  }
}

// When curves have keys: many models may share a curve, whose keys count once.
class KeyTicks {
 public:
  void add(const FbxCurve* curve) {
    if (curve) curves_.insert(curve);
  }
  void add(std::int64_t tick) { others_.insert(tick); }
  void add(const KeyTicks& other) {
    curves_.insert(other.curves_.begin(), other.curves_.end());
    others_.insert(other.others_.begin(), other.others_.end());
  }

  // In no order.
  std::vector<std::int64_t> all() const {
    std::vector<std::int64_t> ticks(others_.begin(), others_.end());
    for (const FbxCurve* curve : curves_) {
      for (const FbxKey& key : curve->keys()) ticks.push_back(key.ticks);
    }
    return ticks;
  }

 private:
  std::set<const FbxCurve*> curves_;
  std::set<std::int64_t> others_;
};

// The keys within a clip, and its ends where it cuts a curve; of a constant one always its ends.
struct ClipRange {
  std::int64_t start = 0, stop = 0;
  bool isStill = false;

  std::vector<std::int64_t> keysOf(std::vector<std::int64_t> ticks) const {
    if (ticks.empty()) return ticks;
    sortUnique(ticks);
    const auto begin = std::lower_bound(ticks.begin(), ticks.end(), start),
               end = std::upper_bound(ticks.begin(), ticks.end(), stop);
    std::vector<std::int64_t> result(begin, end);
    const bool cutsBefore = begin != ticks.begin(), cutsBehind = end != ticks.end();
    if ((cutsBefore || isStill) && (result.empty() || result.front() != start)) result.insert(result.begin(), start);
    if ((cutsBehind || isStill) && (result.empty() || result.back() != stop)) result.push_back(stop);
    return result;
  }
};

// Writes the tracks of one clip into the document.
class ImportedClip {
 public:
  ImportedClip(Asset& asset, const std::string& name, ClipRange range, ClipBudget& budget)
      : asset_(asset), range_(range), budget_(budget) {
    animation_.name = name;
  }

  // `width`: how many numbers `at` gives.
  void addTrack(Index node, TrackPath path, std::size_t width, const KeyTicks& ticks, const RowAt& at) {
    const std::vector<std::int64_t> keys = range_.keysOf(ticks.all());
    if (keys.empty()) return;
    const std::size_t numbers = keys.size() * width;
    if (numbers > budget_.numbers) failShared(animation_.name);
    budget_.numbers -= numbers;
    const bool isRotation = path == TrackPath::kRotation;
    FbxTrack track = TrackSampler(at, static_cast<Eigen::Index>(width), isRotation, budget_).sample(keys);
    if (isRotation) keepNearSide(track);
    dropRepeated(track);
    setTimes(track, range_.start);
    // Two keys of one moment at 0 would begin before it.
    while (track.times.size() > 1 && track.times[0] < 0) {
      track.times.erase(track.times.begin());
      track.rows.erase(track.rows.begin());
    }
    std::vector<float> values;
    for (const Row& row : track.rows) {
      for (const double value : row) values.push_back(static_cast<float>(value));
    }
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) {
      asset_.warnings.add("invalid-keys", "animation keys that are not finite or not in order are left out");
      return;
    }
    const auto components = path == TrackPath::kWeights ? 1 : static_cast<Index>(width);
    constexpr std::array<const char*, 4> kPaths = {"translation", "rotation", "scale", "weights"};
    const Index output = addFloatAccessor(asset_, values, components);
    const Index sampler = addElement(animation_.samplers, {{}, inputOf(track.times), output, track.interpolation});
    animation_.channels.push_back({{}, sampler, {{}, node, kPaths[static_cast<std::size_t>(path)]}});
  }

  void finish() {
    if (animation_.channels.empty()) return;
    asset_.document.animations.push_back(std::move(animation_));
  }

 private:
  // Most tracks of a clip have the same times: they share one accessor.
  Index inputOf(const std::vector<float>& times) {
    const auto known = inputs_.find(times);
    if (known != inputs_.end()) return known->second;
    return inputs_[times] = addFloatAccessor(asset_, times, 1, 0, true);
  }

  Asset& asset_;
  ClipRange range_;
  ClipBudget& budget_;
  gltf::Animation animation_;
  std::map<std::vector<float>, Index> inputs_;
};

// A clip of numbers that stand still is a moment; one of curves that do lasts as long as its stack says.
ClipRange rangeOf(const FbxClipCurves& clip, Warnings& warnings) {
  std::set<const FbxCurve*> curves;
  for (const auto& [model, motion] : clip.motions) {
    for (const auto& ofKind : motion.curves) curves.insert(ofKind.begin(), ofKind.end());
  }
  for (const auto& [object, percent] : clip.percents) curves.insert(percent.curve);
  curves.erase(nullptr);
  std::vector<std::int64_t> ends;
  bool isStill = true;
  for (const FbxCurve* curve : curves) {
    ends.insert(ends.end(), {curve->keys().front().ticks, curve->keys().back().ticks});
    isStill = isStill && curve->isStill();
  }
  if (ends.empty()) return {clip.start.value_or(0), clip.start.value_or(0)};
  if (isStill && clip.start) return {*clip.start, *clip.stop, true};
  const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
  if (!clip.start || *clip.start > *last || *clip.stop < *first) return {*first, *last};
  if (*first < *clip.start || *last > *clip.stop) {
    warnings.add("trimmed-clips", "keys outside of their clip's time are cut off", clip.name);
  }
  return {*clip.start, std::min(*clip.stop, *last)};
}

// What the models and blend shapes of one clip show.
class ClipSampler {
 public:
  ClipSampler(const FbxModels& models, const FbxClipCurves& clip, std::int64_t start, double scale)
      : models_(models), clip_(clip), start_(start), scale_(scale) {}

  void addModel(Index m, Index node, ImportedClip& writer) const {
    const std::array<KeyTicks, 3> ticks = ticksOf(m);
    writer.addTrack(node, TrackPath::kTranslation, 3, ticks[0],
                    [&](std::int64_t at, bool fromLeft) { return Row(scale_ * localAt(m, at, fromLeft).translation); });
    writer.addTrack(node, TrackPath::kRotation, 4, ticks[1],
                    [&](std::int64_t at, bool fromLeft) { return Row(localAt(m, at, fromLeft).rotation.coeffs()); });
    writer.addTrack(node, TrackPath::kScale, 3, ticks[2],
                    [&](std::int64_t at, bool fromLeft) { return Row(localAt(m, at, fromLeft).scale); });
  }

  void addShapes(const FbxShapesInUse& use, ImportedClip& writer) const {
    const auto percentOf = [&](const FbxShapeChannel& channel) {
      const auto found = clip_.percents.find(channel.object);
      return found == clip_.percents.end() ? FbxPercent{nullptr, channel.percent} : found->second;
    };
    KeyTicks ticks;
    for (const FbxShapeChannel& channel : use.shapes->channels) {
      const FbxPercent percent = percentOf(channel);
      ticks.add(percent.curve);
      if (!percent.curve && differs(percent.still, channel.percent)) ticks.add(start_);
    }
    const std::size_t targets = use.shapes->targets.size();
    writer.addTrack(use.node, TrackPath::kWeights, targets, ticks, [&](std::int64_t at, bool fromLeft) {
      std::vector<double> weights(targets, 0);
      for (const FbxShapeChannel& channel : use.shapes->channels) {
        const FbxPercent percent = percentOf(channel);
        channel.addWeights(percent.curve ? percent.curve->at(at, fromLeft) : percent.still, weights);
      }
      return Row(Eigen::Map<const Row>(weights.data(), static_cast<Eigen::Index>(weights.size())));
    });
  }

 private:
  FbxPose poseAt(Index m, std::int64_t ticks, bool fromLeft) const {
    const auto motion = clip_.motions.find(m);
    return motion == clip_.motions.end() ? models_[m].transform.rest : motion->second.at(ticks, fromLeft);
  }

  Transform localAt(Index m, std::int64_t ticks, bool fromLeft) const {
    if (!models_[m].isCompensated) return models_[m].transform.localMirroredOnX(poseAt(m, ticks, fromLeft));
    return decompose(models_.localOf(m, [&](Index of) { return poseAt(of, ticks, fromLeft); }));
  }

  void addKeys(Index m, std::size_t kind, KeyTicks& ticks) const {
    const auto motion = clip_.motions.find(m);
    if (motion == clip_.motions.end() || !motion->second.moves[kind]) return;
    const std::array<const FbxCurve*, 3>& curves = motion->second.curves[kind];
    for (const FbxCurve* curve : curves) ticks.add(curve);
    const bool isStill = std::none_of(curves.begin(), curves.end(), [](const FbxCurve* curve) { return curve; });
    if (isStill) ticks.add(start_);
  }

  // The keys that count for translation, rotation and scale: those of its own curves, and of what else they depend on.
  std::array<KeyTicks, 3> ticksOf(Index m) const {
    std::array<KeyTicks, 3> ticks;
    if (models_[m].isCompensated) {
      for (const Index of : models_.chainOf(m)) {
        for (std::size_t kind = 0; kind < 3; ++kind) addKeys(of, kind, ticks[0]);
      }
      ticks[1] = ticks[2] = ticks[0];
      return ticks;
    }
    for (std::size_t kind = 0; kind < 3; ++kind) addKeys(m, kind, ticks[kind]);
    if (models_[m].transform.turnsAboutPivot()) {
      ticks[0].add(ticks[1]);
      ticks[0].add(ticks[2]);
    }
    return ticks;
  }

  const FbxModels& models_;
  const FbxClipCurves& clip_;
  std::int64_t start_;  // of the clip
  double scale_;
};

}  // namespace

FbxAnimations::FbxAnimations(const FbxObjects& objects, const FbxModels& models, Warnings& warnings)
    : objects_(objects),
      models_(models),
      warnings_(warnings),
      moves_(models.count(), false),
      scales_(models.count(), false) {
  for (Index o = 0; o < objects_.count(); ++o) {
    if (objects_.is(o, "AnimationStack")) readStack(o);
  }
}

void FbxAnimations::readStack(Index stack) {
  const std::vector<Index> layers = objects_.sources(stack, "AnimationLayer");
  if (layers.empty()) return;
  FbxClipCurves clip;
  clip.name = objects_[stack].name;
  const FbxProperties properties = objects_.properties(stack);
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::min();
  const std::int64_t start = properties.integer("LocalStart", kNone), stop = properties.integer("LocalStop", kNone);
  if (isFbxTime(start) && isFbxTime(stop) && start < stop) {
    clip.start = start;
    clip.stop = stop;
  }
  for (const Index node : objects_.sources(layers[0], "AnimationCurveNode")) readCurveNode(node, clip);
  for (std::size_t l = 1; l < layers.size(); ++l) {
    if (objects_.sources(layers[l], "AnimationCurveNode").empty()) continue;
    warnings_.add("animation-layers", "of layered clips only the first layer is kept", clip.name);
  }
  clips_.push_back(std::move(clip));
}

const FbxCurve* FbxAnimations::curveOf(Index node, std::string_view component) {
  for (const FbxObjects::Link& link : objects_.sources(node)) {
    if (link.property != component || !objects_.is(link.object, "AnimationCurve")) continue;
    const auto [known, isNew] = curves_.try_emplace(link.object);
    if (isNew) known->second = FbxCurve::read(*objects_[link.object].node, warnings_);
    return known->second ? &*known->second : nullptr;
  }
  return nullptr;
}

void FbxAnimations::countMoved(const FbxClipCurves& clip) {
  if (++moved_ > read_bounds::kFbxMoved.of(objects_.count())) failShared(clip.name);
}

void FbxAnimations::readCurveNode(Index node, FbxClipCurves& clip) {
  for (const FbxObjects::Link& link : objects_.destinations(node)) {
    if (objects_.is(link.object, "Deformer", "BlendShapeChannel") && link.property == "DeformPercent") {
      const FbxCurve* curve = curveOf(node, kPercent);
      const std::optional<double> still = objects_.properties(node).number(kPercent);
      if (!curve && !still) continue;
      if (clip.percents.emplace(link.object, FbxPercent{curve, still.value_or(0)}).second) countMoved(clip);
      continue;
    }
    if (link.property.empty()) continue;  // the layer
    const auto kind = static_cast<std::size_t>(std::find(kKinds.begin(), kKinds.end(), link.property) - kKinds.begin());
    const std::optional<Index> model = objects_.is(link.object, "Model") ? models_.modelOf(link.object) : std::nullopt;
    if (kind == kKinds.size() || !model) {
      if (!objects_.sources(node).empty()) {
        warnings_.add("animated-properties", "curves of what is neither a joint's place nor a blend shape are left out",
                      objects_[link.object].name + "." + std::string(link.property));
      }
      continue;
    }
    const FbxTransform& transform = models_[*model].transform;
    const auto [found, isNew] = clip.motions.try_emplace(*model, transform.rest);
    if (isNew) countMoved(clip);
    FbxMotion& motion = found->second;
    const Vec3 rest = FbxMotion(transform.rest).still[kind];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FbxCurve* curve = curveOf(node, kAxes[axis]);
      motion.curves[kind][axis] = curve;
      double& still = motion.still[kind][static_cast<int>(axis)];
      if (!curve) still = objects_.properties(node).number(kAxes[axis], still);
      motion.moves[kind] = motion.moves[kind] || curve || differs(still, rest[static_cast<int>(axis)]);
    }
    moves_[*model] = moves_[*model] || motion.moves[kind];
    for (std::size_t axis = 0; kind == 2 && axis < 3; ++axis) {
      const FbxCurve* curve = motion.curves[kind][axis];
      const double own = rest[static_cast<int>(axis)];
      const bool scales = curve ? std::any_of(curve->keys().begin(), curve->keys().end(),
                                              [&](const FbxKey& key) { return key.value != own; })
                                : differs(motion.still[kind][static_cast<int>(axis)], own);
      if (scales) scales_[*model] = true;
    }
  }
}

void FbxAnimations::addClips(Asset& asset, const std::vector<std::optional<Index>>& nodeOf,
                             const std::vector<FbxShapesInUse>& shapes, double scale) const {
  std::uint64_t keys = 0;
  for (const auto& [object, curve] : curves_) keys += curve ? curve->keys().size() : 0;
  ClipBudget budget = {static_cast<std::size_t>(read_bounds::kFbxAddedKeys.of(keys)),
                       static_cast<std::size_t>(read_bounds::kFbxClipNumbers.of(keys))};
  for (const FbxClipCurves& clip : clips_) {
    const ClipRange range = rangeOf(clip, asset.warnings);
    ImportedClip writer(asset, clip.name, range, budget);
    const ClipSampler sampler(models_, clip, range.start, scale);
    for (Index m = 0; m < models_.count(); ++m) {
      if (nodeOf[m]) sampler.addModel(m, *nodeOf[m], writer);
    }
    for (const FbxShapesInUse& use : shapes) sampler.addShapes(use, writer);
    writer.finish();
  }
  if (budget.moreKeys == 0) {
    asset.warnings.add("coarse-clips", "clips that would take too many keys are coarser than their curves");
  }
}

}  // namespace limber
