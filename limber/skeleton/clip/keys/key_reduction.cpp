#include "limber/skeleton/clip/keys/key_reduction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/sort_unique.h"
#include "limber/skeleton/clip/keys/key_choice.h"
#include "limber/skeleton/clip/keys/shared_times.h"
#include "limber/skeleton/clip/tracks.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

constexpr double kCurveRate = 60;             // lines a second that replace a curve
constexpr std::size_t kWindow = 512;          // frames of a stretch
constexpr int kRounds = 9;                    // of correcting the joints' factors
constexpr double kFirstFactor = 0.5;          // of the tolerance, for each joint alone
constexpr double kMargin = 0.98;              // of the tolerance: what is between the frames has the rest
constexpr double kShortStep = 32767;          // 16-bit fractions of 1
constexpr double kLargestShortTurn = 6.2e-5;  // radians: rounding four numbers to these
constexpr double kStillFraction = 0.1;        // likewise: what a value may leave to be one key
constexpr double kShortFraction = 0.25;       // of the tolerance
constexpr double kMin = 1e-12;

enum class Part { kTranslation, kRotation, kScale };

// Keys of a track: frames, ascending, and the values there, of one kind.
struct TrackKeys {
  std::vector<Index> frames;
  std::vector<Quat> turns;
  std::vector<Vec3> vectors;

  // Without the first, which is the last one here.
  void append(const TrackKeys& next) {
    frames.insert(frames.end(), next.frames.begin() + 1, next.frames.end());
    if (!next.turns.empty()) turns.insert(turns.end(), next.turns.begin() + 1, next.turns.end());
    if (!next.vectors.empty()) vectors.insert(vectors.end(), next.vectors.begin() + 1, next.vectors.end());
  }
};

// A track's values at all frames, and the keys that suffice.
struct DenseTrack {
  Index joint = 0;
  Part part = Part::kRotation;
  bool cubic = false;
  std::optional<TrackKeys> still;  // the one key of a track that needs no more
  std::size_t keysBefore = 0, trackNumber = 0;
  std::vector<Quat> turns;     // #F of rotations
  std::vector<Vec3> vectors;   // #F of translations and scales
  std::vector<Index> ownKeys;  // the frames at which the clip has keys of it
  TrackKeys kept;
  double errorPerUnit = 1;  // how far the farthest carried point moves for an error of 1
};

Quat storedTurn(const Quat& turn, bool shortRotations) {
  if (!shortRotations) return turn.cast<float>().cast<double>();
  Quat result;
  for (int i = 0; i < 4; ++i) result.coeffs()[i] = std::round(turn.coeffs()[i] * kShortStep) / kShortStep;
  return result;
}

// Where a joint's farthest carried point is, at or below it, in rest pose.
std::vector<double> reaches(const Skeleton& skeleton, const CarriedPoints& carried) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<double> result(skeleton.jointCount(), 0);
  for (Index c = 0; c < skeleton.jointCount(); ++c) {
    for (const Vec3& point : carried.of[c]) {
      const Vec3 position = globals[c] * point;
      for (std::optional<Index> j = c; j; j = skeleton.joints[*j].parent) {
        result[*j] = std::max(result[*j], (position - globals[*j].translation()).norm());
      }
    }
  }
  return result;
}

double largestStretch(const Affine& frame) {
  return std::sqrt(frame.linear().colwise().squaredNorm().maxCoeff());
}

// A curve as lines.
template <typename Value>
Track<Value> straightened(const Track<Value>& track) {
  if (track.interpolation != Interpolation::kCubic) return track;
  Track<Value> result;
  result.joint = track.joint;
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    if (k > 0) {
      const double from = track.times[k - 1], span = track.times[k] - from, steps = std::ceil(span * kCurveRate);
      for (double i = 1; i < steps; ++i) {
        const auto time = static_cast<float>(from + span * i / steps);
        if (time > result.times.back() && time < track.times[k]) result.times.push_back(time);
      }
    }
    result.times.push_back(track.times[k]);
  }
  for (const float time : result.times) {
    result.values.push_back(Value(sampleTrack(track, time).template cast<float>()));
  }
  return result;
}

template <typename Value>
bool isSteady(const Track<Value>& track) {
  return track.times.size() < 2 || isConstant(track);
}

template <typename Value>
Track<Value> withoutRepeats(const Track<Value>& track) {
  Track<Value> result;
  result.joint = track.joint;
  result.interpolation = track.interpolation;
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    const bool last = k + 1 == track.times.size();
    if (k > 0 && !last && track.values[k].isApprox(result.values.back(), 0)) continue;
    result.times.push_back(track.times[k]);
    result.values.push_back(track.values[k]);
  }
  return result;
}

class KeyReducer {
 public:
  KeyReducer(const Skeleton& skeleton, const Clip& clip, const CarriedPoints& carried,
             const KeyReductionOptions& options)
      : skeleton_(skeleton), clip_(clip), carried_(carried), options_(options) {
    reach_ = reaches(skeleton, carried);
    const double farthest = reach_.empty() ? 0 : *std::max_element(reach_.begin(), reach_.end());
    short_ = options.shortRotations && kLargestShortTurn * farthest <= kShortFraction * options.tolerance;
    findFrames();
    readTracks();
  }

  ReducedClip run() {
    ReducedClip result;
    for (const double part : {1.0, 0.95, 0.85, 0.6, 0.3}) {
      target_ = kMargin * part * options_.tolerance;
      chooseAll();
      alignKeys();
      result.clip = written();
      result.largestError = measured(result.clip);
      if (result.largestError <= options_.tolerance) break;
    }
    if (!(result.largestError <= options_.tolerance)) {  // as with a tolerance below what single precision can say
      result.clip = clip_;
      result.largestError = 0;
    }
    result.keysBefore = keysOf(clip_);
    result.keysAfter = keysOf(result.clip);
    return result;
  }

 private:
  // --- the clip as frames ---

  void findFrames() {
    std::vector<float> times;
    forEachTrack(clip_, [&](const auto& track) {
      if (isSteady(track)) return;
      const auto lines = straightened(track);
      times.insert(times.end(), lines.times.begin(), lines.times.end());
    });
    sortUnique(times);
    times_.assign(times.begin(), times.end());
  }

  void readTracks() {
    const std::vector<Affine> globals = restGlobals(skeleton_);
    const auto add = [&](const auto& tracks, Part part) {
      for (std::size_t t = 0; t < tracks.size(); ++t) {
        const auto& track = tracks[t];
        const bool steps = track.interpolation == Interpolation::kStep;
        hasSteps_ = hasSteps_ || steps;
        if (isSteady(track) || steps) continue;
        DenseTrack dense;
        dense.joint = track.joint;
        dense.part = part;
        dense.cubic = track.interpolation == Interpolation::kCubic;
        dense.keysBefore = track.times.size();
        dense.trackNumber = t;
        const std::optional<Index> parent = skeleton_.joints[track.joint].parent;
        dense.errorPerUnit =
            part == Part::kTranslation ? (parent ? largestStretch(globals[*parent]) : 1) : reach_[track.joint];
        fill(straightened(track), dense);
        findStill(dense);
        tracks_.push_back(std::move(dense));
      }
    };
    add(clip_.translations, Part::kTranslation);
    add(clip_.rotations, Part::kRotation);
    add(clip_.scales, Part::kScale);
  }

  template <typename Value>
  void fill(const Track<Value>& lines, DenseTrack& dense) const {
    std::size_t key = 0;
    for (Index f = 0; f < times_.size(); ++f) {
      while (key < lines.times.size() && lines.times[key] < times_[f]) ++key;
      if (key < lines.times.size() && lines.times[key] == times_[f]) dense.ownKeys.push_back(f);
      if constexpr (std::is_same_v<Value, Vec3f>) {
        dense.vectors.push_back(sampleTrack(lines, times_[f]));
      } else {
        Quat turn = sampleTrack(lines, times_[f]);
        if (!dense.turns.empty() && turn.dot(dense.turns.back()) < 0) turn.coeffs() *= -1;
        dense.turns.push_back(turn);
      }
    }
  }

  void findStill(DenseTrack& dense) const {
    const double most = kStillFraction * options_.tolerance / std::max(dense.errorPerUnit, kMin);
    const Transform& rest = skeleton_.joints[dense.joint].rest;
    if (dense.part == Part::kRotation) {
      for (const Quat& value : {rest.rotation, dense.turns[dense.turns.size() / 2]}) {
        const Quat turn = value.cast<float>().cast<double>();
        const auto isNear = [&](const Quat& other) { return turn.angularDistance(other) <= most; };
        if (!dense.still && std::all_of(dense.turns.begin(), dense.turns.end(), isNear)) {
          dense.still = TrackKeys{{0}, {turn}, {}};
        }
      }
      return;
    }
    const Vec3 resting = dense.part == Part::kScale ? rest.scale : rest.translation;
    for (const Vec3& value : {resting, dense.vectors[dense.vectors.size() / 2]}) {
      const Vec3 vector = value.cast<float>().cast<double>();
      const auto isNear = [&](const Vec3& other) { return (other - vector).norm() <= most; };
      if (!dense.still && std::all_of(dense.vectors.begin(), dense.vectors.end(), isNear)) {
        dense.still = TrackKeys{{0}, {}, {vector}};
      }
    }
  }

  // --- which keys stay ---

  void chooseAll() {
    const std::size_t windows = times_.size() < 2 ? 0 : (times_.size() - 2) / kWindow + 1;
    std::vector<std::vector<TrackKeys>> chosen(windows);
    parallelFor(windows, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t w = begin; w < end; ++w) {
        const std::size_t first = w * kWindow;
        chosen[w] = chooseIn(first, std::min(first + kWindow + 1, times_.size()));
      }
    });
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      tracks_[t].kept = chosen[0][t];
      for (std::size_t w = 1; w < windows; ++w) tracks_[t].kept.append(chosen[w][t]);
    }
  }

  // For each track keys from `first` to before `end`, both ends among them.
  std::vector<TrackKeys> chooseIn(std::size_t first, std::size_t end) const {
    const std::vector<std::vector<Affine>> wanted = globalsOfClip(first, end);
    std::vector<double> factor(skeleton_.jointCount(), kFirstFactor);
    std::vector<TrackKeys> best, now(tracks_.size());
    std::size_t fewest = 0;
    const auto bytes = [&] {
      std::size_t sum = 0;
      for (std::size_t t = 0; t < tracks_.size(); ++t) sum += now[t].frames.size() * (4 + bytesPerKey(tracks_[t]));
      return sum;
    };
    for (int round = 0; round < kRounds || (best.empty() && round < 2 * kRounds); ++round) {
      for (std::size_t t = 0; t < tracks_.size(); ++t) {
        now[t] = chooseTrack(tracks_[t], first, end, factor[tracks_[t].joint] * target_);
      }
      const std::vector<double> off = errorsBelow(first, end, now, wanted);
      const double worst = off.empty() ? 0 : *std::max_element(off.begin(), off.end());
      if (worst <= target_ && (best.empty() || bytes() < fewest)) {
        best = now;
        fewest = bytes();
      }
      // Late rounds go for what is valid; the first for what is good.
      const double aim = round + 1 < kRounds ? target_ : 0.9 * target_;
      for (Index j = 0; j < skeleton_.jointCount(); ++j) {
        factor[j] *= std::clamp(std::pow(aim / std::max(off[j], kMin), 0.8), 0.4, 1.6);
      }
    }
    if (!best.empty()) return best;
    for (std::size_t t = 0; t < tracks_.size(); ++t) now[t] = chooseTrack(tracks_[t], first, end, 0);
    return now;
  }

  TrackKeys chooseTrack(const DenseTrack& track, std::size_t first, std::size_t end, double tolerance) const {
    if (track.still) return *track.still;
    const std::span<const double> times(times_.data() + first, end - first);
    const double unit = tolerance / std::max(track.errorPerUnit, kMin);
    TrackKeys keys;
    if (track.part == Part::kRotation) {
      const std::span<const Quat> turns(track.turns.data() + first, end - first);
      keys.frames = fewest(track, first, chooseKeys(times, turns, unit));
      keys.turns = fitKeys(times, turns, keys.frames);
      for (Quat& turn : keys.turns) turn = storedTurn(turn, short_);
    } else {
      const std::span<const Vec3> vectors(track.vectors.data() + first, end - first);
      keys.frames = fewest(track, first, chooseKeys(times, vectors, unit));
      keys.vectors = fitKeys(times, vectors, keys.frames);
    }
    for (Index& frame : keys.frames) frame += static_cast<Index>(first);
    return keys;
  }

  // Those chosen or, where they are fewer, those that the clip has; frames count from `first`.
  static std::vector<Index> fewest(const DenseTrack& track, std::size_t first, std::vector<Index> chosen) {
    const auto start = static_cast<Index>(first);
    const auto from = std::upper_bound(track.ownKeys.begin(), track.ownKeys.end(), start);
    const auto to = std::lower_bound(from, track.ownKeys.end(), start + chosen.back());
    if (static_cast<std::size_t>(to - from) + 2 >= chosen.size()) return chosen;
    std::vector<Index> own = {0};
    for (auto key = from; key != to; ++key) own.push_back(*key - start);
    own.push_back(chosen.back());
    return own;
  }

  void alignKeys() {
    std::vector<KeyFrames> wanted;
    for (const DenseTrack& track : tracks_) {
      if (!track.still) wanted.push_back({track.kept.frames, bytesPerKey(track)});
    }
    const std::vector<std::vector<Index>> shared = alignKeyFrames(wanted, static_cast<Index>(times_.size()));
    shared_.clear();
    std::size_t next = 0;
    for (const DenseTrack& track : tracks_) shared_.push_back(track.still ? track.kept.frames : shared[next++]);
  }

  std::size_t bytesPerKey(const DenseTrack& track) const {
    return track.part == Part::kRotation ? (short_ ? 8 : 16) : 12;
  }

  // --- what that moves ---

  // [frame][joint] as the clip has them.
  std::vector<std::vector<Affine>> globalsOfClip(std::size_t first, std::size_t end) const {
    std::vector<std::vector<Affine>> result;
    Pose pose = restPose(skeleton_);
    for (std::size_t f = first; f < end; ++f) {
      sampleClip(clip_, times_[f], pose);
      result.push_back(poseGlobals(skeleton_, pose));
    }
    return result;
  }

  // #J: how far the carried points of the joint and of those below it are off at most.
  std::vector<double> errorsBelow(std::size_t first, std::size_t end, const std::vector<TrackKeys>& kept,
                                  const std::vector<std::vector<Affine>>& wanted) const {
    std::vector<double> off(skeleton_.jointCount(), 0);
    std::vector<std::size_t> key(tracks_.size(), 0);
    Pose pose = restPose(skeleton_);
    std::vector<Affine> globals(skeleton_.jointCount());
    for (std::size_t f = first; f < end; ++f) {
      if (f == first || hasSteps_) sampleClip(clip_, times_[f], pose);
      for (std::size_t t = 0; t < tracks_.size(); ++t) {
        while (key[t] + 1 < kept[t].frames.size() && kept[t].frames[key[t] + 1] <= f) ++key[t];
        put(tracks_[t], kept[t], key[t], static_cast<Index>(f), pose.locals[tracks_[t].joint]);
      }
      globalTransforms(skeleton_, pose.locals, globals);
      addErrors(globals, wanted[f - first], off);
    }
    for (double& length : off) length = std::sqrt(length);
    for (Index j = skeleton_.jointCount(); j-- > 0;) {
      if (const std::optional<Index> parent = skeleton_.joints[j].parent) off[*parent] = std::max(off[*parent], off[j]);
    }
    return off;
  }

  // Squares.
  void addErrors(const std::vector<Affine>& globals, const std::vector<Affine>& wanted,
                 std::vector<double>& off) const {
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const Mat3 linear = globals[j].linear() - wanted[j].linear();
      const Vec3 moved = globals[j].translation() - wanted[j].translation();
      for (const Vec3& point : carried_.of[j]) off[j] = std::max(off[j], (linear * point + moved).squaredNorm());
    }
  }

  // `key` is the last at or before the frame.
  void put(const DenseTrack& track, const TrackKeys& keys, std::size_t key, Index frame, Transform& local) const {
    if (track.part == Part::kRotation) {
      local.rotation = turnAt(keys, key, frame);
    } else {
      (track.part == Part::kScale ? local.scale : local.translation) = vectorAt(keys, key, frame);
    }
  }

  double along(const TrackKeys& keys, std::size_t key, Index frame) const {
    const Index a = keys.frames[key], b = keys.frames[key + 1];
    return (times_[frame] - times_[a]) / (times_[b] - times_[a]);
  }
  Quat turnAt(const TrackKeys& keys, std::size_t key, Index frame) const {
    if (keys.frames[key] == frame || key + 1 == keys.frames.size()) return keys.turns[key].normalized();
    return keys.turns[key].normalized().slerp(along(keys, key, frame), keys.turns[key + 1].normalized());
  }
  Vec3 vectorAt(const TrackKeys& keys, std::size_t key, Index frame) const {
    if (keys.frames[key] == frame || key + 1 == keys.frames.size()) return keys.vectors[key];
    return keys.vectors[key] + along(keys, key, frame) * (keys.vectors[key + 1] - keys.vectors[key]);
  }

  // --- the result ---

  Clip written() const {
    Clip result;
    result.name = clip_.name;
    const auto keep = [&](const auto& from, auto& to) {
      for (const auto& track : from) {
        if (isSteady(track)) {
          auto& steady = to.emplace_back(track);
          if (steady.interpolation == Interpolation::kCubic) steady.values = {steady.values[1]};
          steady.interpolation = Interpolation::kLinear;
          steady.times.resize(1);
          steady.values.resize(1, steady.values[0]);
        } else if (track.interpolation == Interpolation::kStep) {
          to.push_back(withoutRepeats(track));
        }
      }
    };
    keep(clip_.translations, result.translations);
    keep(clip_.rotations, result.rotations);
    keep(clip_.scales, result.scales);
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const DenseTrack& track = tracks_[t];
      if (track.part == Part::kRotation) {
        add(track, clip_.rotations, result.rotations, shared_[t], [&](std::size_t key, Index frame) {
          const bool isKey = track.kept.frames[key] == frame;
          return Eigen::Quaternionf(
              (isKey ? track.kept.turns[key] : storedTurn(turnAt(track.kept, key, frame), short_)).cast<float>());
        });
      } else {
        const bool scale = track.part == Part::kScale;
        add(track, scale ? clip_.scales : clip_.translations, scale ? result.scales : result.translations, shared_[t],
            [&](std::size_t key, Index frame) { return Vec3f(vectorAt(track.kept, key, frame).cast<float>()); });
      }
    }
    const auto byJoint = [](const auto& a, const auto& b) { return a.joint < b.joint; };
    forEachKind(result, [&](auto& tracks) { std::sort(tracks.begin(), tracks.end(), byJoint); });
    keepDuration(result);
    return result;
  }

  template <typename Value, typename At>
  void add(const DenseTrack& track, const std::vector<Track<Value>>& from, std::vector<Track<Value>>& to,
           const std::vector<Index>& frames, const At& at) const {
    const std::size_t perKey = bytesPerKey(track);
    const std::size_t cubicBytes = track.keysBefore * (4 + 3 * (track.part == Part::kRotation ? 16 : 12));
    if (track.cubic && !track.still && cubicBytes <= frames.size() * (4 + perKey)) {
      to.push_back(from[track.trackNumber]);
      return;
    }
    Track<Value>& result = to.emplace_back();
    result.joint = track.joint;
    std::size_t key = 0;
    for (const Index frame : frames) {
      while (key + 1 < track.kept.frames.size() && track.kept.frames[key + 1] <= frame) ++key;
      result.times.push_back(static_cast<float>(times_[frame]));
      result.values.push_back(at(key, frame));
    }
  }

  // A clip that is still at its end lasts as long as it did.
  void keepDuration(Clip& result) const {
    if (result.duration() == clip_.duration()) return;
    const auto extend = [&](const auto& from, auto& to) {
      for (const auto& track : from) {
        if (track.times.back() != static_cast<float>(clip_.duration())) continue;
        for (auto& kept : to) {
          if (kept.joint != track.joint || kept.interpolation == Interpolation::kCubic) continue;
          if (result.duration() == clip_.duration()) return;
          kept.times.push_back(track.times.back());
          kept.values.push_back(kept.values.back());
        }
      }
    };
    extend(clip_.translations, result.translations);
    extend(clip_.rotations, result.rotations);
    extend(clip_.scales, result.scales);
  }

  double measured(const Clip& result) const {
    std::vector<double> off(skeleton_.jointCount(), 0);
    Pose wanted = restPose(skeleton_), pose = wanted;
    for (const double time : times_) {
      sampleClip(clip_, time, wanted);
      sampleClip(result, time, pose);
      addErrors(poseGlobals(skeleton_, pose), poseGlobals(skeleton_, wanted), off);
    }
    return off.empty() ? 0 : std::sqrt(*std::max_element(off.begin(), off.end()));
  }

  static std::size_t keysOf(const Clip& clip) {
    std::size_t keys = 0;
    forEachTrack(clip, [&](const auto& track) { keys += track.times.size(); });
    return keys;
  }

  const Skeleton& skeleton_;
  const Clip& clip_;
  const CarriedPoints& carried_;
  const KeyReductionOptions& options_;
  bool short_ = false, hasSteps_ = false;
  double target_ = 0;
  std::vector<double> reach_;  // #J
  std::vector<double> times_;  // #F, of the frames
  std::vector<DenseTrack> tracks_;
  std::vector<std::vector<Index>> shared_;  // of each track: frames that it is written with
};

}  // namespace

ReducedClip reduceKeys(const Skeleton& skeleton, const Clip& clip, const CarriedPoints& carried,
                       const KeyReductionOptions& options) {
  if (!(options.tolerance > 0) || !std::isfinite(options.tolerance)) {
    throw Error(ErrorCode::kBadArgument, "the tolerance must be a length above 0");
  }
  if (carried.of.size() != skeleton.joints.size()) {
    throw Error(ErrorCode::kBadArgument, "the carried points are of another skeleton");
  }
  return KeyReducer(skeleton, clip, carried, options).run();
}

}  // namespace limber
