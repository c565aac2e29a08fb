#include "limber/character/character.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "limber/core/lazy.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/scene/shape_surface.h"

namespace limber {

struct Character::Readings {
  std::shared_ptr<const Asset> document;
  Lazy<AssetSkeleton> binding, moving;
  Lazy<SkeletonReading> reading;
  // Of those with the same surface.
  std::shared_ptr<Lazy<Geometry>> surface = std::make_shared<Lazy<Geometry>>();
  std::shared_ptr<Lazy<SkinWeights>> weights = std::make_shared<Lazy<SkinWeights>>();
  Lazy<std::optional<Geometry>> shaped;  // none where no node has shapes
  Lazy<std::shared_ptr<const BodySkin>> skin;
  Lazy<std::optional<Character>> joined;  // none where all skins are bound in one pose
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
  if (isMovedBySkin(document()) && !binding().jointNode.empty()) return binding();
  return readings_->moving.get([&] { return animatedSkeleton(document()); });
}

const SkeletonReading& Character::reading() const {
  return readings_->reading.get([&] { return SkeletonReading(skeleton()); });
}

const Geometry& Character::surface() const {
  return readings_->surface->get([&] { return collectGeometry(document()); });
}

const Geometry& Character::shapedSurface() const {
  const Geometry& bound = surface();
  const std::optional<Geometry>& shaped = readings_->shaped.get([&]() -> std::optional<Geometry> {
    const ShapeWeights shapes = readShapeWeights(document());
    if (std::all_of(shapes.begin(), shapes.end(), [](const auto& own) { return own.empty(); })) return std::nullopt;
    std::optional<Geometry> moved = bound;
    moveByShapes(document(), shapes, *moved);
    return moved;
  });
  return shaped ? *shaped : bound;
}

const SkinWeights& Character::weights() const {
  return readings_->weights->get([&] { return readWeights(document(), surface(), binding()); });
}

std::shared_ptr<const Geometry> Character::sharedSurface() const {
  return {readings_->surface, &surface()};
}

Character Character::inOneBindPose() const {
  return readings_->joined
      .get([&]() -> std::optional<Character> {
        std::optional<Asset> joined = withJoinedBinds(document());
        return joined ? std::optional<Character>(std::move(*joined)) : std::nullopt;
      })
      .value_or(*this);
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
