#include "limber/document/smpl/smpl_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/document/bvh/bvh_axes.h"
#include "limber/document/smpl/smpl_arrays.h"
#include "limber/document/smpl/smpl_skeleton.h"
#include "limber/document/stored_archive.h"

namespace limber {

namespace {

constexpr std::size_t kMaxSmplFrames = std::size_t{1} << 22;  // their times still differ in single precision
constexpr std::size_t kMaxNumbersOfFrame = 3 * 55;
constexpr double kUsualBodyRate = 30;  // frames a second
constexpr double kLowestRate = 1e-6, kHighestRate = 1e6;
constexpr double kLargestNumber = 1e30;  // leaves single precision room for products
constexpr std::size_t kHandJoints = 15, kFaceJoints = 3;

using ArrayNames = std::initializer_list<const char*>;

// An array as rows of numbers, whatever axes the row has; an array of one axis is one row.
struct SmplRows {
  std::string name;
  std::size_t count = 0, width = 0;
  std::vector<double> values;
};

SmplRows rowsOf(NpyArray array, std::string name) {
  SmplRows rows{std::move(name), 1, 0, std::move(array.values)};
  if (array.shape.size() > 1) rows.count = array.shape[0];
  if (rows.count > 0) rows.width = rows.values.size() / rows.count;
  return rows;
}

// Before the numbers are unpacked, which take up to eight times the bytes of the file's.
void checkLimit(const NpzFiles& arrays, const std::string& name) {
  const auto found = arrays.find(name + ".npy");
  if (found == arrays.end()) return;
  const std::vector<std::size_t> shape = readNpyShape(found->second, found->first);
  std::size_t room = shape.size() > 1 && shape[0] > kMaxSmplFrames ? 0 : kMaxSmplFrames * kMaxNumbersOfFrame;
  for (const std::size_t length : shape) room /= std::max<std::size_t>(length, 1);
  if (room == 0) throw Error(ErrorCode::kLimit, fmt::format("has more than {} frames", kMaxSmplFrames), found->first);
}

// The first of these that there is.
std::optional<SmplRows> findRows(const NpzFiles& arrays, ArrayNames names) {
  for (const char* name : names) {
    checkLimit(arrays, name);
    if (std::optional<NpyArray> array = npzArray(arrays, name)) return rowsOf(std::move(*array), name);
  }
  return std::nullopt;
}

// The number in the first of these that there is.
std::optional<double> findNumber(const NpzFiles& arrays, ArrayNames names) {
  const std::optional<SmplRows> rows = findRows(arrays, names);
  if (!rows || rows->values.empty()) return std::nullopt;
  return rows->values.front();
}

void checkFrames(const SmplRows& rows, std::size_t frames) {
  if (rows.count == frames || rows.count == 1) return;
  refuseSmplArray(rows.name, fmt::format("has {} rows for {} frames", rows.count, frames));
}

// Rotations of joints that follow each other, out of one array.
struct SmplPart {
  std::size_t joint = 0;  // the first
  SmplRows rows;          // one for each frame, or one for all
};

// What the arrays hold, as they hold it; other joints do not turn.
struct SmplPoses {
  std::size_t frames = 0, joints = 0;
  std::vector<SmplPart> parts;

  // Three numbers for each joint: an axis times an angle, radians.
  void copyFrame(std::size_t frame, std::vector<double>& row) const {
    row.assign(3 * joints, 0.0);
    for (const auto& [joint, rows] : parts) {
      const std::size_t from = (rows.count == 1 ? 0 : frame) * rows.width;
      std::copy_n(rows.values.data() + from, rows.width, row.data() + 3 * joint);
    }
  }
};

SmplPoses wholePoses(SmplRows rows) {
  const std::size_t joints = rows.width / 3;
  if (rows.count == 0) refuseSmplArray(rows.name, "holds no frame");
  if (rows.width % 3 != 0 || !isSmplJointCount(joints)) {
    refuseSmplArray(rows.name,
                    fmt::format("has rows of {} numbers, not three for each of 22, 24, 52 or 55 joints", rows.width));
  }
  SmplPoses poses{rows.count, joints, {}};
  poses.parts.push_back({0, std::move(rows)});
  return poses;
}

// What is there of the separate arrays, and how many joints they are of.
class SmplParts {
 public:
  SmplParts(const NpzFiles& arrays, Warnings& warnings) : arrays_(arrays), warnings_(warnings) {
    std::optional<SmplRows> root = findRows(arrays, {"root_orient", "global_orient"});
    std::optional<SmplRows> body = findRows(arrays, {"pose_body", "body_pose"});
    if (!root && !body) {
      throw Error(ErrorCode::kBadData, "holds no motion: neither 'poses' nor 'pose_body' or 'root_orient'", {},
                  arrays.count("v_template.npy") > 0 ? "it is a body; name it by --body" : "");
    }
    const bool face = any({"pose_jaw", "jaw_pose", "pose_eye", "leye_pose", "reye_pose"});
    const bool hands = any({"pose_hand", "left_hand_pose", "right_hand_pose"});
    const bool fists = body && body->width == 3 * 23 && !face && !hands;
    joints_ = face ? 55 : hands ? 52 : fists ? 24 : kSmplBodyJoints;
    if (root) add(0, 1, std::move(*root));
    if (body) add(1, fists ? 23 : kSmplBodyJoints - 1, std::move(*body));
    if (face) addFace();
    if (hands) addHands(kSmplBodyJoints + (face ? kFaceJoints : 0));
  }

  SmplPoses take() {
    SmplPoses poses{0, joints_, std::move(parts_)};
    for (const SmplPart& part : poses.parts) poses.frames = std::max(poses.frames, part.rows.count);
    for (const SmplPart& part : poses.parts) checkFrames(part.rows, poses.frames);
    return poses;
  }

 private:
  bool any(ArrayNames names) const {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return arrays_.count(std::string(name) + ".npy") > 0; });
  }

  void add(std::size_t joint, std::size_t count, SmplRows rows) {
    if (rows.count == 0) refuseSmplArray(rows.name, "holds no frame");
    if (rows.width != 3 * count) {
      refuseSmplArray(rows.name, fmt::format("has rows of {} numbers, not of {}", rows.width, 3 * count));
    }
    parts_.push_back({joint, std::move(rows)});
  }

  void addFound(std::size_t joint, std::size_t count, ArrayNames names) {
    if (std::optional<SmplRows> rows = findRows(arrays_, names)) add(joint, count, std::move(*rows));
  }

  void addFace() {
    addFound(kSmplBodyJoints, 1, {"pose_jaw", "jaw_pose"});
    if (any({"pose_eye"})) return addFound(kSmplBodyJoints + 1, 2, {"pose_eye"});
    addFound(kSmplBodyJoints + 1, 1, {"leye_pose"});
    addFound(kSmplBodyJoints + 2, 1, {"reye_pose"});
  }

  void addHands(std::size_t joint) {
    if (any({"pose_hand"})) return addHand(joint, 2 * kHandJoints, "pose_hand");
    addHand(joint, kHandJoints, "left_hand_pose");
    addHand(joint + kHandJoints, kHandJoints, "right_hand_pose");
  }

  void addHand(std::size_t joint, std::size_t count, const char* name) {
    std::optional<SmplRows> rows = findRows(arrays_, {name});
    if (!rows) return;
    if (rows->width < 3 * count) {
      warnings_.add("hand-components", "hands as components of a model are left at rest", std::string(name) + ".npy");
    } else {
      add(joint, count, std::move(*rows));
    }
  }

  const NpzFiles& arrays_;
  Warnings& warnings_;
  std::size_t joints_ = 0;
  std::vector<SmplPart> parts_;
};

SmplPoses readPoses(const NpzFiles& arrays, Warnings& warnings) {
  std::optional<SmplRows> whole = findRows(arrays, {"poses", "pose", "fullpose", "full_pose"});
  SmplPoses poses = whole ? wholePoses(std::move(*whole)) : SmplParts(arrays, warnings).take();
  if (poses.frames > kMaxSmplFrames) {
    throw Error(ErrorCode::kLimit, fmt::format("has more than {} frames", kMaxSmplFrames));
  }
  return poses;
}

// Nothing where the pelvis stays.
std::optional<SmplRows> readTranslations(const NpzFiles& arrays, std::size_t frames) {
  std::optional<SmplRows> rows = findRows(arrays, {"trans", "transl"});
  if (!rows) return std::nullopt;
  if (rows->width != 3) refuseSmplArray(rows->name, fmt::format("has rows of {} numbers, not of 3", rows->width));
  checkFrames(*rows, frames);
  return rows;
}

double readRate(const NpzFiles& arrays, Warnings& warnings) {
  const std::optional<double> rate = findNumber(arrays, {"mocap_framerate", "mocap_frame_rate", "frame_rate", "fps"});
  if (rate && *rate >= kLowestRate && *rate <= kHighestRate) return *rate;
  warnings.add("frame-rate", rate ? fmt::format("frame rate of {:g} is replaced by 30 a second", *rate)
                                  : "frame rate is not told, and taken as 30 a second");
  return kUsualBodyRate;
}

void repairNumbers(SmplRows& rows, Warnings& warnings) {
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    if (std::abs(rows.values[i]) <= kLargestNumber) continue;
    rows.values[i] = i < rows.width ? 0 : rows.values[i - rows.width];
    warnings.add("bad-numbers", "numbers are not finite or too large, and those of the frame before stand in",
                 fmt::format("{}.npy: row {}", rows.name, i / rows.width));
  }
}

Skeleton skeletonFor(std::size_t joints, const NpzFiles& arrays, const NpzFiles* body) {
  if (!body) return smplSkeleton(joints);
  std::vector<double> betas;
  if (std::optional<SmplRows> rows = findRows(arrays, {"betas"}); rows && rows->count > 0) {
    betas.assign(rows->values.begin(), rows->values.begin() + static_cast<std::ptrdiff_t>(rows->width));
  }
  Skeleton shaped = smplSkeleton(*body, smplVertices(*body, betas));
  for (std::size_t j = 1; j < shaped.joints.size(); ++j) {
    if (!shaped.joints[j].parent) refuseSmplArray("kintree_table", fmt::format("joint {} has no parent", j));
  }
  if (shaped.jointCount() == joints) return shaped;
  if (!isSmplJointCount(shaped.jointCount())) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("moves {} joints, and the body has {}", joints, shaped.jointCount()));
  }
  Skeleton skeleton = smplSkeleton(joints);
  for (std::size_t j = 0; j < kSmplBodyJoints; ++j) {
    if (shaped.joints[j].parent != skeleton.joints[j].parent) {
      throw Error(ErrorCode::kBadData, fmt::format("the body's joint {} has another parent than SMPL's", j));
    }
    skeleton.joints[j].rest = shaped.joints[j].rest;
  }
  return skeleton;
}

Quat rotationOf(const double* axisAngle) {
  const Vec3 v(axisAngle[0], axisAngle[1], axisAngle[2]);
  const double angle = v.norm();
  constexpr double kHardly = 1e-12;  // radians: sin(a / 2) / a is then 1/2 to the last bit
  const double scale = angle > kHardly ? std::sin(angle / 2) / angle : 0.5;
  return Quat(std::cos(angle / 2), scale * v.x(), scale * v.y(), scale * v.z());
}

// A joint's rotations, one for each frame; one alone as long as they are the same.
class JointTurns {
 public:
  void add(const Quat& rotation, std::size_t frame) {
    Eigen::Quaternionf value = rotation.cast<float>();
    // q and -q are the same rotation, but interpolation to them takes different paths.
    if (frame > 0 && values_.back().coeffs().dot(value.coeffs()) < 0) value.coeffs() = -value.coeffs();
    if (frame > 0 && values_.size() == 1) {
      if (value.coeffs() == values_.front().coeffs()) return;
      values_.resize(frame, values_.front());
    }
    values_.push_back(value);
  }

  bool turns() const {
    return values_.size() > 1 || values_.front().coeffs() != Eigen::Quaternionf::Identity().coeffs();
  }

  Track<Eigen::Quaternionf> takeTrack(Index joint, std::span<const float> times) {
    const std::span<const float> own = times.first(values_.size());
    return {joint, Interpolation::kLinear, {own.begin(), own.end()}, std::move(values_)};
  }

 private:
  std::vector<Eigen::Quaternionf> values_;
};

// Collects frames, in the file's own axes until takeClip.
class SmplFrames {
 public:
  explicit SmplFrames(const Skeleton& skeleton)
      : skeleton_(skeleton), turned_(skeleton.jointCount()), positions_(turned_.size()), turns_(turned_.size()) {}

  void add(const std::vector<double>& axisAngles, const Vec3& pelvis) {
    for (std::size_t j = 0; j < turned_.size(); ++j) {
      const Quat rotation = rotationOf(axisAngles.data() + 3 * j);
      const Joint& joint = skeleton_.joints[j];
      turned_[j] = joint.parent ? turned_[*joint.parent] * rotation : rotation;
      positions_[j] =
          joint.parent ? positions_[*joint.parent] + turned_[*joint.parent] * joint.rest.translation : pelvis;
      lowest_ = lowest_.cwiseMin(positions_[j]);
      highest_ = highest_.cwiseMax(positions_[j]);
      if (joint.parent) turns_[j].add(rotation, roots_.size());
    }
    constexpr std::size_t kHead = 15, kLeftAnkle = 7, kRightAnkle = 8;
    const Vec3 upwards = positions_[kHead] - 0.5 * (positions_[kLeftAnkle] + positions_[kRightAnkle]);
    upwards_ += upwards;
    heads_.add(upwards);
    roots_.push_back({positions_[0], turned_[0]});
  }

  // One that is upside down along Y does not have Z up.
  UpAxis up() const { return upwards_.z() > std::abs(upwards_.y()) ? UpAxis::kZ : UpAxis::kY; }
  double lowest(UpAxis up) const {
    Vec3 low = lowest_, high = highest_;
    turnUpright(low, up);
    turnUpright(high, up);
    return std::min(low.y(), high.y());
  }

  const HeadDirections& heads() const { return heads_; }

  // Turned to Y up and raised by so many metres.
  Clip takeClip(UpAxis up, double raise, double framesPerSecond) {
    const Quat turn = uprightTurn(up);
    std::vector<float> times;
    Track<Vec3f> translations;
    Track<Eigen::Quaternionf> rotations;
    for (const auto& [position, rotation] : roots_) {
      times.push_back(static_cast<float>(static_cast<double>(times.size()) / framesPerSecond));
      translations.values.emplace_back((turn * position + Vec3(0, raise, 0)).cast<float>());
      Eigen::Quaternionf turned = (turn * rotation).cast<float>();
      if (times.size() > 1 && rotations.values.back().coeffs().dot(turned.coeffs()) < 0) {
        turned.coeffs() = -turned.coeffs();
      }
      rotations.values.push_back(turned);
    }
    translations.times = rotations.times = times;
    Clip clip;
    clip.translations.push_back(std::move(translations));
    clip.rotations.push_back(std::move(rotations));
    for (Index j = 1; j < turns_.size(); ++j) {
      if (turns_[j].turns()) clip.rotations.push_back(turns_[j].takeTrack(j, times));
    }
    return clip;
  }

 private:
  struct Root {
    Vec3 position;
    Quat rotation;
  };

  const Skeleton& skeleton_;
  std::vector<Quat> turned_;  // of the frame at hand, as places_
  std::vector<Vec3> positions_;
  std::vector<JointTurns> turns_;  // none of the pelvis
  std::vector<Root> roots_;
  Vec3 lowest_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 highest_ = Vec3::Constant(-std::numeric_limits<double>::infinity());
  HeadDirections heads_;
  Vec3 upwards_ = Vec3::Zero();  // from the ankles to the head, summed
};

double lowestAtRest(const Skeleton& skeleton) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Affine& joint : restGlobals(skeleton)) lowest = std::min(lowest, joint.translation().y());
  return lowest;
}

Motion motionOfArrays(const NpzFiles& arrays, std::string_view name, const SmplOptions& options) {
  Motion motion;
  motion.name = std::filesystem::path(std::string(name)).stem().string();
  SmplPoses poses = readPoses(arrays, motion.warnings);
  std::optional<SmplRows> translations = readTranslations(arrays, poses.frames);
  for (SmplPart& part : poses.parts) repairNumbers(part.rows, motion.warnings);
  if (translations) repairNumbers(*translations, motion.warnings);
  motion.framesPerSecond = readRate(arrays, motion.warnings);
  motion.skeleton = skeletonFor(poses.joints, arrays, options.body.get());

  SmplFrames frames(motion.skeleton);
  std::vector<double> row;
  for (std::size_t f = 0; f < poses.frames; ++f) {
    poses.copyFrame(f, row);
    // A body's pelvis rests where it is there, which trans is from; where that is nobody tells without one.
    Vec3 pelvis = Vec3::Zero();
    if (translations)
      std::copy_n(translations->values.data() + (translations->count == 1 ? 0 : 3 * f), 3, pelvis.data());
    if (options.body) pelvis += motion.skeleton.joints[0].rest.translation;
    frames.add(row, pelvis);
  }
  const UpAxis up = options.up.value_or(frames.up());
  if (up != UpAxis::kY) motion.warnings.add("converted-axes", convertedAxesMessage(up));
  if (frames.heads().isUpsideDown(up)) motion.warnings.add("upside-down", upsideDownMessage(up));
  const double raise = options.body ? 0 : lowestAtRest(motion.skeleton) - frames.lowest(up);
  motion.clips.push_back(frames.takeClip(up, raise, motion.framesPerSecond));
  motion.clips.back().name = motion.name;
  checkMotion(motion);
  return motion;
}

}  // namespace

Motion readSmplMotion(const NpzFiles& arrays, std::string_view name, const SmplOptions& options) {
  try {
    return motionOfArrays(arrays, name, options);
  } catch (const Error& error) {
    throwWithin(error, name);
  }
}

Motion readSmplMotion(ByteSpan npz, std::string_view name, const SmplOptions& options) {
  return readSmplMotion(readSmplArrays(npz, name), name, options);
}

bool looksLikeNpz(ByteSpan bytes) {
  constexpr std::size_t kLocalHeader = 30, kNameLength = 26;  // APPNOTE.TXT 6.3, 4.3.7
  if (bytes.size() < kLocalHeader || bytes[0] != 'P' || bytes[1] != 'K' || bytes[2] != 3 || bytes[3] != 4) return false;
  const std::size_t length = bytes[kNameLength] | std::size_t{bytes[kNameLength + 1]} << 8;
  if (bytes.size() < kLocalHeader + length) return false;
  return std::string_view(reinterpret_cast<const char*>(bytes.data()) + kLocalHeader, length).ends_with(".npy");
}

}  // namespace limber
