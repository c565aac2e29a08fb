// A performer as the Virtual Motion Capture protocol sends it (protocol.vmc.info/english): OSC packets, frame by frame.
#pragma once

#include <array>
#include <optional>

#include "limber/document/live/osc_packet.h"
#include "limber/skeleton/pose.h"

namespace limber {

// Unity's humanoid bones that there are at most.
constexpr std::size_t kVmcBones = 55;

// Keeps the last values of each bone. Reads /VMC/Ext/Bone/Pos and /VMC/Ext/Root/Pos: a name, a position (metres) and a
// rotation (x, y, z, w), local to the bone's parent and, for the rotation, relative to a T-pose, in Unity's left-handed
// space. The result is right-handed, +Y up, with the performer facing +Z.
class VmcStream {
 public:
  // Takes a packet that came at that moment (seconds, rising). False where the packet breaks OSC's format; what is not
  // finite or names no bone is left out, too.
  bool take(ByteSpan packet, double seconds);

  // How many bones' values came in all.
  std::size_t taken() const { return taken_; }

  // The skeleton of the bones that have come, once the hips have and for a quarter of a second no new bone has: in a
  // T-pose, with Unity's names, standing on y = 0. Bones lie where the sender has them, or, where it has them all on
  // their parents, as in smplSkeleton. Null before; another object with another number once bones have been added.
  const Skeleton* skeleton(double seconds);
  std::size_t skeletonNumber() const { return number_; }

  // The performer now, as locals of that skeleton's joints.
  Pose pose() const;

 private:
  void takeMessage(const OscMessage& message, double seconds);

  std::array<std::optional<Transform>, kVmcBones> bones_;  // right-handed, as sent else
  Transform root_;
  double grown_ = 0;  // when the last new bone came
  bool stale_ = false;
  std::size_t taken_ = 0, number_ = 0;
  Skeleton skeleton_;
  std::vector<std::size_t> boneOf_;  // #J
};

}  // namespace limber
