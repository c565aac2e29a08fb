// Options by the names that a caller knows. The library writes an option between backticks, alone or with a value:
// "`existing-rig: replace` takes it out first".
#pragma once

#include <string>
#include <string_view>

namespace limber {

enum class OptionSpelling {
  kProgram,     // --max-influences, --template auto, --replace-rig
  kPython,      // max_influences, template="auto", existing_rig="replace"
  kJavaScript,  // maxInfluences, template: 'auto', existingRig: 'replace'
};

// The text with every option in it as the caller writes it. Other text between backticks stays. Linear.
std::string spellOptions(std::string_view text, OptionSpelling spelling);

}  // namespace limber
