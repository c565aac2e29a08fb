// What deformers prepare for one bound surface, each when it is first asked for.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "limber/deform/deformer.h"

namespace limber {

// May be asked by several threads at once; each preparation is made once.
class DeformPreparations {
 public:
  // Always of the same surface and number of joints. Null where the deformer prepares nothing. Errors and cost of the
  // first time as of prepareDeformer.
  std::shared_ptr<const DeformPreparation> of(const Deformer& deformer, const BoundSurface& surface, Index jointCount);

  // Gives the memory back; what is asked for again is made again.
  void forget();
  std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<const Deformer*, std::shared_ptr<const DeformPreparation>>> made_;
};

}  // namespace limber
