// What readers of arrays in SMPL's layout have in common: each error names the array.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/smpl/npz.h"

namespace limber {

inline constexpr std::size_t kMaxSmplVertices = 100'000'000;  // of a body; SMPL-X has 10,475

// Throws Error kBadData, where() being "array.npy".
[[noreturn]] void refuseSmplArray(const std::string& array, std::string what);

// The arrays of bodies and motions that limber reads, out of an archive that may hold others: these are not unpacked.
// Throws as readZipArchive does.
NpzFiles readSmplArrays(ByteSpan npz, std::string_view name);

// The array of that name of a body (pipeline/smpl_body.h). Throws Error kBadData where there is none; else as npzArray
// does.
NpyArray neededSmplArray(const NpzFiles& body, const std::string& array);

void checkSmplShape(const NpyArray& array, const std::string& name, const std::vector<std::size_t>& wanted);

// How many rows of three there are, at least one.
std::size_t smplRowsOfThree(const NpyArray& array, const std::string& name);

// Three by three, all finite in single precision.
std::vector<Vec3> smplPoints(const NpyArray& array, const std::string& name);

}  // namespace limber
