// What was done since a model was opened, as commands that do it again.
#pragma once

#include <span>
#include <vector>

#include "limber/session/command.h"

namespace limber {

class CommandRecord {
 public:
  // Opening begins anew. Of several updates of a drag, counts of handles, moments or choices in a row the last is kept.
  void add(const Command& command);
  // The drag that was begun last was none.
  void cancelDrag();

  std::span<const Command> commands() const { return commands_; }

 private:
  std::vector<Command> commands_;
};

}  // namespace limber
