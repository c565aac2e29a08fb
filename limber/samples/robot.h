// A robot of many pieces, built from parts that are placed by nodes and used several times.
#pragma once

#include "limber/document/asset.h"

namespace limber {

Asset makeRobot();

}  // namespace limber
