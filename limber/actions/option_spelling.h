// Options by the names that a caller knows. The library writes an option between backticks, alone or with a value:
// "`existing-rig: replace` takes it out first". It does so in an error's remedy, and in its where() if one option is to
// blame, and in advice (RigCheckReport); other messages, and names of files and joints, are left as they are.
#pragma once

#include <string>
#include <string_view>

#include "limber/core/error.h"

namespace limber {

enum class OptionSpelling {
  kProgram,     // --max-influences, --template auto, --replace-rig
  kPython,      // max_influences, template="auto", existing_rig="replace"
  kJavaScript,  // maxInfluences, template: 'auto', existingRig: 'replace'
};

// The text with every option in it as the caller writes it. Other text between backticks stays, and so does what is
// called by no option's name. Linear.
std::string spellOptions(std::string_view text, OptionSpelling spelling);

// "`handles`", and nothing else.
bool isOption(std::string_view text);

// The advice with its messages as the caller writes them.
Warnings spellOptions(const Warnings& advice, OptionSpelling spelling);

// The error with its remedy, and a where() that is an option, as the caller writes them.
Error spellOptions(const Error& error, OptionSpelling spelling);

}  // namespace limber
