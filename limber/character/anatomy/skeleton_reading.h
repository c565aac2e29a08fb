// A skeleton and what is read from it at rest, each reading made when it is first asked for and kept.
#pragma once

#include <memory>

#include "limber/character/anatomy/body_pieces.h"

namespace limber {

// Immutable, cheap to copy (copies refer to the same readings), thread-safe.
class SkeletonReading {
 public:
  // A copy of the skeleton. Implicit: a skeleton is a reading of which nothing is made yet.
  SkeletonReading(const Skeleton& skeleton);

  const Skeleton& skeleton() const;
  // Has `other` joints of the same names, declared bones and parents? Then parts of the anatomy are its parts.
  bool hasJointsOf(const Skeleton& other) const;
  // And, bit for bit, the same rest pose? Then its axes and sizes are this one's, too.
  bool isOf(const Skeleton& other) const;
  // This reading where it is of that skeleton, else one of which nothing is made yet.
  SkeletonReading of(const Skeleton& other) const { return isOf(other) ? *this : SkeletonReading(other); }
  // readAnatomy of the rest pose; throws Error as it does.
  const Anatomy& anatomy() const;
  const BodyPieces& pieces() const;

 private:
  struct Readings;
  std::shared_ptr<const Readings> readings_;
};

}  // namespace limber
