#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "limber/core/numbers.h"
#include "limber/rigging/bent_template.h"
#include "limber/rigging/body_volume.h"
#include "limber/rigging/feet_direction.h"
#include "limber/rigging/humanoid_landmarks.h"
#include "limber/rigging/person_template.h"
#include "limber/rigging/quadruped_landmarks.h"
#include "limber/rigging/stray_pieces.h"
#include "limber/rigging/template_embedding.h"

namespace limber {

namespace {

constexpr std::size_t kCoarseSpheres = 120;  // for a first look at every way to stand
constexpr std::size_t kFramesRefined = 2;    // after it, with all spheres
constexpr std::size_t kVariantsRefined = 4;  // of each of these
constexpr double kOnGround = 0.1;            // heights of the tips of feet
constexpr int kMostBends = 6;
constexpr double kLowConfidence = 0.4;
constexpr double kCostOfDoubt = 1.8;  // cost at which confidence is a half
constexpr double kFeetBackward = 2;   // cost of footprints that lie half their length behind the legs
constexpr double kUnexplained = 2;    // cost of a body that no bone comes near
constexpr double kNearBone = 0.08;    // heights beyond the surface of a medial sphere
constexpr double kFarFromBone = 0.25;
constexpr double kMostAsymmetry = 0.15;  // more than the most symmetric way to stand, of those looked at

TemplatePins pinsIn(const TemplateSkeleton& skeleton, const BodyFrame& frame, const std::vector<JointPin>& pins) {
  TemplatePins places(skeleton.jointCount());
  for (const JointPin& pin : pins) {
    const std::optional<Index> joint = skeleton.find(pin.joint);
    if (!joint) {
      std::string known;
      for (const TemplateJoint& other : skeleton.joints) known += (known.empty() ? "" : ", ") + other.name;
      throw Error(ErrorCode::kBadArgument, fmt::format("the template has no joint '{}' to pin", pin.joint),
                  skeleton.name, "it has: " + known);
    }
    places[*joint] = frame.toBody(pin.place);
  }
  return places;
}

// What speaks against a way to stand before the model is looked at: files mostly have +Y or +Z up, and the front
// towards the viewer.
double unusual(const BodyFrame& frame) {
  const Vec3 up = frame.axes.row(1).transpose(), front = frame.axes.row(2).transpose();
  const bool yUp = up.y() > 0.9, zUp = up.z() > 0.9;
  const double upCost = yUp ? 0 : zUp ? 0.2 : 0.8;
  const bool usualFront = yUp ? front.z() > 0.9 : zUp ? front.y() < -0.9 : true;
  return upCost + (usualFront ? 0 : 0.6);
}

// How far a place is from all bones, beyond `radius`: 0 near one, 1 where kFarFromBone or farther.
double farFromBones(const TemplateSkeleton& skeleton, const std::vector<Vec3>& places, const Vec3& place,
                    double radius) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) continue;
    const Vec3 &a = places[*skeleton.joints[j].parent], bone = places[j] - a;
    const double along = std::clamp((place - a).dot(bone) / std::max(bone.squaredNorm(), 1e-12), 0.0, 1.0);
    nearest = std::min(nearest, (place - a - along * bone).squaredNorm());
  }
  const double beyond = std::sqrt(nearest) - radius;
  return std::clamp((beyond - kNearBone) / (kFarFromBone - kNearBone), 0.0, 1.0);
}

// How much of the body no bone comes near, 0 to 1: in equal parts of its medial spheres, and of the ends of its limbs
// by how far these reach.
double unexplained(const TemplateSkeleton& skeleton, const std::vector<Vec3>& places, const BodyVolume& body,
                   const BodyFrame& frame) {
  double spheres = 0, tips = 0, reach = 0;
  for (const MedialSphere& sphere : body.spheres) {
    const double far = farFromBones(skeleton, places, frame.toBody(sphere.center), sphere.radius / frame.height);
    spheres += far / static_cast<double>(body.spheres.size());
  }
  for (const BodyTip& tip : body.tips) {
    tips += tip.reach * farFromBones(skeleton, places, frame.toBody(tip.position), 0);
    reach += tip.reach;
  }
  return 0.5 * (spheres + tips / std::max(reach, 1e-12));
}

bool cheaper(const TemplateFit& a, const TemplateFit& b) {
  return a.cost < b.cost;
}

// Of the placed joints that hold the tips on the ground.
std::vector<Vec3> feetOf(const TemplateSkeleton& skeleton, const std::vector<Vec3>& places) {
  std::vector<Vec3> feet;
  for (const TemplateJoint& tip : skeleton.joints) {
    if (tip.role != TemplateRole::kTip || tip.place.y() > kOnGround || !tip.parent) continue;
    Index foot = *tip.parent;
    while (skeleton.joints[foot].role == TemplateRole::kBetween && skeleton.joints[foot].parent) {
      foot = *skeleton.joints[foot].parent;
    }
    feet.push_back(places[foot]);
  }
  return feet;
}

// One fit for each variant.
void addFits(const std::vector<TemplateVariant>& variants, const BodyVolume& body, const BodyFrame& frame,
             const std::vector<JointPin>& pins, const EmbeddingOptions& options, std::vector<TemplateFit>& fits) {
  const TemplatePins places = pinsIn(variants.front().skeleton, frame, pins);
  std::vector<TemplateEmbedding> embeddings = embedTemplate(variants, body, frame, places, options);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const double left = unexplained(variants[v].skeleton, embeddings[v].places, body, frame);
    const double cost = embeddings[v].cost + unusual(frame) + kUnexplained * left;
    fits.push_back({variants[v].skeleton, frame, places, std::move(embeddings[v]), cost, {}});
  }
  // Feet point to the front, whichever way the rest of a body may be read; told once, by the best of them.
  const auto first = fits.end() - static_cast<std::ptrdiff_t>(variants.size());
  const TemplateFit& best = *std::min_element(first, fits.end(), cheaper);
  const double forward = feetForward(body, frame, feetOf(best.skeleton, best.embedding.places));
  for (auto fit = first; fit != fits.end(); ++fit) fit->cost += kFeetBackward * std::max(0.0, -forward);
}

// A bent template is bent further, to where its joints were found, and embedded anew, as long as that comes nearer.
void bendNearer(const BodyVolume& body, const std::vector<JointPin>& pins, TemplateFit& fit) {
  for (int bend = 0; bend < kMostBends; ++bend) {
    std::vector<TemplateFit> fits;
    addFits(bentToPins(fit.skeleton, fit.pins, fit.embedding.places), body, fit.frame, pins,
            {body.spheres.size(), true}, fits);
    TemplateFit& nearest = *std::min_element(fits.begin(), fits.end(), cheaper);
    if (!cheaper(nearest, fit)) return;
    fit = std::move(nearest);
  }
}

// Looks at every way to stand with some of the spheres, and at the best ones with all.
TemplateFit bestFit(const TemplateSkeleton& skeleton, const BodyVolume& body, const std::vector<BodyFrame>& frames,
                    const std::vector<JointPin>& pins) {
  double least = 1;
  for (const BodyFrame& frame : frames) least = std::min(least, frame.asymmetry);
  const std::vector<TemplateVariant> standing = templateVariants(skeleton);
  // For each way to stand the variants, best first.
  struct Look {
    BodyFrame frame;
    double cost;
    std::vector<TemplateVariant> variants;
  };
  std::vector<Look> looks;
  for (const BodyFrame& frame : frames) {
    if (frame.asymmetry > least + kMostAsymmetry) continue;
    std::vector<TemplateVariant> variants = standing;
    const std::vector<TemplateVariant> bent = bentToPins(skeleton, pinsIn(skeleton, frame, pins));
    variants.insert(variants.end(), bent.begin(), bent.end());
    std::vector<TemplateFit> fits;
    addFits(variants, body, frame, pins, {kCoarseSpheres, false}, fits);
    std::vector<std::size_t> order(fits.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cheaper(fits[a], fits[b]); });
    order.resize(std::min(order.size(), kVariantsRefined));
    Look look = {frame, fits[order.front()].cost, {}};
    for (const std::size_t v : order) look.variants.push_back(variants[v]);
    looks.push_back(std::move(look));
  }
  std::stable_sort(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.cost < b.cost; });
  std::vector<TemplateFit> fits;
  for (std::size_t i = 0; i < std::min(looks.size(), kFramesRefined); ++i) {
    addFits(looks[i].variants, body, looks[i].frame, pins, {body.spheres.size(), true}, fits);
  }
  TemplateFit best = *std::min_element(fits.begin(), fits.end(), cheaper);
  if (best.skeleton.bent()) bendNearer(body, pins, best);
  best.limbs = limbsIn(best.skeleton, best.embedding, body, best.frame);
  return best;
}

std::size_t missingLimbs(const TemplateFit& fit) {
  return static_cast<std::size_t>(
      std::count_if(fit.limbs.begin(), fit.limbs.end(), [](const TemplateLimb& limb) { return !limb.hasPlace; }));
}

// By the cost, and by the share of limbs that have a place: half a body is soon no body.
double confidenceOf(const TemplateFit& fit) {
  const double placed = 1 - static_cast<double>(missingLimbs(fit)) / static_cast<double>(fit.limbs.size());
  return placed * placed * placed / (1 + std::pow(fit.cost / kCostOfDoubt, 3.0));
}

void warn(const TemplateFit& fit, AutoRig& rig) {
  if (const std::size_t missing = missingLimbs(fit); missing > 0) {
    rig.warnings.add("no-place", "limbs of the template have no place in the model",
                     limbsWithoutPlace(fit.skeleton, fit.limbs), missing);
  }
  const double confidence = confidenceOf(fit);
  if (confidence < kLowConfidence) {
    rig.warnings.add("low-confidence",
                     fmt::format("the model hardly looks like the template (confidence {:.2f})", confidence),
                     fit.skeleton.name);
  }
}

}  // namespace

TemplateFit fitTemplate(const TemplateSkeleton& skeleton, const TriMesh& mesh, const BodyVolume& body,
                        const RigOptions& options) {
  return bestFit(skeleton, body, possibleFrames(mesh, body, options.up, options.front), options.pins);
}

Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& places, const BodyFrame& frame) {
  const Index count = skeleton.jointCount();
  std::vector<std::optional<Index>> next(count);
  for (Index j = 0; j < count; ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (parent && (!next[*parent] || skeleton.joints[j].role == TemplateRole::kTip)) next[*parent] = j;
  }
  const Vec3 front = frame.axes.row(2).transpose(), up = frame.axes.row(1).transpose();
  std::vector<Affine> globals(count);
  std::vector<std::optional<Index>> kept(count);
  Skeleton result;
  for (Index j = 0; j < count; ++j) {
    const TemplateJoint& from = skeleton.joints[j];
    if (from.role == TemplateRole::kTip) continue;
    const Vec3 position = frame.fromBody(places[j]);
    Vec3 bone = next[j] ? Vec3(frame.fromBody(places[*next[j]]) - position) : Vec3(Vec3::Zero());
    if (!(bone.norm() > 1e-9)) bone = from.parent ? Vec3(globals[*from.parent].linear().col(1)) : up;
    const Vec3 y = bone.normalized();
    const Vec3& toward = std::abs(y.dot(front)) > std::cos(kPi / 6) ? up : front;
    const Vec3 z = (toward - toward.dot(y) * y).normalized();
    Mat3 rotation;
    rotation << y.cross(z), y, z;
    globals[j].linear() = rotation;
    globals[j].translation() = position;
    globals[j].makeAffine();
    Joint joint;
    joint.name = from.name;
    if (from.parent) joint.parent = kept[*from.parent];
    const Affine above = from.parent ? globals[*from.parent] : Affine::Identity();
    joint.rest = decompose(above.inverse(Eigen::Isometry) * globals[j]);
    joint.rest.scale = Vec3::Ones();
    kept[j] = result.jointCount();
    result.joints.push_back(std::move(joint));
  }
  return result;
}

AutoRig rigWithTemplate(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  std::vector<const TemplateSkeleton*> candidates;
  TemplateSkeleton own;
  std::optional<PersonTemplate> person;
  if (options.templateSkeleton) {
    own = templateFrom(*options.templateSkeleton, options.templateName);
    person = personTemplate(*options.templateSkeleton, own);
    candidates = {person ? &findTemplate("humanoid") : &own};
  } else if (options.templateName == "auto") {
    for (const TemplateSkeleton& skeleton : templateSkeletons()) candidates.push_back(&skeleton);
  } else {
    candidates = {&findTemplate(options.templateName)};
  }
  const std::vector<JointPin> pins = person ? humanoidPins(*person, options.pins) : options.pins;
  progress.step("measure body");
  const std::optional<TriMesh> cleared = withoutStrays(mesh);
  const TriMesh& surface = cleared ? *cleared : mesh;
  const BodyVolume body = measureBody(surface);
  progress.step("fit template");
  const std::vector<BodyFrame> frames = possibleFrames(surface, body, options.up, options.front);
  std::vector<TemplateFit> fits;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(candidates.size()));
    fits.push_back(bestFit(*candidates[i], body, frames, pins));
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const TemplateFit& a, const TemplateFit& b) { return confidenceOf(a) > confidenceOf(b); });
  TemplateFit& best = fits.front();
  if (person && confidenceOf(best) < kLowConfidence) {
    // The model may stand as the user's skeleton does, and as no person of ours.
    TemplateFit asItIs = bestFit(own, body, frames, options.pins);
    if (confidenceOf(asItIs) > confidenceOf(best)) {
      best = std::move(asItIs);
      person.reset();
    }
  }

  if (!best.skeleton.bent()) refineHumanoid(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  placeBetween(best.skeleton, best.embedding.places);
  if (!best.skeleton.bent()) refineHocks(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  refineQuadruped(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  AutoRig rig;
  if (person) {
    const TemplatePins ownPins = pinsIn(person->skeleton, best.frame, options.pins);
    const std::vector<Vec3> places = placePerson(*person, best.embedding.places, ownPins);
    rig.skeleton = standingSkeleton(person->skeleton, places, best.frame);
    best.skeleton = humanoidNamedAs(*person, std::move(best.skeleton));
  } else {
    rig.skeleton = standingSkeleton(best.skeleton, best.embedding.places, best.frame);
  }
  if (cleared) {
    rig.warnings.add("stray-pieces", "triangles that float about the model are left out of account", {},
                     mesh.triangleCount() - cleared->triangleCount());
  }
  for (const TemplateFit& fit : fits) rig.matches.push_back({fit.skeleton.name, confidenceOf(fit)});
  warn(best, rig);
  return rig;
}

}  // namespace limber
