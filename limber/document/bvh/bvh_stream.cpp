#include "limber/document/bvh/bvh_stream.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/document/bvh/bvh_axes.h"
#include "limber/document/bvh/bvh_line.h"

namespace limber {

namespace {

constexpr std::size_t kLongestLine = 65536;  // bytes
constexpr std::size_t kMaxStreamedJoints = 1000;

}  // namespace

BvhStream::BvhStream() : turn_(Quat::Identity()) {}

void BvhStream::take(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    begun_ += text.substr(0, end);
    if (begun_.size() > kLongestLine) {
      throw Error(ErrorCode::kLimit, "is longer than 64 KiB", fmt::format("line {}", lines_ + 1));
    }
    if (end == text.npos) return;
    text.remove_prefix(end + 1);
    if (begun_.ends_with('\r')) begun_.pop_back();
    const std::string line = std::move(begun_);
    begun_.clear();
    ++lines_;
    takeLine(line);
  }
}

void BvhStream::takeLine(std::string_view text) {
  if (frames_) return takeRow(text);
  if (!hierarchy_.takeLine(text, lines_)) return begin();
  if (hierarchy_.joints().size() > kMaxStreamedJoints) {
    throw Error(ErrorCode::kLimit, fmt::format("has more than {} joints", kMaxStreamedJoints));
  }
}

void BvhStream::begin() {
  turn_ = isUprightAlongZ(hierarchy_.joints()) ? Quat(std::sqrt(0.5), -std::sqrt(0.5), 0, 0) : Quat::Identity();
  for (const BvhJoint& joint : hierarchy_.joints()) {
    Joint made;
    made.name = joint.name;
    made.parent = joint.parent;
    made.rest.translation = joint.offset;
    if (!joint.parent) {
      made.rest.translation = turn_ * joint.offset;
      made.rest.rotation = turn_;
    }
    skeleton_.joints.push_back(std::move(made));
  }
  frames_ = std::make_unique<BvhFrames>(hierarchy_.joints());
  values_.resize(hierarchy_.channelCount());
  pose_ = restPose(skeleton_);
}

void BvhStream::takeRow(std::string_view text) {
  BvhLine line(text, lines_), ahead = line;
  if (line.atEnd()) return;
  const std::string_view word = ahead.word();
  if (isWord(word, "frames") || isWord(word, "frame") || isWord(word, "frametime")) return;
  for (double& value : values_) value = line.finiteNumber();
  if (!line.atEnd()) throw line.error(fmt::format("has more than the {} numbers of a frame", values_.size()));
  frames_->addFrame(values_);
  const Clip clip = frames_->takeClip(1);
  // Parts of roots without a channel are as the hierarchy has them, not as the row before left them, turned.
  const std::vector<BvhJoint>& joints = hierarchy_.joints();
  for (Index j = 0; j < skeleton_.jointCount(); ++j) {
    if (joints[j].parent) continue;
    pose_.locals[j].translation = joints[j].offset;
    pose_.locals[j].rotation = Quat::Identity();
  }
  sampleClip(clip, 0, pose_);
  for (Index j = 0; j < skeleton_.jointCount(); ++j) {
    if (joints[j].parent) continue;
    pose_.locals[j].translation = turn_ * pose_.locals[j].translation;
    pose_.locals[j].rotation = turn_ * pose_.locals[j].rotation;
  }
  ++rows_;
}

}  // namespace limber
