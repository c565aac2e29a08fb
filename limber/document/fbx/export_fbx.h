// A model as binary FBX: for the engines and programs that know nothing newer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/document/asset.h"

namespace limber {

enum class FbxUnit { kCentimetre, kMetre };
enum class FbxUpAxis { kY, kZ };

struct FbxOptions {
  // What a length of 1 in the file is: UnitScaleFactor says 1 or 100. Engines expect centimetres.
  FbxUnit unit = FbxUnit::kCentimetre;
  FbxUpAxis up = FbxUpAxis::kY;                   // kZ: the front, +Z in glTF, is then -Y
  std::optional<std::vector<std::string>> clips;  // by clipNamed; none: all
};

struct FbxExport {
  Bytes bytes;
  Warnings warnings;  // what FBX cannot say, or limber does not write
};

// FBX 7.4 of what the default scene shows: the nodes by their names and hierarchy with Lcl Translation, Rotation (XYZ)
// and Scaling, joints as limbs; meshes with all layers, materials by polygon, embedded pictures; skins with the
// bind-pose transforms of joint and mesh; a BindPose; blend shapes; each clip an AnimationStack (see writeFbxClips for
// the accuracy of its curves). Values are in the document's own precision. Same document, same bytes.
//
// Throws Error kBadData as collectGeometry does, kBadArgument that lists the clips there are, kLimit above 4 GB.
// Cost: O(#vertices + #keys).
FbxExport encodeFbx(const Asset& asset, const FbxOptions& options = {});

}  // namespace limber
