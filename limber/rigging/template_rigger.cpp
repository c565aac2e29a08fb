#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/surface/stray_pieces.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/figure/figure_search.h"
#include "limber/rigging/person_template.h"
#include "limber/rigging/read_template.h"
#include "limber/rigging/shape/plan_fit.h"
#include "limber/rigging/shape/shape_reading.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/rigging/templates/arm_flatness.h"
#include "limber/rigging/templates/bent_template.h"
#include "limber/rigging/templates/figure_fit.h"
#include "limber/rigging/templates/finger_count.h"
#include "limber/rigging/templates/humanoid_landmarks.h"
#include "limber/rigging/templates/joints_between.h"
#include "limber/rigging/templates/pose_search.h"
#include "limber/rigging/templates/quadruped_landmarks.h"
#include "limber/rigging/templates/template_embedding.h"

namespace limber {

// What all templates are tried on.
struct MeasuredModel {
  Index vertices = 0, triangles = 0;  // of the mesh
  std::optional<Vec3> up, front;      // as they were given
  std::optional<TriMesh> cleared;     // of stray pieces; none where the mesh has none
  BodyVolume body;
  std::vector<AnatomicalFrame> frames;
  std::optional<ShapeReading> shape;
};

namespace {

constexpr std::size_t kCoarseSpheres = 120;        // for a first look at every orientation
constexpr std::size_t kFramesRefined = 2;          // after it, with all spheres
constexpr std::size_t kVariantsRefined = 4;        // of each of these
constexpr double kCostOfDoubt = 1.8;               // cost at which confidence is a half
constexpr double kOtherHands = 0.05;               // cost of fingers that hands lack, or that a template lacks
constexpr double kWings = 2;                       // cost of arms as flat as wings
constexpr double kRoundArm = 2.5, kFlatArm = 3.5;  // times as wide as thick
constexpr double kVoteOfShape = 8;                 // times the odds of a template that has the plan of a sure shape
constexpr double kSureShape = 0.9;        // confidence of a shape from which on templates of other plans are not tried
constexpr double kLongLimb = 0.1;         // heights; fingers are shorter
constexpr double kCostOfUnmatched = 100;  // above the cost of any limb that has one
constexpr double kMaxAsymmetry = 0.15;    // more than the most symmetric orientation, of those looked at

// Each joint once, and where the model may be: the model's size beyond its box is another unit.
void checkPins(const TriMesh& mesh, const std::vector<JointPin>& pins) {
  const Box box = modelBox(mesh);
  const Vec3 margin = Vec3::Constant(box.longestSide());
  for (auto pin = pins.begin(); pin != pins.end(); ++pin) {
    const auto isSame = [&](const JointPin& other) { return other.joint == pin->joint; };
    if (std::any_of(pins.begin(), pin, isSame)) {
      throw Error(ErrorCode::kBadArgument, "is pinned twice", pin->joint, "give each joint one place");
    }
    const Vec3 low = box.min - margin, high = box.max + margin;
    if ((pin->position.array() < low.array()).any() || (pin->position.array() > high.array()).any()) {
      throw KnownError(ErrorKind::kPinOutside,
                       {ErrorCode::kBadArgument, "is pinned far outside the model", pin->joint,
                        "places are in the file's space and unit; limber info tells its size"},
                       {{"joint", pin->joint}});
    }
  }
}

TemplatePins pinsIn(const TemplateSkeleton& skeleton, const AnatomicalFrame& frame, const std::vector<JointPin>& pins) {
  TemplatePins positions(skeleton.jointCount());
  for (const JointPin& pin : pins) {
    const std::optional<Index> joint = skeleton.find(pin.joint);
    if (!joint) {
      std::string known;
      for (const TemplateJoint& other : skeleton.joints) known += (known.empty() ? "" : ", ") + other.name;
      throw Error(ErrorCode::kBadArgument, fmt::format("the template has no joint '{}' to pin", pin.joint),
                  skeleton.name, "it has: " + known);
    }
    positions[*joint] = frame.toBody(pin.position);
  }
  return positions;
}

// A model as templates are tried on it.
struct Model {
  const BodyVolume& body;
  const std::vector<AnatomicalFrame>& frames;  // orientations, likeliest first
  const std::optional<Vec3> front;             // if it is known
};

struct Embedded {
  TemplateFit fit;
  TemplateEmbedder embedder;
};

// Looks at every orientation with some of the spheres, and at the best ones with all.
Embedded bestEmbedding(const TemplateSkeleton& skeleton, const Model& model, const std::vector<JointPin>& pins) {
  const BodyVolume& body = model.body;
  const std::vector<AnatomicalFrame>& frames = model.frames;
  double least = 1;
  for (const AnatomicalFrame& frame : frames) least = std::min(least, frame.asymmetry);
  const std::vector<TemplateVariant> standing = templateVariants(skeleton);
  // For each orientation the variants, best first.
  struct Look {
    AnatomicalFrame frame;
    double cost;
    std::vector<TemplateVariant> variants;
  };
  std::vector<Look> looks;
  for (const AnatomicalFrame& frame : frames) {
    if (frame.asymmetry > least + kMaxAsymmetry) continue;
    const TemplatePins positions = pinsIn(skeleton, frame, pins);
    std::vector<TemplateVariant> variants = standing;
    const std::vector<TemplateVariant> bent = bentToPins(skeleton, positions);
    variants.insert(variants.end(), bent.begin(), bent.end());
    TemplateEmbedder coarse(skeleton, body, frame, positions, {kCoarseSpheres, false});
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
  const double flat = armFlatness(fit.skeleton, fit.embedding.positions, body, fit.frame);
  fit.cost += kWings * std::clamp((flat - kRoundArm) / (kFlatArm - kRoundArm), 0.0, 1.0);
  return fit;
}

std::size_t missingLimbs(const std::vector<TemplateLimb>& limbs) {
  return static_cast<std::size_t>(
      std::count_if(limbs.begin(), limbs.end(), [](const TemplateLimb& limb) { return !limb.hasMatch; }));
}

// From the cost and the fraction of limbs that have a match: it falls fast with each missing limb.
double confidenceOf(const TemplateFit& fit) {
  const double placed = 1 - static_cast<double>(missingLimbs(fit.limbs)) / static_cast<double>(fit.limbs.size());
  return placed * placed * placed / (1 + std::pow(fit.cost / kCostOfDoubt, 3.0));
}

bool isSure(const TemplateFit& fit) {
  return confidenceOf(fit) > kSureTemplate;
}

// The person in a model, in whatever pose, for all templates.
struct FigureOnce {
  bool wasSought = false;
  std::optional<MatchedFigure> figure;
};

std::optional<TemplateFit> figureFit(const TemplateSkeleton& skeleton, const Model& model,
                                     const std::vector<JointPin>& pins, FigureOnce& once, Progress& progress) {
  const AnatomicalFrame& frame = model.frames.front();
  const TemplatePins positions = pinsIn(skeleton, frame, pins);
  if (!once.wasSought) {
    progress.step("find figure");
    const Vec3 up = frame.axes.row(1).transpose();
    once = {true, findFigure(model.body, {up, model.front, figurePins(skeleton, positions, frame)}, progress)};
  }
  if (!once.figure) return {};
  return fitOfFigure(skeleton, *once.figure, positions, frame);
}

// The template in its neutral pose; at low confidence a person in any pose; at low confidence in that, the template
// bent.
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
    const auto positionOf = [&](const std::string& joint) {
      return fit.frame.fromBody(fit.embedding.positions[fit.skeleton.find(joint).value()]);
    };
    std::size_t fingers = kHandWithFingers;
    for (const std::string side : {"left", "right"}) {
      fingers = std::min(fingers, countFingers(mesh, positionOf(side + "Hand"), positionOf(side + "HandTip")));
    }
    const bool has = fit.skeleton.find("leftIndexProximal").has_value();
    if (has != (fingers == kHandWithFingers)) fit.cost += kOtherHands;
  }
}

// A template as it was fitted, and how sure it is that the model is of its kind.
struct Hypothesis {
  TemplateFit fit;
  double vote = 0;               // of the shape, -1 to 1 (voteOf)
  std::optional<double> byPlan;  // the confidence of what is laid along the shape's curves

  double confidence() const {
    if (byPlan) return *byPlan;
    const double own = confidenceOf(fit), odds = std::pow(kVoteOfShape, vote);
    return odds * own / (1 + (odds - 1) * own);
  }
};

bool isQuadruped(const TemplateSkeleton& skeleton) {
  return skeleton.find("leftFrontUpperLeg").has_value();
}

// What the shape says of a template: 1 for it, -1 against it, 0 nothing, and between as far as its plan is sure.
double voteOf(const ShapeReading& shape, const TemplateSkeleton& skeleton) {
  const auto has = [&](BodyPlan plan) { return shape.plan == plan ? shape.confidence : -shape.confidence; };
  if (isHumanoid(skeleton) && shape.plan != BodyPlan::kUnknown) return has(BodyPlan::kUpright);
  if (isQuadruped(skeleton) && shape.plan != BodyPlan::kUnknown) return has(BodyPlan::kFourLegs);
  if (!skeleton.find("leftUpperWing")) return 0;
  // Birds are seen to stand on two legs, or on none that are thick enough.
  const bool mayBeBird =
      shape.plan == BodyPlan::kUpright || shape.plan == BodyPlan::kTwoLegs || shape.plan == BodyPlan::kUnknown;
  if (!mayBeBird) return -shape.confidence;
  return shape.wings() ? 1 : 0;
}

// Whether it is worth while to try a template where the shape is sure of what it is.
bool mayBe(const TemplateSkeleton& skeleton, const std::optional<ShapeReading>& shape) {
  return !shape || shape->confidence < kSureShape || voteOf(*shape, skeleton) >= 0;
}

// Those that face as the shape of a four-legged animal does, where it is surely one; else all.
std::vector<AnatomicalFrame> framesLike(const std::optional<ShapeReading>& shape,
                                        const std::vector<AnatomicalFrame>& frames) {
  const bool isSure = shape && shape->plan == BodyPlan::kFourLegs && shape->confidence > kSureTemplate;
  if (!isSure || !shape->frame.isFrontRead) return frames;
  return {shape->frame};
}

Hypothesis hypothesisOf(TemplateFit fit, const std::optional<ShapeReading>& shape) {
  const double vote = shape ? voteOf(*shape, fit.skeleton) : 0;
  return {std::move(fit), vote, {}};
}

// Laid along the shape's curves, with its pins.
Hypothesis planHypothesis(const PlanKind& kind, const ShapeReading& shape, const std::vector<JointPin>& pins) {
  TemplateFit fit = fitPlan(kind, shape);
  fit.pins = pinsIn(fit.skeleton, fit.frame, pins);
  for (Index j = 0; j < fit.skeleton.jointCount(); ++j) {
    if (!fit.pins[j]) continue;
    fit.embedding.positions[j] = *fit.pins[j];
    const std::optional<Index> mirror = fit.skeleton.joints[j].mirror;
    if (mirror && !fit.pins[*mirror]) fit.embedding.positions[*mirror] = fit.pins[j]->cwiseProduct(Vec3(-1, 1, 1));
  }
  return {std::move(fit), 0, likelihood(kind, shape)};
}

// Pinned joints are some template's: whoever pins one has chosen.
bool leavesTheChoice(const RigOptions& options) {
  return options.templateName == "auto" && !options.templateSkeleton && options.pins.empty();
}

std::shared_ptr<const MeasuredModel> measure(const TriMesh& mesh, const RigOptions& options) {
  if (options.memory && options.memory->measured) {
    const MeasuredModel& known = *options.memory->measured;
    const bool isSame = known.vertices == mesh.vertexCount() && known.triangles == mesh.triangleCount();
    if (isSame && known.up == options.up && known.front == options.front) return options.memory->measured;
  }
  auto model = std::make_shared<MeasuredModel>();
  model->vertices = mesh.vertexCount();
  model->triangles = mesh.triangleCount();
  model->up = options.up;
  model->front = options.front;
  model->cleared = withoutStrays(mesh);
  const TriMesh& surface = model->cleared ? *model->cleared : mesh;
  model->body = measureBody(surface);
  model->frames = possibleFrames(surface, model->body, options.up, options.front);
  model->shape = readShape(model->body, model->frames, options.front.has_value());
  if (options.memory) options.memory->measured = model;
  return model;
}

// Kinds of the shape's plan, of all or the one that is asked for.
std::vector<Hypothesis> planHypotheses(const std::optional<ShapeReading>& shape, const PlanKind* asked,
                                       const std::vector<JointPin>& pins) {
  if (asked && !shape) {
    throw Error(ErrorCode::kUnsupported,
                "the model has no trunk between two sides that are alike, whose curves could be followed",
                std::string(asked->name),
                "`up` and `front` say how it stands; humanoid, quadruped and bird need neither");
  }
  std::vector<Hypothesis> hypotheses;
  if (asked) {
    hypotheses.push_back(planHypothesis(*asked, *shape, pins));
  } else if (shape) {
    for (const PlanKind& kind : planKinds()) {
      if (likelihood(kind, *shape) > 0) hypotheses.push_back(planHypothesis(kind, *shape, pins));
    }
  }
  return hypotheses;
}

void warnOfStrays(const TriMesh& mesh, const std::optional<TriMesh>& cleared, AutoRig& rig) {
  if (!cleared) return;
  rig.warnings.add("stray-pieces", "triangles that float about the model are left out of account", {},
                   mesh.triangleCount() - cleared->triangleCount());
}

void warnOfMissingLimbs(const TemplateSkeleton& skeleton, const std::vector<TemplateLimb>& limbs, AutoRig& rig) {
  const std::size_t missing = missingLimbs(limbs);
  if (missing == 0) return;
  rig.warnings.add("no-place", "limbs of the template have no place in the model", unmatchedLimbs(skeleton, limbs),
                   missing);
}

void warn(const Hypothesis& hypothesis, AutoRig& rig) {
  const TemplateFit& fit = hypothesis.fit;
  warnOfMissingLimbs(fit.skeleton, fit.limbs, rig);
  if (hypothesis.confidence() < kLikelyTemplate) {
    rig.warnings.add(
        "low-confidence",
        fmt::format("the model hardly looks like the template (confidence {:.2f})", hypothesis.confidence()),
        fit.skeleton.name);
  }
}

// How badly a limb fits the model: the mean cost of its joints. Of bodies laid along curves, which have no costs, long
// limbs come before short ones.
double doubtOf(const Hypothesis& hypothesis, const TemplateLimb& limb, double length) {
  if (hypothesis.byPlan) return length;
  double cost = 0;
  for (const Index joint : limb.placed) cost += hypothesis.fit.embedding.costs[joint];
  cost /= static_cast<double>(std::max<std::size_t>(1, limb.placed.size()));
  return limb.hasMatch ? cost : kCostOfUnmatched + cost;
}

std::vector<std::string> doubtsOf(const Hypothesis& hypothesis) {
  std::vector<std::string> doubts;
  if (hypothesis.confidence() >= kSureTemplate) return doubts;
  const TemplateFit& fit = hypothesis.fit;
  const std::vector<TemplateJoint>& joints = fit.skeleton.joints;
  struct Limb {
    Index end;
    double doubt;
  };
  std::vector<Limb> limbs;
  std::vector<bool> parts(joints.size(), false);
  for (const TemplateJoint& joint : joints) {
    if (joint.parent && joint.role != TemplateRole::kTip) parts[*joint.parent] = true;
  }
  for (const TemplateLimb& limb : fit.limbs) {
    if (limb.joints.empty()) continue;
    const Index end = limb.joints.back();
    double length = 0;
    for (const Index joint : limb.joints) {
      if (joints[joint].parent) length += (joints[joint].position - joints[*joints[joint].parent].position).norm();
    }
    const std::optional<Index> mirror = joints[end].mirror;
    const bool isPinned = fit.pins[end] || (mirror && fit.pins[*mirror]);
    if (parts[end] || length < kLongLimb || isPinned) continue;
    const double doubt = doubtOf(hypothesis, limb, length);
    const auto other = std::find_if(limbs.begin(), limbs.end(), [&](const Limb& known) { return known.end == mirror; });
    if (other == limbs.end()) {
      limbs.push_back({end, doubt});
    } else if (doubt > other->doubt) {
      *other = {end, doubt};
    }
  }
  std::stable_sort(limbs.begin(), limbs.end(), [](const Limb& a, const Limb& b) { return a.doubt > b.doubt; });
  for (const Limb& limb : limbs) {
    if (doubts.size() < kMaxDoubts) doubts.push_back(joints[limb.end].name);
  }
  return doubts;
}

std::vector<TemplateMatch> matchesOf(const std::vector<Hypothesis>& hypotheses) {
  std::vector<TemplateMatch> matches;
  for (const Hypothesis& hypothesis : hypotheses)
    matches.push_back({hypothesis.fit.skeleton.name, hypothesis.confidence()});
  return matches;
}

AutoRig asRead(const ReadTemplate& read, const TriMesh& mesh, const std::optional<TriMesh>& cleared) {
  AutoRig rig;
  rig.skeleton = standingSkeleton(read.skeleton, read.positions, read.frame);
  rig.matches = read.matches;
  rig.doubts = read.doubts;
  rig.up = read.frame.axes.row(1).transpose();
  warnOfStrays(mesh, cleared, rig);
  warnOfMissingLimbs(read.skeleton, read.limbs, rig);
  return rig;
}

AutoRig withHandles(const TriMesh& mesh, const RigOptions& options, const Hypothesis& likeliest, Progress& progress) {
  AutoRig rig = rigWithSphereMesh(mesh, options, progress);
  rig.isAbstained = true;
  rig.warnings.add("no-template",
                   fmt::format("the model is like no template (the likeliest is {:.0f} % sure): it gets handles",
                               100 * likeliest.confidence()),
                   likeliest.fit.skeleton.name);
  return rig;
}

}  // namespace

std::vector<NamedTemplate> namedTemplates() {
  std::vector<NamedTemplate> named;
  for (const TemplateSkeleton& skeleton : templateSkeletons()) named.push_back({skeleton.name, skeleton.summary});
  for (const PlanKind& kind : planKinds()) named.push_back({kind.name, kind.summary});
  return named;
}

void checkTemplateName(std::string_view name) {
  std::string known = "auto";
  bool isKnown = name == known;
  for (const NamedTemplate& named : namedTemplates()) {
    isKnown = isKnown || named.name == name;
    known += ", " + std::string(named.name);
  }
  if (isKnown) return;
  throw Error(ErrorCode::kBadArgument, fmt::format("no template is called '{}'", name), {}, "there are: " + known);
}

TemplateFit fitTemplate(const TemplateSkeleton& skeleton, const TriMesh& mesh, const BodyVolume& body,
                        const RigOptions& options) {
  const std::vector<AnatomicalFrame> frames = possibleFrames(mesh, body, options.up, options.front);
  FigureOnce figure;
  Progress progress;
  return bestFit(skeleton, {body, frames, options.front}, options.pins, figure, progress);
}

Skeleton standingSkeleton(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
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
    const Vec3 position = frame.fromBody(positions[j]);
    Vec3 bone = next[j] ? Vec3(frame.fromBody(positions[*next[j]]) - position) : Vec3(Vec3::Zero());
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
  if (!options.templateSkeleton) checkTemplateName(options.templateName);
  std::vector<const TemplateSkeleton*> candidates;
  const PlanKind* plan = options.templateSkeleton ? nullptr : findPlanKind(options.templateName);
  TemplateSkeleton own;
  std::optional<PersonTemplate> person;
  if (options.templateSkeleton) {
    own = templateFrom(*options.templateSkeleton, options.templateName);
    person = personTemplate(*options.templateSkeleton, own);
    candidates = {person ? &findTemplate("humanoid") : &own};
  } else if (options.templateName == "auto") {
    for (const TemplateSkeleton& skeleton : templateSkeletons()) candidates.push_back(&skeleton);
  } else if (!plan) {
    candidates = {&findTemplate(options.templateName)};
  }
  const std::vector<JointPin> pins = person ? humanoidPins(*person, options.pins) : options.pins;
  checkPins(mesh, options.pins);
  progress.step("measure body");
  const std::shared_ptr<const MeasuredModel> measured = measure(mesh, options);
  const std::optional<TriMesh>& cleared = measured->cleared;
  const TriMesh& surface = cleared ? *cleared : mesh;
  const BodyVolume& body = measured->body;
  const std::vector<AnatomicalFrame>& frames = measured->frames;
  const std::optional<ShapeReading>& shape = measured->shape;
  const Model model{body, frames, options.front};
  // Animals face as their shape says: heads and tails look alike to a template.
  const std::vector<AnatomicalFrame> likeShape = framesLike(shape, frames);
  const Model animal{body, likeShape, options.front};
  FigureOnce figure;
  std::vector<TemplateFit> fits;
  if (leavesTheChoice(options)) {
    std::erase_if(candidates, [&](const TemplateSkeleton* candidate) { return !mayBe(*candidate, shape); });
  }
  for (const TemplateSkeleton* candidate : candidates) {
    // Where it is a person, no poses of animals are tried.
    const bool inPoses = isHumanoid(*candidate) || std::none_of(fits.begin(), fits.end(), isSure);
    fits.push_back(bestFit(*candidate, isQuadruped(*candidate) ? animal : model, pins, figure, progress, inPoses));
  }
  if (fits.size() > 1) tellByFingers(surface, fits);
  std::vector<Hypothesis> hypotheses;
  for (TemplateFit& fit : fits) hypotheses.push_back(hypothesisOf(std::move(fit), shape));
  if (plan || leavesTheChoice(options)) {
    for (Hypothesis& hypothesis : planHypotheses(shape, plan, pins)) hypotheses.push_back(std::move(hypothesis));
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.confidence() > b.confidence(); });
  Hypothesis& likeliest = hypotheses.front();
  if (options.mayAbstain && leavesTheChoice(options) && likeliest.confidence() < kLikelyTemplate) {
    progress.step("read shape");
    const std::shared_ptr<const ReadingWeights> weights = options.reading ? options.reading : shapeWeights();
    const std::optional<ReadTemplate> read = readTemplate(surface, body, frames, *weights);
    // The search finds people better than the reading, which takes heads and hands for some.
    if (read && !isHumanoid(read->skeleton)) return asRead(*read, mesh, cleared);
    AutoRig rig = withHandles(mesh, options, likeliest, progress);
    rig.matches = matchesOf(hypotheses);
    return rig;
  }
  if (person && likeliest.confidence() < kLikelyTemplate) {
    // The model may stand as the user's skeleton does, and as no person of ours.
    Hypothesis asItIs = hypothesisOf(bestFit(own, model, options.pins, figure, progress), shape);
    if (asItIs.confidence() > likeliest.confidence()) {
      likeliest = std::move(asItIs);
      person.reset();
    }
  }
  TemplateFit& best = likeliest.fit;

  if (!likeliest.byPlan) {
    refineHumanoid(best.skeleton, body, best.frame, best.pins, best.embedding.positions);
    placeBetween(best.skeleton, best.embedding.positions);
    if (!best.skeleton.bent()) refineHocks(best.skeleton, body, best.frame, best.pins, best.embedding.positions);
    refineQuadruped(best.skeleton, body, best.frame, best.pins, best.embedding.positions);
    const std::size_t missing = missingLimbs(best.limbs);
    findHeadless(best.skeleton, best.embedding.positions, best.limbs);
    // A shape that ends at the shoulders speaks for nobody.
    if (missingLimbs(best.limbs) > missing) likeliest.vote = std::min(likeliest.vote, 0.0);
  }
  AutoRig rig;
  if (person) {
    const TemplatePins ownPins = pinsIn(person->skeleton, best.frame, options.pins);
    const std::vector<Vec3> positions = placePerson(*person, best.embedding.positions, ownPins);
    rig.skeleton = standingSkeleton(person->skeleton, positions, best.frame);
    best.skeleton = humanoidNamedAs(*person, std::move(best.skeleton));
  } else {
    rig.skeleton = standingSkeleton(best.skeleton, best.embedding.positions, best.frame);
  }
  warnOfStrays(mesh, cleared, rig);
  rig.up = best.frame.axes.row(1).transpose();
  rig.matches = matchesOf(hypotheses);
  if (!person) rig.doubts = doubtsOf(likeliest);
  warn(likeliest, rig);
  return rig;
}

}  // namespace limber
