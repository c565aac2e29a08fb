// Motions onto the character in a document.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/character/character.h"
#include "limber/character/matching/skeleton_matches.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct RetargetAssetOptions {
  std::string method = "limb-ik";
  RetargetOptions retarget;
  std::optional<double> frameRate;     // of the clips; none: each motion's own
  std::optional<std::string> mapJson;  // joints matched as this map says (skeleton_map.h)
  bool unlikeBodies = false;           // as matchSkeletons; with a map that map says
  std::string body = {};               // of a motion of several: which moves the character (motionOfBody)
  SkeletonMatches* matches = nullptr;  // of several motions or characters, each skeleton's made once; null: made anew
  Quat turn = Quat::Identity();        // of the clips, about the origin (standUpright)
};

struct RetargetedClip {
  std::string name;  // in the document, with a number behind it where another clip had that name
  Index frames = 0;
  double framesPerSecond = 0;
  SkeletonMap map;
  std::vector<std::string> doubtful;  // "leftHand: LHand -> hand_l", matches to look at
  std::string mapJson;                // the map as a file
};

// Has the document a rig, or is it a skeleton alone?
bool canMove(const Asset& asset);

// What a motion is on the character, neither turned (RetargetAssetOptions::turn) nor added: a clip for each of its
// clips. Contacts are of the character's feet (plantedFeet), where asked for. Throws as retargetOnto does.
//
// warnings  get what the clips lose and which matches are doubtful
struct CharacterClips {
  std::vector<ClipWithContacts> clips;
  std::vector<RetargetedClip> reports;
};
CharacterClips retargetedClips(const Character& character, const Motion& motion, const RetargetAssetOptions& options,
                               bool withFeet, Warnings& warnings);

// A clip for each clip of `motion`, added to the document: called as the motion, or, where it has several, as they are.
// Throws Error kUnsupported where the document cannot move or the motion has no clip, and as matchSkeletons does.
//
// character  of the document, which may have got clips since
std::vector<RetargetedClip> retargetOnto(Asset& asset, const Character& character, const Motion& motion,
                                         const RetargetAssetOptions& options);

}  // namespace limber
