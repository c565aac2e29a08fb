#include "limber/session/edit/paint_weights.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "limber/geometry/mesh/prepare.h"
#include "limber/rigging/weights/weight_edit.h"
#include "limber/session/refuse.h"

namespace limber {

namespace {

constexpr double kBeside = 1e-6;  // that barycentric coordinates may lie outside, by rounding

TriMesh weldedMesh(const Geometry& geometry, const std::vector<Index>& weldedVertex) {
  TriMesh mesh;
  for (std::size_t s = 0; s < weldedVertex.size(); ++s) {  // a position first occurs at its lowest vertex
    if (weldedVertex[s] == mesh.positions.size()) mesh.positions.push_back(geometry.positions[s]);
  }
  for (const Triangle& t : geometry.triangles) {
    mesh.triangles.push_back({weldedVertex[t[0]], weldedVertex[t[1]], weldedVertex[t[2]]});
  }
  return mesh;
}

Vec3 barycentricOf(const SurfaceDab& dab) {
  return {1 - dab.u - dab.v, dab.u, dab.v};
}

// 1 at the middle of the brush, 0 at its rim, level at both.
double falloff(double fraction) {
  const double left = std::clamp(1 - fraction, 0.0, 1.0);
  return left * left * (3 - 2 * left);
}

// The nearest joint above that may take weights.
std::optional<Index> heirOf(const Skeleton& skeleton, Index joint, const std::vector<bool>& locked) {
  std::optional<Index> above = skeleton.joints[joint].parent;
  while (above && locked[*above]) above = skeleton.joints[*above].parent;
  return above;
}

const MirrorMap& requireMirror(const PaintSurface& surface) {
  const std::optional<MirrorMap>& mirror = surface.mirror();
  if (!mirror) {
    throw KnownError(ErrorKind::kModelNotMirrored, {ErrorCode::kUnsupported, "the model is not its own mirror image"});
  }
  return *mirror;
}

void copyRow(SkinWeights& weights, Index from, Index to) {
  const std::size_t slots = weights.slots;
  std::copy_n(weights.joints.begin() + static_cast<std::ptrdiff_t>(from * slots), slots,
              weights.joints.begin() + static_cast<std::ptrdiff_t>(to * slots));
  std::copy_n(weights.weights.begin() + static_cast<std::ptrdiff_t>(from * slots), slots,
              weights.weights.begin() + static_cast<std::ptrdiff_t>(to * slots));
}

std::vector<Influence> influencesOf(const SkinWeights& weights, Index vertex) {
  std::vector<Influence> influences;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.weightsOf(vertex)[k] > 0)
      influences.push_back({weights.jointsOf(vertex)[k], weights.weightsOf(vertex)[k]});
  }
  return influences;
}

double painted(PaintMode mode, double weight, double strength, double amount) {
  if (mode == PaintMode::kReplace) return weight + amount * (strength - weight);
  return weight + (mode == PaintMode::kAdd ? 1 : -1) * strength * amount;
}

}  // namespace

PaintSurface::PaintSurface(std::shared_ptr<const Geometry> geometry)
    : geometry_(std::move(geometry)),
      weldedVertex_(prepareGeometry(*geometry_, geometry_->triangles).weldedVertex),
      distance_(weldedMesh(*geometry_, weldedVertex_)),
      sources_(numbersByGroup(weldedVertex_, distance_.mesh().vertexCount())) {}

const std::optional<MirrorMap>& PaintSurface::mirror() const {
  if (!soughtMirror_) mirror_ = findMirror(distance_.mesh());
  soughtMirror_ = true;
  return mirror_;
}

WeightStroke::WeightStroke(const RiggedModel& rig, const PaintSurface& surface, std::vector<bool> locked,
                           const PaintWeights& settings)
    : rig_(rig), surface_(surface), locked_(std::move(locked)), settings_(settings) {
  settings_.dabs.clear();
  if (!(settings.strength >= 0 && settings.strength <= 1)) refuse("the strength is not between 0 and 1");
  if (!(settings.radius > 0) || !std::isfinite(settings.radius)) refuse("the brush has no radius");
  if (settings.mode != PaintMode::kSmooth) {
    joint_ = rig.skeleton().find(settings.joint);
    if (!joint_) refuse(fmt::format("no joint is called '{}'", settings.joint));
    if (locked_[*joint_]) {
      refuse(ErrorKind::kJointLocked, "the weights of this joint are locked", {{"joint", settings.joint}},
             settings.joint);
    }
    heir_ = heirOf(rig.skeleton(), *joint_, locked_);
  }
  amounts_.assign(surface.distance().mesh().vertexCount(), 0);
  imageAmounts_ = amounts_;
  if (!settings.mirrored) return;
  const RigMirror mirror = mirrorOfRig(rig, requireMirror(surface).plane);
  if (!joint_ || mirror.joints[*joint_] == kNoIndex || locked_[mirror.joints[*joint_]]) return;
  image_ = mirror.joints[*joint_];
  imageHeir_ = heirOf(rig.skeleton(), *image_, locked_);
}

void WeightStroke::reach(Index welded, double amount, std::vector<double>& amounts) {
  if (!(amount > amounts[welded])) return;
  if (amounts_[welded] == 0 && imageAmounts_[welded] == 0) touched_.push_back(welded);
  amounts[welded] = amount;
}

void WeightStroke::add(std::span<const SurfaceDab> dabs) {
  const TriMesh& mesh = surface_.distance().mesh();
  for (const SurfaceDab& dab : dabs) {
    const Vec3 at = barycentricOf(dab);
    if (dab.triangle >= mesh.triangleCount() || !(at.minCoeff() >= -kBeside)) refuse("a dab lies beside the surface");
  }
  // Both sides of a joint that is its own image, and of smoothing, are one.
  const bool both = settings_.mirrored && (!joint_ || image_ == joint_);
  for (const SurfaceDab& dab : dabs) {
    for (const VertexDistance& at : surface_.distance().within(dab.triangle, barycentricOf(dab), settings_.radius)) {
      const double amount = falloff(at.distance / settings_.radius);
      reach(at.vertex, amount, amounts_);
      if (!both && !image_) continue;
      const Index image = surface_.mirror()->image[at.vertex];
      if (image != kNoIndex) reach(image, amount, both ? amounts_ : imageAmounts_);
    }
  }
}

SkinWeights WeightStroke::weights() const {
  SkinWeights weights = rig_.weights;
  if (settings_.mode == PaintMode::kSmooth) {
    smooth(weights);
  } else {
    paint(weights);
  }
  for (const Index welded : touched_) {
    const std::span<const Index> sources = surface_.sources(welded);
    for (const Index source : sources) copyRow(weights, sources.front(), source);
  }
  return weights;
}

void WeightStroke::paint(SkinWeights& weights) const {
  const auto wanted = [&](const WeightRow& row, Index joint, double amount) {
    return Influence{joint, painted(settings_.mode, row.of(joint), settings_.strength, amount)};
  };
  for (const Index welded : touched_) {
    WeightRow row(weights, surface_.sources(welded).front(), locked_);
    const double here = amounts_[welded], there = imageAmounts_[welded];
    std::vector<Influence> changes;
    if (here > 0) changes.push_back(wanted(row, *joint_, here));
    if (there > 0) changes.push_back(wanted(row, *image_, there));
    row.set(changes, here > 0 ? heir_ : imageHeir_);
  }
}

void WeightStroke::smooth(SkinWeights& weights) const {
  std::vector<SmoothAmount> amounts;
  for (const Index welded : touched_) {
    SmoothAmount at{surface_.sources(welded).front(), settings_.strength * amounts_[welded], {}};
    for (const Index next : surface_.distance().neighbours(welded)) {
      at.neighbours.push_back(surface_.sources(next).front());
    }
    amounts.push_back(std::move(at));
  }
  smoothWeights(weights, amounts, locked_);
}

SkinWeights mirroredWeights(const RiggedModel& rig, const PaintSurface& surface, const std::vector<bool>& locked,
                            MirrorFrom from) {
  if (from == MirrorFrom::kBoth) refuse("weights are mirrored from one side: left or right");
  const MirrorMap& map = requireMirror(surface);
  const RigMirror mirror = mirrorOfRig(rig, map.plane);
  SkinWeights weights = rig.weights;
  for (Index welded = 0; welded < map.image.size(); ++welded) {
    const Index image = map.image[welded];
    const double side = mirror.plane.normal.dot(surface.distance().mesh().position(welded)) - mirror.plane.offset;
    if (image == kNoIndex || (image != welded && (side > 0) == (from == MirrorFrom::kLeft))) continue;
    const std::span<const Index> sources = surface.sources(welded);
    std::map<Index, double> weightByJoint;
    for (const Influence& seen : influencesOf(rig.weights, surface.sources(image).front())) {
      const Index other = mirror.joints[seen.joint];
      weightByJoint[other == kNoIndex ? seen.joint : other] += seen.weight;
      if (image == welded) weightByJoint[seen.joint] += seen.weight;
    }
    std::vector<Influence> influences;
    for (const auto& [joint, weight] : weightByJoint) influences.push_back({joint, weight});
    WeightRow(weights, sources.front(), locked).replace(std::move(influences));
    for (const Index source : sources) copyRow(weights, sources.front(), source);
  }
  return weights;
}

std::optional<SurfaceHit> Brush::hit(const Ray& ray, const std::shared_ptr<const RiggedModel>& rig, const Pose& pose,
                                     const Deformer& deformer) {
  if (!picker_ || pickedRig_ != rig || pickedDeformer_ != &deformer || !samePose(pickedPose_, pose)) {
    picker_ = std::make_unique<SurfacePicker>(*rig, pose, deformer);
    pickedDeformer_ = &deformer;
    pickedRig_ = rig;
    pickedPose_ = pose;
  }
  return picker_->hit(ray);
}

const PaintSurface& Brush::surface(const RiggedModel& rig) {
  if (!surface_ || surface_->geometry().get() != &rig.geometry()) {
    stroke_.reset();
    surface_ = std::make_unique<PaintSurface>(rig.character.sharedSurface());
  }
  return *surface_;
}

SkinWeights Brush::preview(const std::shared_ptr<const RiggedModel>& rig, const std::vector<bool>& locked,
                           const PaintWeights& stroke) {
  const PaintSurface& on = surface(*rig);
  const bool same = stroke_ && paintedRig_ == rig && paintedLocks_ == locked && painted_.joint == stroke.joint &&
                    painted_.mode == stroke.mode && painted_.strength == stroke.strength &&
                    painted_.radius == stroke.radius && painted_.mirrored == stroke.mirrored &&
                    painted_.dabs.size() <= stroke.dabs.size() &&
                    std::equal(painted_.dabs.begin(), painted_.dabs.end(), stroke.dabs.begin());
  if (!same) {
    stroke_.reset();
    stroke_ = std::make_unique<WeightStroke>(*rig, on, locked, stroke);
    paintedRig_ = rig;
    paintedLocks_ = locked;
    painted_ = stroke;
    painted_.dabs.clear();
  }
  stroke_->add(std::span(stroke.dabs).subspan(painted_.dabs.size()));
  painted_.dabs = stroke.dabs;
  return stroke_->weights();
}

}  // namespace limber
