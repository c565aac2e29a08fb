// What bone heat alone cannot know of models in many pieces: which of them are hard parts, and which hardly see a bone.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/grouped.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/weights/influence_table.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// By piece the joint that it follows whole; none where it bends.
using PieceBinding = std::vector<std::optional<Index>>;

// Gives the vertices of bound pieces their joint alone. Counts the pieces in the warning `rigid-pieces`.
// piece  #V, as the weights have vertices
void bindPieces(const PieceBinding& binding, std::span<const Index> piece, SkinWeights& weights, Warnings& warnings);

// The pieces of a mesh and how well each sees the bones.
class PieceRules {
 public:
  // piece  #V, from vertexComponents; pieceCount of them
  // pull   #V, from findHeatSources: positive where a vertex sees a bone
  PieceRules(const TriMesh& mesh, std::span<const Bone> bones, const std::vector<Index>& piece, Index pieceCount,
             const std::vector<double>& pull);

  // Decides whether the model is one of hard parts (a robot, a jointed doll): it has at least half as many pieces as
  // joints, and the joint that holds most of a piece holds 0.6 of it or more, as a mean by area. Robots among the test
  // characters have 0.64 to 0.84, clothed people and animals at most 0.49. `weights` are those of bone heat, before
  // any bridging.
  void classify(const SkinWeights& weights);

  // Empties the rows of pieces of which hardly a vertex sees a bone, so that they take the weights of what they lie on:
  // less than a quarter, in a model of parts less than a twentieth. What such a piece sees it sees through a gap.
  void dropHardlySeen(InfluenceTable& weights) const;

  // Binds pieces whole to one joint: in a model of parts those of which it holds 0.62, and those about whose middle it
  // turns (the ball of a joint); in other models small pieces of which it holds 0.8 (eyes, buttons, buckles).
  void bindRigid(SkinWeights& weights, Warnings& warnings) const;

 private:
  struct Top {
    Index joint = 0;
    double fraction = 0;  // of the piece's vertices
  };

  using WeightVisitor = std::function<void(Index piece, const std::vector<double>& fractions)>;

  double sight(Index piece) const;
  void visitWeights(const SkinWeights& weights, const WeightVisitor& visit) const;
  static Top topOf(const std::vector<double>& fractions);
  bool small(Index piece) const;
  std::optional<Index> jointAtMiddle(Index piece, const std::vector<double>& fractions) const;

  std::span<const Bone> bones_;
  const std::vector<Index>& piece_;
  Index jointCount_ = 0;       // above the highest joint of a bone
  Index boneJoints_ = 0;       // joints that have a bone
  Grouped<Index> vertices_;    // by piece
  std::vector<Index> seeing_;  // by piece: vertices that see a bone
  std::vector<double> area_;   // by piece
  std::vector<Box> box_;       // by piece
  double totalArea_ = 0;
  bool madeOfParts_ = false;
};

}  // namespace limber
