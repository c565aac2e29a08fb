// The one door to the file system. A browser fills it with bytes instead: everything above reads and writes spans.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace limber {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

// The whole file; "-" is standard input. Throws Error kFile with the system's reason.
Bytes readFile(const std::filesystem::path& path);

// Hands the file over in order, in pieces of at most a megabyte that hold only during the call: for files that need not
// be in memory as a whole. Throws as readFile does, and lets through what `take` throws.
void readFileInPieces(const std::filesystem::path& path, const std::function<void(ByteSpan)>& take);

// One file of a result that is several (a .gltf, its .bin and its images).
struct OutputFile {
  std::filesystem::path path;  // "-" is standard output
  ByteSpan bytes;
  std::vector<ByteSpan> further = {};  // behind them: what need not be in memory as one piece
};

// Writes several files as one: each is first written beside its final path, under a temporary name of its own, and only
// when all are complete and closed are they renamed, in the order given. A failure before that leaves every path as it
// was. Should the system refuse one of the renames themselves, those before it have happened; the temporary files are
// gone in any case. So a file that refers to others goes last.
//
// A link is followed and stays. Standard output, and what is there and no plain file (a device, a pipe), is written
// straight into, before the renames. Missing folders are not made. Throws Error kFile.
void writeFiles(std::span<const OutputFile> files);
void writeFile(const std::filesystem::path& path, ByteSpan bytes);

inline ByteSpan asBytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace limber
