// The pieces of one body: the labelled parts, cut at the landmarks of limbs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/character/anatomy/body_part.h"

namespace limber {

// Limbs with the same marks correspond: `marks` are those of Segment that begin at a joint, in order.
struct LimbPieces {
  const Part* part = nullptr;
  std::vector<Index> joints;   // from where it hangs; of fingers without a metacarpal in the palm, and without tips
  std::size_t firstPiece = 0;  // 1 of a thumb of two joints: it lacks the one in the palm
  std::vector<double> along;   // #joints, 0 to 1 along the limb
  std::vector<std::pair<Segment, std::size_t>> marks;  // and the joint at which they begin
};

struct BodyPieces {
  BodyPieces(const Skeleton& skeleton, const AnatomyOptions& options = {});

  Anatomy anatomy;
  std::optional<Index> pelvis;    // where the hindmost legs and the spine part; of no legs the first joint of the trunk
  bool pelvisIsInferred = false;  // the trunk begins above it, and no name tells which of both is the pelvis
  std::vector<Index> trunk, neck;  // between the pelvis and the neck, and from there to the head
  std::optional<Index> head;
  std::vector<LimbPieces> limbs;  // all parts but these, by kind, pair and side
  double centerConfidence = 1;    // of trunk, neck and head

  // What no person has: a tail, wings, more than two legs.
  bool isAnimal() const;
  // Legs of animals end where they stand, at their first low joint, which is measured, not read: makers disagree on
  // where a paw or hoof begins, and a foot that is planted has to be on the ground.
  void cutLegsWhereTheyStand(const Skeleton& skeleton);

  const LimbPieces* find(PartKind kind, Side side, Index pair) const;

  // Of a body without limbs, as a snake's, whatever its root: from the head, or where the trunk begins, to where it
  // ends farthest away. Empty of others.
  std::vector<Index> lineOfLimbless(const Skeleton& skeleton) const;

 private:
  void findCenter(const Skeleton& skeleton, const JointTree& tree);
  bool splitAtForelegs(const JointTree& tree);
};

}  // namespace limber
