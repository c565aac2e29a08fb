#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limber/body/body_volume.h"
#include "limber/core/known_error.h"
#include "limber/core/numbers.h"
#include "limber/figure/figure_search.h"
#include "limber/rigging/person_template.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/surface/stray_pieces.h"
#include "limber/templates/arm_flatness.h"
#include "limber/templates/bent_template.h"
#include "limber/templates/figure_fit.h"
#include "limber/templates/finger_count.h"
#include "limber/templates/humanoid_landmarks.h"
#include "limber/templates/joints_between.h"
#include "limber/templates/pose_search.h"
#include "limber/templates/quadruped_landmarks.h"
#include "limber/templates/template_embedding.h"

namespace limber {

namespace {

constexpr std::size_t kCoarseSpheres = 120;        // for a first look at every way to stand
constexpr std::size_t kFramesRefined = 2;          // after it, with all spheres
constexpr std::size_t kVariantsRefined = 4;        // of each of these
constexpr double kSureEnough = 0.75;               // not to look for people, or for animals, in other poses
constexpr double kCostOfDoubt = 1.8;               // cost at which confidence is a half
constexpr double kOtherHands = 0.05;               // cost of fingers that hands lack, or that a template lacks
constexpr double kWings = 2;                       // cost of arms as flat as wings
constexpr double kRoundArm = 2.5, kFlatArm = 3.5;  // times as wide as thick
constexpr double kMostAsymmetry = 0.15;            // more than the most symmetric way to stand, of those looked at

// Each joint once, and where the model may be: the model's size beyond its box is another unit.
void checkPins(const TriMesh& mesh, const std::vector<JointPin>& pins) {
  Box box;
  for (const Vec3f& position : mesh.positions) box.add(position.cast<double>());
  const Vec3 margin = Vec3::Constant(box.longestSide());
  for (auto pin = pins.begin(); pin != pins.end(); ++pin) {
    const auto isSame = [&](const JointPin& other) { return other.joint == pin->joint; };
    if (std::any_of(pins.begin(), pin, isSame)) {
      throw Error(ErrorCode::kBadArgument, "is pinned twice", pin->joint, "give each joint one place");
    }
    const Vec3 low = box.min - margin, high = box.max + margin;
    if ((pin->place.array() < low.array()).any() || (pin->place.array() > high.array()).any()) {
      throw KnownError(ErrorKind::kPinOutside,
                       {ErrorCode::kBadArgument, "is pinned far outside the model", pin->joint,
                        "places are in the file's space and unit; limber info tells its size"},
                       {{"joint", pin->joint}});
    }
  }
}

TemplatePins pinsIn(const TemplateSkeleton& skeleton, const AnatomicalFrame& frame, const std::vector<JointPin>& pins) {
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

// A model as templates are tried on it.
struct Model {
  const BodyVolume& body;
  const std::vector<AnatomicalFrame>& frames;  // ways to stand, likeliest first
  const std::optional<Vec3> front;             // if it is known
};

struct Embedded {
  TemplateFit fit;
  TemplateEmbedder embedder;
};

// Looks at every way to stand with some of the spheres, and at the best ones with all.
Embedded bestEmbedding(const TemplateSkeleton& skeleton, const Model& model, const std::vector<JointPin>& pins) {
  const BodyVolume& body = model.body;
  const std::vector<AnatomicalFrame>& frames = model.frames;
  double least = 1;
  for (const AnatomicalFrame& frame : frames) least = std::min(least, frame.asymmetry);
  const std::vector<TemplateVariant> standing = templateVariants(skeleton);
  // For each way to stand the variants, best first.
  struct Look {
    AnatomicalFrame frame;
    double cost;
    std::vector<TemplateVariant> variants;
  };
  std::vector<Look> looks;
  for (const AnatomicalFrame& frame : frames) {
    if (frame.asymmetry > least + kMostAsymmetry) continue;
    const TemplatePins places = pinsIn(skeleton, frame, pins);
    std::vector<TemplateVariant> variants = standing;
    const std::vector<TemplateVariant> bent = bentToPins(skeleton, places);
    variants.insert(variants.end(), bent.begin(), bent.end());
    TemplateEmbedder coarse(skeleton, body, frame, places, {kCoarseSpheres, false});
    const std::vector<TemplateFit> fits = fitVariants(variants, coarse);
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
  std::optional<TemplateFit> best;
  std::optional<TemplateEmbedder> bestEmbedder;
  for (std::size_t i = 0; i < std::min(looks.size(), kFramesRefined); ++i) {
    const AnatomicalFrame& frame = looks[i].frame;
    TemplateEmbedder embedder(skeleton, body, frame, pinsIn(skeleton, frame, pins), {body.spheres.size(), true});
    std::vector<TemplateFit> fits = fitVariants(looks[i].variants, embedder);
    TemplateFit& fit = *std::min_element(fits.begin(), fits.end(), cheaper);
    if (best && !cheaper(fit, *best)) continue;
    best = std::move(fit);
    bestEmbedder = std::move(embedder);
  }
  return {std::move(*best), std::move(*bestEmbedder)};
}

// With what the body says of the limbs where they are now.
TemplateFit judged(TemplateFit fit, const BodyVolume& body) {
  fit.limbs = limbsIn(fit.skeleton, fit.embedding, body, fit.frame);
  const double flat = armFlatness(fit.skeleton, fit.embedding.places, body, fit.frame);
  fit.cost += kWings * std::clamp((flat - kRoundArm) / (kFlatArm - kRoundArm), 0.0, 1.0);
  return fit;
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

bool isSure(const TemplateFit& fit) {
  return confidenceOf(fit) > kSureEnough;
}

// The person in a model, in whatever pose, for all templates.
struct FigureOnce {
  bool wasSought = false;
  std::optional<MatchedFigure> figure;
};

std::optional<TemplateFit> figureFit(const TemplateSkeleton& skeleton, const Model& model,
                                     const std::vector<JointPin>& pins, FigureOnce& once, Progress& progress) {
  const AnatomicalFrame& frame = model.frames.front();
  const TemplatePins places = pinsIn(skeleton, frame, pins);
  if (!once.wasSought) {
    progress.step("find figure");
    const Vec3 up = frame.axes.row(1).transpose();
    once = {true, findFigure(model.body, {up, model.front, figurePins(skeleton, places, frame)}, progress)};
  }
  if (!once.figure) return {};
  return fitOfFigure(skeleton, *once.figure, places, frame);
}

// The template as it stands; where that is in doubt, a person in whatever pose; where that is, too, the template bent.
TemplateFit bestFit(const TemplateSkeleton& skeleton, const Model& model, const std::vector<JointPin>& pins,
                    FigureOnce& once, Progress& progress, bool inPoses = true) {
  progress.step("fit " + skeleton.name);
  Embedded embedded = bestEmbedding(skeleton, model, pins);
  TemplateFit fit = judged(embedded.fit, model.body);
  std::optional<TemplateFit> figure;
  if (isHumanoid(skeleton) && !fit.frame.symmetric() && !isSure(fit)) {
    figure = figureFit(skeleton, model, pins, once, progress);
    if (figure && isSure(*figure)) return *figure;
  }
  if (inPoses) {
    progress.step("bend " + skeleton.name);
    searchPose(embedded.embedder, embedded.fit);
    fit = judged(std::move(embedded.fit), model.body);
  }
  return figure && confidenceOf(*figure) > confidenceOf(fit) ? *figure : fit;
}

// Templates of people that differ in their fingers alone fit alike: hands tell.
void tellByFingers(const TriMesh& mesh, std::vector<TemplateFit>& fits) {
  for (TemplateFit& fit : fits) {
    if (!isHumanoid(fit.skeleton)) continue;
    const auto place = [&](const std::string& joint) {
      return fit.frame.fromBody(fit.embedding.places[fit.skeleton.find(joint).value()]);
    };
    std::size_t fingers = kHandWithFingers;
    for (const std::string side : {"left", "right"}) {
      fingers = std::min(fingers, countFingers(mesh, place(side + "Hand"), place(side + "HandTip")));
    }
    const bool has = fit.skeleton.find("leftIndexProximal").has_value();
    if (has != (fingers == kHandWithFingers)) fit.cost += kOtherHands;
  }
}

void warn(const TemplateFit& fit, AutoRig& rig) {
  if (const std::size_t missing = missingLimbs(fit); missing > 0) {
    rig.warnings.add("no-place", "limbs of the template have no place in the model",
                     limbsWithoutPlace(fit.skeleton, fit.limbs), missing);
  }
  const double confidence = confidenceOf(fit);
  if (confidence < kLikelyTemplate) {
    rig.warnings.add("low-confidence",
                     fmt::format("the model hardly looks like the template (confidence {:.2f})", confidence),
                     fit.skeleton.name);
  }
}

std::vector<TemplateMatch> matchesOf(const std::vector<TemplateFit>& fits) {
  std::vector<TemplateMatch> matches;
  for (const TemplateFit& fit : fits) matches.push_back({fit.skeleton.name, confidenceOf(fit)});
  return matches;
}

// Pinned joints are some template's: whoever pins one has chosen.
bool mayAbstain(const RigOptions& options) {
  return options.mayAbstain && options.templateName == "auto" && !options.templateSkeleton && options.pins.empty();
}

AutoRig withHandles(const TriMesh& mesh, const RigOptions& options, const TemplateFit& likeliest, Progress& progress) {
  AutoRig rig = rigWithSphereMesh(mesh, options, progress);
  rig.isAbstained = true;
  rig.warnings.add("no-template",
                   fmt::format("the model is like no template (the likeliest is {:.0f} % sure): it gets handles",
                               100 * confidenceOf(likeliest)),
                   likeliest.skeleton.name);
  return rig;
}

}  // namespace

TemplateFit fitTemplate(const TemplateSkeleton& skeleton, const TriMesh& mesh, const BodyVolume& body,
                        const RigOptions& options) {
  const std::vector<AnatomicalFrame> frames = possibleFrames(mesh, body, options.up, options.front);
  FigureOnce figure;
  Progress progress;
  return bestFit(skeleton, {body, frames, options.front}, options.pins, figure, progress);
}

Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& places,
                          const AnatomicalFrame& frame) {
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
  checkPins(mesh, options.pins);
  progress.step("measure body");
  const std::optional<TriMesh> cleared = withoutStrays(mesh);
  const TriMesh& surface = cleared ? *cleared : mesh;
  const BodyVolume body = measureBody(surface);
  const std::vector<AnatomicalFrame> frames = possibleFrames(surface, body, options.up, options.front);
  const Model model{body, frames, options.front};
  FigureOnce figure;
  std::vector<TemplateFit> fits;
  for (const TemplateSkeleton* candidate : candidates) {
    // Where it is a person, no poses of animals are tried.
    const bool inPoses = isHumanoid(*candidate) || std::none_of(fits.begin(), fits.end(), isSure);
    fits.push_back(bestFit(*candidate, model, pins, figure, progress, inPoses));
  }
  if (fits.size() > 1) tellByFingers(surface, fits);
  std::stable_sort(fits.begin(), fits.end(),
                   [](const TemplateFit& a, const TemplateFit& b) { return confidenceOf(a) > confidenceOf(b); });
  TemplateFit& best = fits.front();
  if (mayAbstain(options) && confidenceOf(best) < kLikelyTemplate) {
    AutoRig rig = withHandles(mesh, options, best, progress);
    rig.matches = matchesOf(fits);
    return rig;
  }
  if (person && confidenceOf(best) < kLikelyTemplate) {
    // The model may stand as the user's skeleton does, and as no person of ours.
    TemplateFit asItIs = bestFit(own, model, options.pins, figure, progress);
    if (confidenceOf(asItIs) > confidenceOf(best)) {
      best = std::move(asItIs);
      person.reset();
    }
  }

  refineHumanoid(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  placeBetween(best.skeleton, best.embedding.places);
  if (!best.skeleton.bent()) refineHocks(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  refineQuadruped(best.skeleton, body, best.frame, best.pins, best.embedding.places);
  findHeadless(best.skeleton, best.embedding.places, best.limbs);
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
  rig.up = best.frame.axes.row(1).transpose();
  rig.matches = matchesOf(fits);
  warn(best, rig);
  return rig;
}

}  // namespace limber
