#include "limber/document/bvh/bvh_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limber/document/bvh/bvh_line.h"
#include "limber/document/utf8.h"

namespace limber {

namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr double kMaxChannels = 1024;  // of one joint; files have 3 or 6, some 9

std::optional<BvhChannel> channelNamed(std::string_view word) {
  constexpr std::array<std::string_view, 3> kQuantities = {"position", "rotation", "scale"};
  if (word.empty()) return std::nullopt;
  const int axis = std::tolower(static_cast<unsigned char>(word.front())) - 'x';
  if (axis < 0 || axis > 2) return std::nullopt;
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    if (isWord(word.substr(1), kQuantities[q])) return BvhChannel{static_cast<BvhQuantity>(q), axis};
  }
  return std::nullopt;
}

}  // namespace

bool BvhHierarchy::takeLine(std::string_view text, std::size_t lineNumber) {
  if (lineNumber == 1 && text.substr(0, 3) == kByteOrderMark) text.remove_prefix(3);
  BvhLine line(text, lineNumber);
  while (!line.atEnd()) {
    const std::string_view word = line.word();
    if (!begun_) {
      if (!isWord(word, "hierarchy")) throw line.error("is no BVH: it does not begin with HIERARCHY");
      begun_ = true;
    } else if (isWord(word, "motion")) {
      finish(lineNumber);
      return false;
    } else {
      takeWord(word, line);
    }
    if (line.decimalComma()) {
      warnings_.add("decimal-commas", "lines have numbers with a comma for the point",
                    fmt::format("line {}", lineNumber));
    }
  }
  return true;
}

void BvhHierarchy::finish(std::size_t lineNumber) const {
  const BvhLine line({}, lineNumber);
  if (braceWanted_ || !open_.empty()) {
    const std::string& name = joints_[braceWanted_ ? joints_.size() - 1 : open_.back()].name;
    throw line.error(fmt::format("the hierarchy ends inside '{}': a closing brace is missing", BvhLine::shown(name)),
                     "the file is cut or damaged: export it again");
  }
  if (joints_.empty()) throw line.error("the file has no joint");
}

void BvhHierarchy::addJoint(std::string name, bool endSite, std::size_t lineNumber) {
  BvhJoint joint;
  if (!open_.empty()) joint.parent = open_.back();
  joint.endSite = endSite;
  if (name.empty()) name = fmt::format("joint_{}", joints_.size());
  joint.name = names_.add(name);
  if (!endSite && joint.name != name) {
    warnings_.add("duplicate-names", "joints have a name that another has, and got a number behind it",
                  fmt::format("line {}", lineNumber));
  }
  joints_.push_back(std::move(joint));
  braceWanted_ = true;
  offsetSeen_ = channelsSeen_ = false;
}

BvhJoint& BvhHierarchy::openJoint(BvhLine& line, std::string_view word) {
  if (open_.empty()) throw line.error(fmt::format("{} stands outside of a joint", BvhLine::shown(word)));
  // A joint's own lines come before those of its children.
  if (open_.back() + 1 != joints_.size()) {
    throw line.error(fmt::format("{} comes behind the children of '{}'", BvhLine::shown(word),
                                 BvhLine::shown(joints_[open_.back()].name)));
  }
  return joints_[open_.back()];
}

void BvhHierarchy::takeWord(std::string_view word, BvhLine& line) {
  if (braceWanted_) {
    if (word != "{") throw line.error(fmt::format("an opening brace is wanted, not \"{}\"", BvhLine::shown(word)));
    open_.push_back(static_cast<Index>(joints_.size() - 1));
    braceWanted_ = false;
  } else if (isWord(word, "root") || isWord(word, "joint")) {
    const bool root = isWord(word, "root");
    if (root != open_.empty())
      throw line.error(root ? "a ROOT stands inside a joint" : "a JOINT stands outside of one");
    if (!root && joints_[open_.back()].endSite) throw line.error("a JOINT stands inside an end site");
    addJoint(validUtf8(line.rest()), false, line.lineNumber());
  } else if (isWord(word, "end")) {
    if (open_.empty() || joints_[open_.back()].endSite) throw line.error("an end site stands outside of a joint");
    line.rest();  // "Site", or a name that nothing refers to
    addJoint(joints_[open_.back()].name + "_end", true, line.lineNumber());
  } else if (isWord(word, "offset")) {
    BvhJoint& joint = openJoint(line, word);
    if (offsetSeen_) throw line.error(fmt::format("'{}' has a second OFFSET", BvhLine::shown(joint.name)));
    for (int i = 0; i < 3; ++i) joint.offset[i] = line.finiteNumber();
    offsetSeen_ = true;
  } else if (isWord(word, "channels")) {
    takeChannels(line);
  } else if (word == "}" && !open_.empty()) {
    open_.pop_back();
  } else {
    throw line.error(fmt::format("\"{}\" has no meaning here", BvhLine::shown(word)));
  }
}

void BvhHierarchy::takeChannels(BvhLine& line) {
  BvhJoint& joint = openJoint(line, "CHANNELS");
  if (channelsSeen_) throw line.error(fmt::format("'{}' has CHANNELS a second time", BvhLine::shown(joint.name)));
  channelsSeen_ = true;
  const double count = line.number();
  if (!(count >= 0 && count <= kMaxChannels) || count != std::floor(count)) {
    throw line.error(fmt::format("{} is no number of channels", count));
  }
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const std::string_view word = line.word();
    if (word.empty()) throw line.error(fmt::format("{} channels are announced and {} named", count, i));
    const std::optional<BvhChannel> channel = channelNamed(word);
    if (!channel) throw line.error(fmt::format("\"{}\" is no channel", BvhLine::shown(word)));
    joint.channels.push_back(*channel);
  }
  channels_ += joint.channels.size();
}

}  // namespace limber
