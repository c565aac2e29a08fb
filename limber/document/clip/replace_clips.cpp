#include "limber/document/clip/replace_clips.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/moving_parents.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

std::vector<std::string> replaceClips(Asset& asset, const AssetSkeleton& skeleton, std::span<const Clip> clips,
                                      const std::optional<TimeSpan>& cut) {
  settleMovingParents(asset, skeleton);
  const AccessorSweep accessors(asset);
  const BufferViewSweep views(asset);
  const std::vector<Index>& joints = skeleton.jointNode;
  removeChannels(asset, [&](Index node, std::string_view path) {
    return path != "weights" && std::find(joints.begin(), joints.end(), node) != joints.end();
  });
  std::vector<gltf::Animation> left = std::move(asset.document.animations);
  asset.document.animations.clear();
  std::vector<gltf::Animation>& animations = asset.document.animations;
  std::vector<std::string> names = addClips(asset, skeleton, clips);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    const auto found = std::find_if(left.begin(), left.end(), [&](const gltf::Animation& animation) {
      return animation.name == clips[c].name && !animation.channels.empty();
    });
    if (found == left.end()) continue;
    if (cut) trimAnimation(asset, *found, *cut);
    appendChannels(animations[c], *found);
  }
  std::erase_if(left, [](const gltf::Animation& animation) { return animation.channels.empty(); });
  animations.insert(animations.begin(), std::make_move_iterator(left.begin()), std::make_move_iterator(left.end()));
  accessors.sweep(asset);
  views.sweep(asset);
  return names;
}

}  // namespace limber
