// Arrays out of NumPy's .npz files: an archive of .npy files, one for each array.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/file/file.h"

namespace limber {

// The files of an archive by their paths, as whoever unpacked it has them: "weights.npy" holds the array "weights".
using NpzFiles = std::map<std::string, Bytes>;

// shape   the length along each axis; empty for a single number
// values  in C order (the last axis runs fastest), whatever the file's; 64 bit integers beyond 2^53 are rounded
struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;

  bool hasShape(std::span<const std::size_t> wanted) const;
};

// One .npy file of version 1.0, 2.0 or 3.0: little-endian floats of 4 or 8 bytes, integers of 1 to 8. Nothing in it is
// trusted; memory is at most eight bytes for each of the file's. Throws Error kBadData where it is cut off, longer than
// its shape says or breaks the format, kUnsupported for Python objects, big-endian numbers and types that are no such
// numbers; where() is `name`.
NpyArray readNpy(ByteSpan bytes, std::string_view name);

// Its shape alone, as the header tells it; the numbers are not looked at. Throws likewise.
std::vector<std::size_t> readNpyShape(ByteSpan bytes, std::string_view name);

// The array of that name, nothing where there is none. Other arrays of the archive are not looked at.
std::optional<NpyArray> npzArray(const NpzFiles& files, const std::string& array);

}  // namespace limber
