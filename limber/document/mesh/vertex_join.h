// Face corners that are the same in everything, made one vertex.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// A vertex attribute: #V rows of `components` floats.
struct VertexAttribute {
  std::string name;  // "POSITION"
  Index components = 0;
  std::vector<float> values;
};

// Rows of 32-bit words that stand for all that a vertex has; equal rows are one vertex.
class VertexRows {
 public:
  VertexRows(std::size_t count, std::size_t width) : width_(width) { words_.reserve(count * width); }

  void add(std::uint32_t word) { words_.push_back(word); }
  void add(float value);  // by its bits; -0 is 0

  std::size_t count() const { return width_ == 0 ? 0 : words_.size() / width_; }
  bool equal(std::size_t a, std::size_t b) const;
  std::uint64_t hash(std::size_t row) const;

 private:
  std::size_t width_;
  std::vector<std::uint32_t> words_;
};

struct JoinedVertices {
  std::vector<Index> kept;    // the rows that stay, ascending: the first of each kind
  std::vector<Index> vertex;  // #rows, index into `kept`
};

// Cost: linear, by a hash table.
JoinedVertices joinVertices(const VertexRows& rows);

}  // namespace limber
