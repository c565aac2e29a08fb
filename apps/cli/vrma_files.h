// Motions as files for VRMs.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "limber/character/character.h"
#include "limber/document/vrm/vrma_write.h"
#include "limber/skeleton/motion.h"

namespace limber::cli {

class Account;

struct VrmaSource {
  std::optional<Character> model;  // none: a skeleton alone
  const Motion* motion = nullptr;  // over the model's moving()
  bool isEdited = false;           // its clips are no longer the model's: weights of blend shapes do not fit
};

// A file for each clip of the motion, all or none; `paths` are as many.
void writeVrmaFiles(const VrmaSource& source, const std::vector<std::filesystem::path>& paths, bool quiet,
                    const Account& account);

}  // namespace limber::cli
