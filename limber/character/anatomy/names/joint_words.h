// What the words in a joint's name say of the body, by themselves.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/anatomy.h"
#include "limber/character/anatomy/half_body.h"
#include "limber/character/anatomy/names/naming_convention.h"

namespace limber {

// Words with one meaning have the same number; 0 is an unknown word. There are kJointWords numbers.
inline constexpr std::size_t kJointWords = 45;

enum class NameMark { kFront, kHind, kEnd, kHelper, kTwist, kNumbered };
inline constexpr std::size_t kNameMarks = 6;  // of NameMark

struct JointWords {
  std::size_t word = 0;
  Side side = Side::kCenter;
  std::array<bool, kNameMarks> marks{};

  bool has(NameMark mark) const { return marks[static_cast<std::size_t>(mark)]; }
};

JointWords readJointWords(std::string_view name);

// By which a joint is read: the bone that its file declares it to be, else its name.
std::string_view readNameOf(const Joint& joint);

// The parts of a name, to be spelled differently.
struct NameParts {
  std::vector<std::string> words;  // in small letters, numbers apart, without the side; "mixamorig", "DEF" and the like
                                   // only where there is nothing else
  Side side = Side::kCenter;
};

NameParts partsOfName(std::string_view name);

// What is said of a joint that is known to be this; its marks are those of its name.
JointWords wordsOfRole(const NamedRole& role);

// Whether the name is one of the pelvis.
bool saysHips(std::string_view name);
// Whether one of its words is that of a bone in the palm or the middle of the foot, such as "IndexMetacarpal".
bool saysMetapodial(std::string_view name);

// #J
std::vector<JointWords> wordsOfJoints(const Skeleton& skeleton);

// #J partners by names that differ in the side alone ("arm.L", "arm.R"), each of one joint at most; `words` from
// wordsOfJoints.
std::vector<std::optional<NamedPartner>> partnersByName(const Skeleton& skeleton, std::span<const JointWords> words);

// 0 thumb to 4 little finger; none for other words.
std::optional<Index> fingerOfWord(std::size_t word);

}  // namespace limber
