// FBX animation stacks as glTF animations.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/fbx/import_fbx_models.h"
#include "limber/document/fbx/import_fbx_skin.h"

namespace limber {

// The blend shapes of one mesh of the document.
struct FbxShapesInUse {
  Index node = 0;  // of the document, which has the mesh
  const FbxShapes* shapes = nullptr;
};

// The weight of a blend shape's channel in one clip: a curve, else a number.
struct FbxPercent {
  const FbxCurve* curve = nullptr;
  double still = 0;
};

// What one stack moves.
struct FbxClipCurves {
  std::string name;
  std::optional<std::int64_t> start, stop;  // ticks, as the stack says
  std::map<Index, FbxMotion> motions;       // by model
  std::map<Index, FbxPercent> percents;     // by object: of channels of blend shapes
};

// The curves of a file, and the clips made of them.
class FbxAnimations {
 public:
  // Throws Error kLimit, which names the clip, where clips that share nodes of curves move far more than the file has.
  FbxAnimations(const FbxObjects& objects, const FbxModels& models, Warnings& warnings);

  // #models: does any clip move it, or hold it elsewhere than its rest; does one give it another scale than its rest's?
  const std::vector<bool>& moves() const { return moves_; }
  const std::vector<bool>& scales() const { return scales_; }

  // Adds an animation for each stack that moves something. Only the first layer of a stack counts.
  //
  // nodeOf  #models, node of the document; none for what the document lacks
  // scale   from the file's units to metres
  //
  // A clip begins where its stack does (LocalStart) and ends with its last key or its stack; one whose curves are
  // constant ends with its stack. Values are linear between keys: where the curves, or the rotation by Euler angles,
  // run otherwise, keys are added between theirs, until the result differs by no more than a ten thousandth of a radian
  // (or of the range that a track moves through), though none closer together than 1/48 s. A track that only steps
  // becomes a track of steps; a step among other keys becomes two keys in succession. A property that a clip sets to
  // another value than its rest, without a curve, gets one key where the clip begins.
  //
  // Throws Error kLimit, which names the clip, where tracks that share curves would have more numbers than 16 for each
  // key of the file and 4 million.
  void addClips(Asset& asset, const std::vector<std::optional<Index>>& nodeOf,
                const std::vector<FbxShapesInUse>& shapes, double scale) const;

 private:
  void readStack(Index stack);
  void readCurveNode(Index node, FbxClipCurves& clip);
  void countMoved(const FbxClipCurves& clip);
  const FbxCurve* curveOf(Index node, std::string_view component);

  const FbxObjects& objects_;
  const FbxModels& models_;
  Warnings& warnings_;
  std::map<Index, std::optional<FbxCurve>> curves_;  // by object
  std::vector<FbxClipCurves> clips_;
  std::vector<bool> moves_, scales_;
  std::size_t moved_ = 0;  // models and channels, of all clips
};

}  // namespace limber
