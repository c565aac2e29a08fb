// Linear keys for a joint that moves as a function of time says.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

using MovingTransform = std::function<Transform(double seconds)>;  // a joint's local transform

// The times of a track's keys, at the end of `times`. A step has two, as near to each other as floats are.
template <typename Value>
void addKeyTimes(const Track<Value>& track, std::vector<float>& times);

// The size of a skeleton at rest (the diagonal of the box round its joints) as what hangs on that joint measures it: in
// its own, maybe scaled, frame. Above 0.
double sizeSeenFrom(const Skeleton& skeleton, std::optional<Index> joint);

// As many keys as it takes.
class MovementKeys {
 public:
  // times  where keys are wanted, in any order, once or several times; at least one
  // size   of the skeleton, in the unit of the local translations (sizeSeenFrom)
  // most   how far the line between two keys may be from the movement: of the size, plus radians, plus what scales
  //        differ. Keys are put between until it holds, where no more than 256 do between two of `times`.
  MovementKeys(const MovingTransform& movement, std::vector<float> times, double size, double most);

  // Replaces the clip's tracks of that joint; rotations and scales only where they are `changed`.
  void writeTo(Clip& clip, Index joint, bool changed) const;

 private:
  struct Key {
    float time = 0;
    Transform local;
  };
  struct Bound {
    double size = 1, most = 0;
  };
  void divide(const MovingTransform& movement, const Bound& bound, const Key& from, const Key& to, int depth);

  std::vector<Key> keys_;
};

}  // namespace limber
