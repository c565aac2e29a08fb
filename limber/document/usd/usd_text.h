// USD's text form.
#pragma once

#include <string>

#include "limber/document/usd/usd_stage.h"

namespace limber {

// A line for each property, each time sample and each bracket of a prim: some readers go by lines. Numbers are as short
// as they read back equal, or rounded to UsdProperty::decimals.
std::string usdText(const UsdStage& stage);

}  // namespace limber
