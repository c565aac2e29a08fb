#include "limber/adapters/handed_model.h"

#include <iterator>

#include <fmt/format.h>

#include "limber/core/transform.h"

namespace limber {

Affine toHandedSpace(AdapterUp up, double size) {
  Mat3 turn = Mat3::Identity();
  if (up == AdapterUp::kZ) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // +Y to +Z, the model's front +Z to -Y
  Affine map = Affine::Identity();
  map.linear() = size * turn;
  return map;
}

HandedModel handedModel(const TriMesh& working, const Adapter& adapter) {
  const Affine map = toHandedSpace(adapter.inputUp, adapter.inputSize);
  HandedModel handed;
  handed.vertexOf.assign(working.positions.size(), std::nullopt);
  for (const Triangle& t : working.triangles) {
    for (const Index v : t) handed.vertexOf[v] = 0;
  }
  for (Index v = 0; v < working.vertexCount(); ++v) {
    if (!handed.vertexOf[v]) continue;
    handed.vertexOf[v] = handed.mesh.vertexCount();
    handed.mesh.positions.push_back((map * working.position(v)).cast<float>());
  }
  handed.mesh.triangles.reserve(working.triangles.size());
  for (const Triangle& t : working.triangles) {
    handed.mesh.triangles.push_back({*handed.vertexOf[t[0]], *handed.vertexOf[t[1]], *handed.vertexOf[t[2]]});
  }
  return handed;
}

Bytes handedObj(const TriMesh& mesh) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const Vec3f& p : mesh.positions) fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  for (const Triangle& t : mesh.triangles) fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return {text.begin(), text.end()};
}

Skeleton movedSkeleton(const Skeleton& skeleton, const Affine& map) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::vector<Affine> placed;  // without scale
  placed.reserve(globals.size());
  Skeleton moved = skeleton;
  for (std::size_t j = 0; j < globals.size(); ++j) {
    Joint& joint = moved.joints[j];
    Affine& global = placed.emplace_back(Affine::Identity());
    global.linear() = decompose(map * globals[j]).rotation.toRotationMatrix();
    global.translation() = map * Vec3(globals[j].translation());
    joint.rest = decompose(joint.parent ? placed[*joint.parent].inverse() * global : global);
    joint.rest.scale = Vec3::Ones();
  }
  return moved;
}

}  // namespace limber
