// A reader of crates for tests: as much as usdCrate writes, made by the format's description and not by the writer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limber/core/file/file.h"

namespace limber::testing {

class ByteReader {
 public:
  explicit ByteReader(ByteSpan bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}

  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const ByteSpan part = take(size);
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{part[i]} << (8 * i);
    return value;
  }
  ByteSpan take(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("cut off");
    at_ += size;
    return bytes_.subspan(at_ - size, size);
  }
  bool isAtEnd() const { return at_ == bytes_.size(); }

 private:
  ByteSpan bytes_;
  std::size_t at_;
};

inline ByteSpan withoutChunkCount(ByteSpan chunk) {
  if (chunk.empty() || chunk[0] != 0) throw std::runtime_error("several chunks");
  return chunk.subspan(1);
}

// Throws std::runtime_error where the block is damaged.
inline Bytes decodeLz4Block(ByteSpan block) {
  ByteReader reader(block);
  Bytes out;
  for (;;) {
    const std::size_t token = reader.number(1);
    const auto length = [&](std::size_t start) {
      if (start < 15) return start;
      for (std::size_t more = 255; more == 255; start += more) more = reader.number(1);
      return start;
    };
    const ByteSpan literals = reader.take(length(token >> 4));
    out.insert(out.end(), literals.begin(), literals.end());
    if (reader.isAtEnd()) break;
    const std::size_t distance = reader.number(2), count = length(token & 15) + 4;
    if (distance == 0 || distance > out.size()) throw std::runtime_error("a match before the start");
    for (std::size_t i = 0; i < count; ++i) out.push_back(out[out.size() - distance]);
  }
  return out;
}

// A chunk of packed integers.
inline std::vector<std::int32_t> unpackIntegers(ByteSpan chunk, std::size_t count) {
  const Bytes encoded = decodeLz4Block(withoutChunkCount(chunk));
  ByteReader common(encoded), codes(encoded, 4), others(encoded, 4 + (count + 3) / 4);
  const auto commonStep = static_cast<std::uint32_t>(common.number(4));
  std::vector<std::int32_t> values;
  std::uint32_t value = 0;  // steps wrap around
  std::uint64_t code = 0;
  for (std::size_t i = 0; i < count; ++i) {
    code = i % 4 == 0 ? codes.number(1) : code >> 2;
    switch (code & 3) {
      case 0:
        value += commonStep;
        break;
      case 1:
        value += static_cast<std::uint32_t>(static_cast<std::int8_t>(others.number(1)));
        break;
      case 2:
        value += static_cast<std::uint32_t>(static_cast<std::int16_t>(others.number(2)));
        break;
      default:
        value += static_cast<std::uint32_t>(others.number(4));
    }
    values.push_back(static_cast<std::int32_t>(value));
  }
  if (!others.isAtEnd()) throw std::runtime_error("bytes are left over");
  return values;
}

// The same, its size before it.
inline std::vector<std::int32_t> nextIntegers(ByteReader& reader, std::size_t count) {
  const std::size_t size = reader.number(8);
  return unpackIntegers(reader.take(size), count);
}

// The structure of a crate: the fields' values, 64 bits each, by paths and names.
struct CrateContent {
  std::vector<std::string> tokens;
  std::map<std::string, std::map<std::string, std::uint64_t>> fields;
  std::map<std::string, std::int32_t> kinds;  // of specs
};

inline CrateContent readCrate(ByteSpan crate) {
  ByteReader boot(crate);
  const ByteSpan magic = boot.take(8);
  if (std::string(magic.begin(), magic.end()) != "PXR-USDC") throw std::runtime_error("no crate");
  boot.take(8);
  ByteReader contents(crate, boot.number(8));
  std::map<std::string, ByteSpan> sections;
  for (std::uint64_t left = contents.number(8); left > 0; --left) {
    const ByteSpan padded = contents.take(16);
    const std::string name(padded.begin(), std::find(padded.begin(), padded.end(), 0));
    const std::uint64_t start = contents.number(8), size = contents.number(8);
    sections[name] = crate.subspan(start, size);
  }

  CrateContent result;
  ByteReader tokens(sections.at("TOKENS"));
  const std::uint64_t tokenCount = tokens.number(8), textSize = tokens.number(8), packedSize = tokens.number(8);
  const Bytes texts = decodeLz4Block(withoutChunkCount(tokens.take(packedSize)));
  if (texts.size() != textSize) throw std::runtime_error("another size of texts");
  for (auto from = texts.begin(); from != texts.end();) {
    const auto to = std::find(from, texts.end(), 0);
    result.tokens.emplace_back(from, to);
    from = to + 1;
  }
  if (result.tokens.size() != tokenCount) throw std::runtime_error("another number of tokens");

  ByteReader fields(sections.at("FIELDS"));
  const std::uint64_t fieldCount = fields.number(8);
  const std::vector<std::int32_t> names = nextIntegers(fields, fieldCount);
  const std::uint64_t repSize = fields.number(8);
  const Bytes repBytes = decodeLz4Block(withoutChunkCount(fields.take(repSize)));
  ByteReader reps(repBytes);
  std::vector<std::uint64_t> values;
  for (std::uint64_t i = 0; i < fieldCount; ++i) values.push_back(reps.number(8));

  ByteReader sets(sections.at("FIELDSETS"));
  const std::uint64_t setSize = sets.number(8);
  const std::vector<std::int32_t> fieldSets = nextIntegers(sets, setSize);

  ByteReader pathReader(sections.at("PATHS"));
  const std::uint64_t pathCount = pathReader.number(8);
  pathReader.number(8);
  const std::vector<std::int32_t> numbers = nextIntegers(pathReader, pathCount),
                                  elements = nextIntegers(pathReader, pathCount),
                                  jumps = nextIntegers(pathReader, pathCount);
  std::vector<std::string> paths(pathCount);
  std::vector<std::pair<std::size_t, std::string>> open = {{0, ""}};  // where siblings go on, and below what
  while (!open.empty()) {
    auto [at, parent] = open.back();
    open.pop_back();
    for (bool goesOn = true; goesOn; ++at) {
      const bool isProperty = elements[at] < 0;
      const std::string& name = result.tokens[static_cast<std::size_t>(std::abs(elements[at]))];
      std::string path = at == 0 ? "/" : parent + (isProperty ? "." : parent == "/" ? "" : "/") + name;
      paths[static_cast<std::size_t>(numbers[at])] = path;
      if (jumps[at] > 0) open.emplace_back(at + static_cast<std::size_t>(jumps[at]), parent);
      if (jumps[at] > 0 || jumps[at] == -1) parent = std::move(path);
      goesOn = jumps[at] != -2;
    }
  }

  ByteReader specs(sections.at("SPECS"));
  const std::uint64_t specCount = specs.number(8);
  const std::vector<std::int32_t> specPaths = nextIntegers(specs, specCount), specSets = nextIntegers(specs, specCount),
                                  kinds = nextIntegers(specs, specCount);
  for (std::uint64_t s = 0; s < specCount; ++s) {
    const std::string& path = paths[static_cast<std::size_t>(specPaths[s])];
    result.kinds[path] = kinds[s];
    for (auto f = static_cast<std::size_t>(specSets[s]); fieldSets[f] >= 0; ++f) {
      const auto field = static_cast<std::size_t>(fieldSets[f]);
      result.fields[path][result.tokens[static_cast<std::size_t>(names[field])]] = values[field];
    }
  }
  return result;
}

}  // namespace limber::testing
