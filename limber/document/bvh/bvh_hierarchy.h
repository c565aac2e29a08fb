// The first half of a BVH file: joints, offsets and channels.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/types.h"
#include "limber/document/unique_names.h"

namespace limber {

enum class BvhQuantity { kPosition, kRotation, kScale };

struct BvhChannel {
  BvhQuantity quantity = BvhQuantity::kPosition;
  int axis = 0;  // 0 to 2: X, Y, Z
};

struct BvhJoint {
  std::string name;  // unique
  std::optional<Index> parent;
  Vec3 offset = Vec3::Zero();  // as the file has it
  std::vector<BvhChannel> channels;
  bool endSite = false;
};

// Reads lines one after the other. All throw Error kBadData with the line's number.
class BvhHierarchy {
 public:
  // Takes the next line; false once that was the one that says MOTION.
  bool takeLine(std::string_view text, std::size_t lineNumber);

  // The file is over before MOTION: throws unless the tree is complete.
  void finish(std::size_t lineNumber) const;

  const std::vector<BvhJoint>& joints() const { return joints_; }
  std::size_t channelCount() const { return channels_; }
  const Warnings& warnings() const { return warnings_; }

 private:
  void addJoint(std::string name, bool endSite, std::size_t lineNumber);
  void takeWord(std::string_view word, class BvhLine& line);
  void takeChannels(class BvhLine& line);
  BvhJoint& openJoint(class BvhLine& line, std::string_view word);

  bool begun_ = false, braceWanted_ = false, offsetSeen_ = false, channelsSeen_ = false;
  std::vector<BvhJoint> joints_;
  std::vector<Index> open_;  // from a root down
  std::size_t channels_ = 0;
  UniqueNames names_;
  Warnings warnings_;
};

}  // namespace limber
