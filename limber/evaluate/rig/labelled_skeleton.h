// Skeletons whose joints are known by hand: what readings of bodies are fitted to and judged by.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/part_states.h"
#include "limber/core/random.h"

namespace limber {

struct JointLabel {
  PartState state = PartState::kOther;
  Side side = Side::kCenter;
  Index pair = 0;
};

struct LabelledSkeleton {
  std::string file;
  Skeleton skeleton;
  Axes axes;
  std::vector<JointLabel> labels;  // #J
  bool flat = false;               // its joints hang on the root: there is no tree to read
};

// Labels as hands made them (docs/body_labels.schema.json): for each file, by the hash of its bytes, the parts and
// their joints by name. Throws Error kBadData naming the file and the part.
struct BodyLabels {
  struct LabelledPart {
    PartKind kind = PartKind::kOther;
    Side side = Side::kCenter;
    Index pair = 0;
    std::vector<std::string> joints;
    std::string upper, middle, hock, end, toes;  // empty: none
  };
  std::string hash, file;
  Axes axes;
  bool flat = false;
  std::vector<LabelledPart> parts;
};
std::vector<BodyLabels> readBodyLabels(std::string_view json);

// FNV-1a of 64 bits, as 16 hexadecimal digits (Fowler, Noll, Vo).
std::string hashOf(std::span<const std::byte> bytes);

// Throws Error kBadData naming a joint that the skeleton does not have.
LabelledSkeleton labelled(const BodyLabels& labels, Skeleton skeleton);

// Kinds of damage by which skeletons of one body differ. Labels go along.
enum class Damage {
  kNumbered,
  kMirrored,
  kTurned,
  kRescaled,
  kStretched,
  kPosed,
  kCropped,
  kJointsAdded,
  kJointsRemoved,
  kAttached  // clothes, hair and other attachments (attached_chains.h)
};
inline constexpr std::size_t kDamages = 10;
std::string_view nameOf(Damage damage);  // "numbered"
LabelledSkeleton damaged(LabelledSkeleton body, Damage damage, Random& random);

}  // namespace limber
