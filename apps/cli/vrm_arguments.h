// What limber is told of a VRM that it writes.
#pragma once

#include "limber/document/vrm/vrm_meta.h"

namespace CLI {
class App;
}

namespace limber::cli {

struct VrmArguments {
  VrmMeta meta;

  void addTo(CLI::App& command);
};

}  // namespace limber::cli
