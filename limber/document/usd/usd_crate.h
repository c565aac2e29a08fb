// USD's binary form, the crate.
#pragma once

#include "limber/core/file/file.h"
#include "limber/document/usd/usd_stage.h"

namespace limber {

// Version 0.8.0 of the format (OpenUSD, pxr/usd/usd/crateFile.cpp), which every reader takes: the structure and lists
// of integers are packed, lists of numbers with few different values too, and equal values are stored once. All values
// lie at multiples of 8 bytes. Throws std::logic_error where a target is not in the stage; Error kLimit as
// encodeLz4Block.
Bytes usdCrate(const UsdStage& stage);

}  // namespace limber
