#include "limber/session/command_record.h"

namespace limber {

namespace {

template <class... C>
bool isOneOf(const Command& command) {
  return (std::holds_alternative<C>(command) || ...);
}

}  // namespace

void CommandRecord::add(const Command& command) {
  if (isOneOf<OpenSample, OpenFile>(command)) commands_.clear();
  const bool onlyLast =
      isOneOf<UpdateDrag, TurnDrag, ScaleDrag, MoveDrag, SetHandles, SetTime, SetClock, ChooseMember>(command);
  if (onlyLast && !commands_.empty() && commands_.back().index() == command.index()) commands_.pop_back();
  commands_.push_back(command);
}

void CommandRecord::cancelDrag() {
  while (!std::holds_alternative<BeginDrag>(commands_.back())) commands_.pop_back();
  commands_.pop_back();
}

}  // namespace limber
