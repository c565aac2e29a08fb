// The words in joints' names, without their neighbours. Internal to the module.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limber::detail {

// What a name says by itself. Words that mean one joint beside some neighbours and another beside others have kinds of
// their own.
enum class BodyWord {
  kNone,
  kHips,
  kTrunk,
  kNeck,
  kHead,
  kJaw,
  kEye,
  kCollar,
  kShoulder,  // a collar, or an upper arm
  kArm,       // an upper arm, or any of the arm
  kUpperArm,
  kLowerArm,
  kHand,
  kHip,  // of a side: an upper leg, or a link between hips and upper leg
  kLeg,  // a lower leg, or any of the leg
  kUpperLeg,
  kMiddleLeg,  // of three bones before the foot
  kLowerLeg,
  kFoot,
  kToes,
  kThumb,
  kIndex,
  kMiddle,
  kRing,
  kLittle,
};

enum class BodySide { kMiddle, kLeft, kRight };

struct BodyName {
  BodyWord word = BodyWord::kNone;
  BodySide side = BodySide::kMiddle;
  double confidence = 0;
};

// The words of a name in small letters, numbers apart: "mixamorig:LeftUpLeg" -> left, up, leg; "Ear1.R" -> ear, 1, r.
std::vector<std::string> wordsOfName(std::string_view name);

// Is it a word of programs and pipelines that says nothing of the body ("mixamorig", "def")?
bool isNoiseWord(std::string_view word);

// Reads one name, without its neighbours. Helpers and ends are kNone.
BodyName readBodyName(std::string_view name);

}  // namespace limber::detail
