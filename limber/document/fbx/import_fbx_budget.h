// How much a document made of an FBX file may hold.
#pragma once

#include <cstddef>
#include <cstdint>

#include "limber/core/error.h"
#include "limber/core/file/read_bounds.h"

namespace limber {

// One value of a layer may apply to millions of corners, and one geometry to thousands of models: numbers of vertices
// are limited to a multiple of the file's size. Most files store more of them than are made.
class FbxBudget {
 public:
  explicit FbxBudget(std::size_t fileSize) : left_(read_bounds::kFbxNumbers.of(fileSize)) {}

  // Before so many numbers (floats, indices) are made. Throws Error kLimit.
  void spend(std::size_t numbers) {
    if (numbers > left_) {
      throw Error(ErrorCode::kLimit, "its meshes take more memory than those of a file of its size may", {},
                  "export it with fewer copies of its meshes");
    }
    left_ -= numbers;
  }

 private:
  std::uint64_t left_;
};

}  // namespace limber
