#include "limber/document/bvh/bvh_read.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/document/bvh/bvh_axes.h"
#include "limber/document/bvh/bvh_frames.h"
#include "limber/document/bvh/bvh_hierarchy.h"
#include "limber/document/bvh/bvh_line.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr Index kMaxFrames = Index{1} << 22;  // their times still differ in single precision
constexpr double kUsualRate = 30;
constexpr double kShortestFrame = 1e-6, kLongestFrame = 1e6;  // seconds
constexpr const char* kCutFile = "the file is cut or damaged: export it again";

// Frames a second. Files write the time of a frame with six digits behind the point: what rounds to it is meant, a
// whole number of frames or, as in video, a thousand and first less.
double rateOf(double frameTime) {
  constexpr double kRounding = 0.5000001e-6, kVideo = 1000.0 / 1001;
  constexpr double kHighest = 250;  // frames a second; beyond it six digits say little
  const double rate = 1 / frameTime;
  for (const double meant : {std::round(rate), std::round(rate / kVideo) * kVideo}) {
    if (meant > 0 && meant <= kHighest && std::abs(1 / meant - frameTime) <= kRounding) return meant;
  }
  return rate;
}

// Cuts pieces of a file into lines: LF, CR LF or CR.
class LineSplitter {
 public:
  // Calls take(text, number) for each line that is complete.
  template <typename Take>
  void feed(ByteSpan piece, const Take& take) {
    const char* at = reinterpret_cast<const char*>(piece.data());
    const char* const end = at + piece.size();
    while (at != end) {
      if (afterReturn_ && *at == '\n') ++at;
      afterReturn_ = false;
      const char* const stop = std::find_if(at, end, [](char c) { return c == '\n' || c == '\r'; });
      const std::string_view text(at, static_cast<std::size_t>(stop - at));
      if (stop == end) {
        begun_ += text;
        return;
      }
      at = stop + 1;
      afterReturn_ = *stop == '\r';
      ++number_;
      if (begun_.empty()) {
        take(text, number_);
      } else {
        begun_ += text;
        take(std::string_view(begun_), number_);
        begun_.clear();
      }
    }
  }

  // The line that the file's end completes.
  template <typename Take>
  void finish(const Take& take) {
    ++number_;
    take(std::string_view(begun_), number_);
  }

 private:
  std::string begun_;
  std::size_t number_ = 0;
  bool afterReturn_ = false;
};

// Space and locals turned alike: rest pose and frames.
void turnAll(Motion& motion, UpAxis up) {
  for (Joint& joint : motion.skeleton.joints) turnUpright(joint.rest.translation, up);
  for (Clip& clip : motion.clips) {
    for (auto& track : clip.translations) {
      for (Vec3f& value : track.values) turnUpright(value, up);
    }
    for (auto& track : clip.rotations) {
      for (Eigen::Quaternionf& value : track.values) turnUpright(value.coeffs(), up);
    }
    if (up != UpAxis::kZ && up != UpAxis::kMinusZ) continue;
    for (auto& track : clip.scales) {
      for (Vec3f& value : track.values) std::swap(value.y(), value.z());
    }
  }
}

// The frames alone, by their roots.
void turnFrames(Motion& motion, const Quat& turn) {
  for (Clip& clip : motion.clips) {
    for (Index j = 0; j < motion.skeleton.jointCount(); ++j) {
      const Joint& joint = motion.skeleton.joints[j];
      if (joint.parent) continue;
      for (Vec3f& value : trackOf(clip.translations, j, Vec3f(joint.rest.translation.cast<float>())).values) {
        value = (turn * value.cast<double>()).cast<float>();
      }
      for (Eigen::Quaternionf& value :
           trackOf(clip.rotations, j, Eigen::Quaternionf(joint.rest.rotation.cast<float>())).values) {
        value = (turn * value.cast<double>()).cast<float>();
      }
    }
  }
}

class BvhReader {
 public:
  explicit BvhReader(const BvhOptions& options) : options_(options) {
    constexpr double kLargestUnit = 1e6;  // with the largest number of a file still in single precision
    if (!(options.metresPerUnit > 0 && options.metresPerUnit <= kLargestUnit)) {
      throw Error(ErrorCode::kBadArgument, fmt::format("a unit cannot be {:g} metres", options.metresPerUnit));
    }
  }

  void feed(ByteSpan piece) {
    lines_.feed(piece, [&](std::string_view text, std::size_t number) { takeLine(text, number); });
  }

  Motion finish(std::string_view name) {
    lines_.finish([&](std::string_view text, std::size_t number) { takeLine(text, number); });
    if (part_ == Part::kHierarchy) hierarchy_.finish(lastLine_);
    Motion motion;
    motion.name = std::filesystem::path(std::string(name)).stem().string();
    motion.framesPerSecond = framesPerSecond_;
    reportFrames();
    buildSkeleton(motion);
    if (frames_ && frames_->count() > 0) {
      if (frames_->positionsAreRelative()) {
        warnings_.add("relative-positions", "positions of joints below the root are added to their offsets");
      }
      motion.clips.push_back(frames_->takeClip(framesPerSecond_));
      motion.clips.back().name = motion.name;
    }
    convert(motion);
    motion.warnings.append(hierarchy_.warnings());
    motion.warnings.append(warnings_);
    return motion;
  }

 private:
  enum class Part { kHierarchy, kFrameCount, kFrameTime, kFrames, kBehind };

  void takeLine(std::string_view text, std::size_t number) {
    lastLine_ = number;
    if (part_ == Part::kHierarchy) {
      if (!hierarchy_.takeLine(text, number)) part_ = Part::kFrameCount;
      return;
    }
    BvhLine line(text, number);
    if (line.atEnd() || part_ == Part::kBehind) return;
    if (part_ == Part::kFrameCount) {
      takeFrameCount(line);
    } else if (part_ == Part::kFrameTime) {
      takeFrameTime(line);
    } else {
      takeFrame(line);
    }
    if (line.decimalComma()) {
      warnings_.add("decimal-commas", "lines have numbers with a comma for the point", where(number));
    }
  }

  static std::string where(std::size_t number) { return fmt::format("line {}", number); }

  void takeFrameCount(BvhLine& line) {
    const std::string_view word = line.word();
    if (!isWord(word, "frames")) throw line.error(fmt::format("\"Frames:\" is wanted, not \"{}\"", line.shown(word)));
    BvhLine behindColon = line;
    if (behindColon.word() == ":") line = behindColon;
    announced_ = line.number();
    if (!(*announced_ >= 0 && *announced_ < 1e15)) throw line.error("that is no number of frames", kCutFile);
    part_ = Part::kFrameTime;
  }

  void takeFrameTime(BvhLine& line) {
    const std::string_view frame = line.word(), time = isWord(frame, "frametime") ? "time" : line.word();
    if (!isWord(time, "time"))
      throw line.error(fmt::format("\"Frame Time:\" is wanted, not \"{}\"", line.shown(frame)));
    BvhLine behindColon = line;
    if (behindColon.word() == ":") line = behindColon;
    const double seconds = line.number();
    if (seconds >= kShortestFrame && seconds <= kLongestFrame) {
      framesPerSecond_ = rateOf(seconds);
    } else {
      warnings_.add("frame-time", fmt::format("frame time of {:g} s is replaced by 1/30 s", seconds),
                    where(line.lineNumber()));
    }
    frames_.emplace(hierarchy_.joints());
    values_.assign(hierarchy_.channelCount(), 0.0);
    part_ = Part::kFrames;
  }

  void takeFrame(BvhLine& line) {
    if (cutFrame_) throw Error(*cutFrame_);  // it was not the last
    BvhLine number = line;
    if (static_cast<double>(frames_->count()) >= *announced_ && !startsWithNumber(number)) {
      warnings_.add("trailing-text", "text behind the last frame is left out", where(line.lineNumber()));
      part_ = Part::kBehind;
      return;
    }
    row_.resize(values_.size());
    std::size_t count = 0;
    for (; !line.atEnd(); ++count) {
      const double value = line.number();
      if (count == row_.size()) throw line.error(fmt::format("has more than the {} numbers of a frame", count));
      row_[count] = value;
    }
    if (count < row_.size()) {
      cutFrame_ = line.error(fmt::format("has {} of the {} numbers of a frame", count, row_.size()), kCutFile);
      return;
    }
    repair(line.lineNumber());
    if (frames_->count() == kMaxFrames) {
      throw Error(ErrorCode::kLimit, fmt::format("has more than {} frames", kMaxFrames), where(line.lineNumber()));
    }
    frames_->addFrame(values_);
  }

  static bool startsWithNumber(BvhLine& line) {
    try {
      line.number();
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  // The row into `values_`; where it has no finite number, that of the frame before stays.
  void repair(std::size_t lineNumber) {
    constexpr double kLargest = 1e30;  // leaves single precision room for products
    std::size_t bad = 0;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (std::abs(row_[i]) <= kLargest) {
        values_[i] = row_[i];
      } else {
        ++bad;
      }
    }
    if (bad == 0) return;
    warnings_.add("bad-numbers", "numbers are not finite or too large, and those of the frame before stand in",
                  where(lineNumber), bad);
  }

  void reportFrames() {
    if (part_ == Part::kHierarchy || part_ == Part::kFrameCount || part_ == Part::kFrameTime) {
      warnings_.add("no-motion", "file has a skeleton only, its frames are missing", where(lastLine_));
      return;
    }
    if (cutFrame_) {
      warnings_.add("cut-frame", "last frame is cut and left out: it " + cutFrame_->message(), cutFrame_->where());
    }
    if (static_cast<double>(frames_->count()) != *announced_) {
      warnings_.add("frame-count",
                    fmt::format("file announces {:.0f} frames and holds {}", *announced_, frames_->count()));
    }
  }

  void buildSkeleton(Motion& motion) const {
    for (const BvhJoint& joint : hierarchy_.joints()) {
      Joint made;
      made.name = joint.name;
      made.parent = joint.parent;
      made.rest.translation = joint.offset;
      motion.skeleton.joints.push_back(std::move(made));
    }
  }

  void convert(Motion& motion) {
    const double unit = options_.metresPerUnit;
    for (Joint& joint : motion.skeleton.joints) joint.rest.translation *= unit;
    for (Clip& clip : motion.clips) {
      for (auto& track : clip.translations) {
        for (Vec3f& value : track.values) value = (unit * value.cast<double>()).cast<float>();
      }
    }
    turnToYUp(motion);
  }

  void turnToYUp(Motion& motion) {
    const std::vector<BvhJoint>& joints = hierarchy_.joints();
    const BvhEnds ends = findEnds(joints);
    const FramePostures postures = framePostures(motion, ends);
    UpAxis expected = UpAxis::kY, up = UpAxis::kY;
    if (options_.up) {
      expected = up = *options_.up;
    } else {
      if (isUprightAlongZ(joints)) expected = UpAxis::kZ;
      const FramesUp frames = headsLieAhead(joints, ends) ? FramesUp{expected, false} : upOfFrames(postures, expected);
      up = frames.axis;
      if (frames.ambiguous) warnOfAmbiguity(expected);
    }
    UpAxis restUp = up == UpAxis::kY ? expected : up;
    if (restsAlong(UpAxis::kY, joints, ends)) restUp = UpAxis::kY;
    if (options_.restUp) restUp = *options_.restUp;

    turnAll(motion, restUp);
    if (restUp != up) turnFrames(motion, uprightTurn(up) * uprightTurn(restUp).conjugate());
    warnOfTurns(up, restUp, expected);
    if (postures.heads.isUpsideDown(up)) warnings_.add("upside-down", upsideDownMessage(up));
  }

  void warnOfAmbiguity(UpAxis expected) {
    if (expected == UpAxis::kY) {
      warnings_.add(
          "maybe-z-up",
          "the body lies in all frames, or these have Z up: where it should stand, read the file with --up z");
    } else {
      warnings_.add(
          "maybe-y-up",
          "the body lies in all frames, or these have Y up: where it should stand, read the file with --up y");
    }
  }

  void warnOfTurns(UpAxis up, UpAxis restUp, UpAxis expected) {
    if (up == UpAxis::kY && restUp == UpAxis::kY) return;
    if (up == expected) {
      warnings_.add("converted-axes", convertedAxesMessage(up));
    } else if (up == UpAxis::kZ) {
      warnings_.add("converted-axes",
                    "frames with Z up are turned to Y up; where the body should lie, read the file with --up y");
    } else {
      warnings_.add("converted-axes",
                    "a rest pose with Z up is turned to Y up, as the frames are; where the body should lie, read the "
                    "file with --up z");
    }
  }

  BvhOptions options_;
  LineSplitter lines_;
  BvhHierarchy hierarchy_;
  std::optional<BvhFrames> frames_;
  Part part_ = Part::kHierarchy;
  std::optional<double> announced_;  // frames
  double framesPerSecond_ = kUsualRate;
  std::vector<double> row_, values_;  // #channels: as read; as used
  std::optional<Error> cutFrame_;
  std::size_t lastLine_ = 0;
  Warnings warnings_;
};

}  // namespace

Motion readBvh(const std::filesystem::path& path, const BvhOptions& options) {
  const std::string name = path == "-" ? "standard input" : path.filename().string();
  BvhReader reader(options);
  try {
    readFileInPieces(path, [&](ByteSpan piece) { reader.feed(piece); });
    return reader.finish(name);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kFile) throw;
    throw error.within(name);
  }
}

Motion readBvh(ByteSpan bytes, std::string_view name, const BvhOptions& options) {
  BvhReader reader(options);
  try {
    reader.feed(bytes);
    return reader.finish(name);
  } catch (const Error& error) {
    throw error.within(name);
  }
}

bool looksLikeBvh(ByteSpan bytes) {
  constexpr std::string_view kMark = "hierarchy";
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  return isWord(text.substr(0, kMark.size()), kMark);
}

}  // namespace limber
