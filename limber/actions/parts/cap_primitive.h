// The caps of a part as a primitive of its mesh.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "limber/actions/parts/part_caps.h"
#include "limber/document/scene/geometry.h"

namespace limber {

// A vertex of a model: which of Geometry::instances, and which of that primitive's vertices.
struct ModelVertex {
  Index instance = 0, vertex = 0;
};

// Collects the caps of one mesh; a vertex in the middle of a fan is the mean of those round it, in all that it has.
class CapPrimitive {
 public:
  // `primitives`: those of geometry.instances, as it was before splitting.
  CapPrimitive(const Asset& asset, const Geometry& geometry, const std::vector<gltf::Primitive>& primitives)
      : asset_(asset), geometry_(geometry), primitives_(primitives) {}

  // `loop`: where the mesh has the vertices of cap.loop; all in instances with one and the same space.
  void add(const PartCap& cap, const std::vector<ModelVertex>& loop);

  bool empty() const { return indices_.empty(); }

  // Positions, normals, indices; joints and weights where `skinned`; as many morph targets as the mesh has.
  gltf::Primitive write(Asset& asset, Index material, bool skinned, std::size_t targets) const;

 private:
  struct Mixed {  // one vertex of the caps: a mean of the model's
    std::vector<ModelVertex> of;
    Vec3f normal;
  };
  // An attribute of the vertices, component by component: means.
  std::vector<float> means(std::map<Index, std::vector<float>> values, Index components) const;
  std::vector<float> meansOf(const char* attribute, std::optional<std::size_t> target) const;
  void writeWeights(Asset& asset, gltf::Attributes& attributes) const;

  const Asset& asset_;
  const Geometry& geometry_;
  const std::vector<gltf::Primitive>& primitives_;
  std::vector<Mixed> vertices_;
  std::vector<Triangle> indices_;
};

}  // namespace limber
