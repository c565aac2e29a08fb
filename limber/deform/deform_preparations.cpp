#include "limber/deform/deform_preparations.h"

namespace limber {

std::shared_ptr<const DeformPreparation> DeformPreparations::of(const Deformer& deformer, const BoundSurface& surface,
                                                                Index jointCount) {
  if (!deformer.prepare) return nullptr;
  const std::lock_guard lock(mutex_);
  for (const auto& [known, preparation] : made_) {
    if (known == &deformer) return preparation;
  }
  made_.emplace_back(&deformer, prepareDeformer(deformer, surface, jointCount));
  return made_.back().second;
}

void DeformPreparations::forget() {
  const std::lock_guard lock(mutex_);
  made_.clear();
}

std::size_t DeformPreparations::size() const {
  const std::lock_guard lock(mutex_);
  return made_.size();
}

}  // namespace limber
