#include "limber/character/character.h"

#include <utility>

#include "limber/core/lazy.h"
#include "limber/document/clip/motion_io.h"

namespace limber {

struct Character::Readings {
  std::shared_ptr<const Asset> document;
  Lazy<AssetSkeleton> binding, moving;
  Lazy<SkeletonReading> reading;
  // Of those with the same surface.
  std::shared_ptr<Lazy<Geometry>> surface = std::make_shared<Lazy<Geometry>>();
  std::shared_ptr<Lazy<SkinWeights>> weights = std::make_shared<Lazy<SkinWeights>>();
  Lazy<std::shared_ptr<const BodySkin>> skin;
};

Character::Character(std::shared_ptr<const Asset> document) {
  auto readings = std::make_shared<Readings>();
  readings->document = std::move(document);
  readings_ = std::move(readings);
}

Character::Character(Asset&& document) : Character(std::make_shared<const Asset>(std::move(document))) {}

Character::Character(const Asset& document)
    : Character(std::shared_ptr<const Asset>(std::shared_ptr<const Asset>(), &document)) {}

const Asset& Character::document() const {
  return *readings_->document;
}

bool Character::hasRig() const {
  return limber::hasRig(document());
}

const AssetSkeleton& Character::binding() const {
  return readings_->binding.get([&] { return readSkeleton(document()); });
}

const AssetSkeleton& Character::moving() const {
  return readings_->moving.get([&] { return animatedSkeleton(document()); });
}

const SkeletonReading& Character::reading() const {
  return readings_->reading.get([&] { return SkeletonReading(skeleton()); });
}

const Geometry& Character::surface() const {
  return readings_->surface->get([&] { return collectGeometry(document()); });
}

const SkinWeights& Character::weights() const {
  return readings_->weights->get([&] { return readWeights(document(), surface(), binding()); });
}

std::shared_ptr<const Geometry> Character::sharedSurface() const {
  return {readings_->surface, &surface()};
}

Character Character::renamed(Asset document) const {
  auto readings = std::make_shared<Readings>();
  readings->document = std::make_shared<const Asset>(std::move(document));
  readings->surface = readings_->surface;
  readings->weights = readings_->weights;
  Character result(*this);
  result.readings_ = std::move(readings);
  return result;
}

const std::shared_ptr<const BodySkin>& Character::skin() const {
  return readings_->skin.get([&] { return makeBodySkin(binding().skeleton, surface().positions, weights()); });
}

}  // namespace limber
