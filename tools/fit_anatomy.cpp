// Fits the weights by which bodies are read (limber/character/anatomy/part_weights.cpp) to skeletons labelled by hand:
//   limber_fit_anatomy LABELS.json... --data FOLDER --write limber/character/anatomy/part_weights.cpp
// Maximum likelihood of the labels and axes given the skeletons, with a Gaussian prior on the weights, by stochastic
// gradients (Adam: Kingma, Ba 2015); copies damaged as skeletons differ from maker to maker
// (evaluate/labelled_skeleton.h), half of them without names. --folds N leaves every N-th group of skeletons out in
// turn and prints how those are read; --makers N does so with whole makers, dealt into N folds, and prints the table of
// docs/anatomy.md. A file's maker is its folder in wild/, else its name up to the first '_'; --same A=B says that two
// are one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/character/anatomy/body_reading.h"
#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/error.h"
#include "limber/core/file/file.h"
#include "limber/core/parallel.h"
#include "limber/core/progress.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/motion_io.h"
#include "limber/evaluate/rig/anatomy_table.h"
#include "limber/evaluate/rig/labelled_skeleton.h"

using namespace limber;

namespace {

struct Settings {
  int copies = 12, epochs = 24, fits = 3, folds = 0, makerFolds = 0;
  double prior = 2e-4;  // of a weight's square, for each example
  double rate = 0.03;
};

// One skeleton, measured under every guess of its axes.
struct Example {
  std::unique_ptr<Skeleton> skeleton;
  std::unique_ptr<BodyReading> reading;
  std::vector<BodyMeasures::Table> tables;  // #guesses
  std::vector<std::uint32_t> allowed;
  std::vector<PartState> truth;  // #half joints
  std::size_t right = 0;         // the true guess
  double weight = 1;
};

// All features of each half joint.
BodyMeasures::Table joined(const BodyMeasures::Table& one, const BodyMeasures::Table& other) {
  BodyMeasures::Table both;
  both.rows.push_back(0);
  for (std::size_t i = 0; i + 1 < one.rows.size(); ++i) {
    for (const BodyMeasures::Table* table : {&one, &other}) {
      const auto begin = table->list.begin();
      both.list.insert(both.list.end(), begin + static_cast<std::ptrdiff_t>(table->rows[i]),
                       begin + static_cast<std::ptrdiff_t>(table->rows[i + 1]));
    }
    both.rows.push_back(both.list.size());
  }
  return both;
}

PartField fieldOf(const HalfBody& body, const BodyMeasures::Table& table, const PartWeights& weights,
                  std::span<const std::uint32_t> allowed) {
  StateScores own(body.joints.size());
  addScores(table, weights, own);
  return {body, own, weights, allowed};
}

Example exampleOf(const LabelledSkeleton& body, bool names, bool withTables) {
  Example example;
  example.skeleton = std::make_unique<Skeleton>(body.skeleton);
  example.reading = std::make_unique<BodyReading>(*example.skeleton, restPose(*example.skeleton), names, false);
  const BodyReading& reading = *example.reading;
  double most = -4;
  for (std::size_t g = 0; g < reading.hypotheses.size(); ++g) {
    const Axes& hypothesis = reading.hypotheses[g];
    const double like = hypothesis.up.dot(body.axes.up) + hypothesis.front.dot(body.axes.front);
    if (like > most) {
      most = like;
      example.right = g;
    }
  }
  for (const HalfJoint& half : reading.body.joints) example.truth.push_back(body.labels[half.joint].state);
  example.allowed.assign(reading.body.joints.size(), (1u << kPartStates) - 1);
  if (withTables) {
    for (const Axes& hypothesis : reading.hypotheses)
      example.tables.push_back(joined(reading.measures.steadyFeatures(), reading.measures.features(hypothesis)));
  }
  return example;
}

struct Gradient {
  std::vector<double> feature, follow, axes;
  double loss = 0;
};

// Of the labels given the true axes, and of the axes by what all labellings under them come to (axesScore).
void addGradient(const Example& example, const PartWeights& weights, Gradient& gradient) {
  const BodyReading& reading = *example.reading;
  std::vector<std::unique_ptr<PartField>> fields;
  std::vector<double> scores;
  for (std::size_t g = 0; g < reading.hypotheses.size(); ++g) {
    fields.push_back(std::make_unique<PartField>(fieldOf(reading.body, example.tables[g], weights, example.allowed)));
    scores.push_back(axesScore(reading.measures, reading.hypotheses[g], *fields[g], weights));
  }
  const double most = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (const double score : scores) sum += std::exp(score - most);
  const double whole = most + std::log(sum);
  gradient.loss += example.weight * (fields[example.right]->logSum() - fields[example.right]->scoreOf(example.truth) +
                                     whole - scores[example.right]);
  const BodyMeasures::Table& right = example.tables[example.right];
  for (std::size_t i = 0; i < example.truth.size(); ++i) {
    const auto s = static_cast<std::size_t>(example.truth[i]);
    for (std::size_t f = right.rows[i]; f < right.rows[i + 1]; ++f) {
      gradient.feature[right.list[f].number * kPartStates + s] +=
          example.weight * static_cast<double>(right.list[f].value);
    }
    if (const std::optional<Index>& parent = reading.body.joints[i].parent) {
      gradient.follow[static_cast<std::size_t>(example.truth[*parent]) * kPartStates + s] += example.weight;
    }
  }
  for (std::size_t g = 0; g < scores.size(); ++g) {
    const bool isRight = g == example.right;
    const double fraction = std::exp(scores[g] - whole) - (isRight ? 1 : 0);
    for (const ActiveFeature& f : reading.measures.axesFeatures(reading.hypotheses[g]))
      gradient.axes[f.number] -= example.weight * fraction * static_cast<double>(f.value);
    const double part = example.weight * (kAxesByLabels * fraction + (isRight ? 1 : 0));
    if (std::abs(part) < 1e-5) continue;
    const BodyMeasures::Table& table = example.tables[g];
    const std::vector<PartField::Scores> marginals = fields[g]->marginals();
    for (std::size_t i = 0; i < marginals.size(); ++i) {
      for (std::size_t f = table.rows[i]; f < table.rows[i + 1]; ++f) {
        double* row = gradient.feature.data() + table.list[f].number * kPartStates;
        const double value = part * static_cast<double>(table.list[f].value);
        for (std::size_t s = 0; s < kPartStates; ++s) row[s] -= value * marginals[i][s];
      }
    }
    const std::vector<double> pairs = fields[g]->followMarginals();
    for (std::size_t k = 0; k < pairs.size(); ++k) gradient.follow[k] -= part * pairs[k];
  }
}

class Adam {
 public:
  void step(std::vector<float>& weights, const std::vector<double>& gradient, double rate, double prior, bool never) {
    if (first_.empty()) first_.resize(weights.size()), second_.resize(weights.size());
    ++steps_;
    const double one = 1 - std::pow(0.9, steps_), two = 1 - std::pow(0.999, steps_);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (never && weights[i] < kNever / 2) continue;
      const double slope = gradient[i] - prior * static_cast<double>(weights[i]);
      first_[i] = 0.9 * first_[i] + 0.1 * slope;
      second_[i] = 0.999 * second_[i] + 0.001 * slope * slope;
      weights[i] += static_cast<float>(rate * (first_[i] / one) / (std::sqrt(second_[i] / two) + 1e-8));
    }
  }

 private:
  std::vector<double> first_, second_;
  double steps_ = 0;
};

// Weights are written one character each: 'P' for 0, a step for each character from '$' to '~'; '#' for what never
// follows.
constexpr float kStep = 0.1f;
char writtenAs(float weight) {
  if (weight < kNever / 2) return '#';
  const auto c =
      static_cast<char>('P' + std::clamp(static_cast<int>(std::lround(weight / kStep)), '$' - 'P', '~' - 'P'));
  return c == '\\' ? ']' : c;
}

PartWeights fit(const std::vector<Example>& examples, const Settings& settings) {
  PartWeights weights;
  weights.feature.assign(partFeatureCount() * kPartStates, 0);
  weights.follow.assign(kPartStates * kPartStates, kNever);
  weights.axes.assign(axesFeatureCount(), 0);
  for (const Example& example : examples) {
    for (std::size_t i = 0; i < example.truth.size(); ++i) {
      const std::optional<Index>& parent = example.reading->body.joints[i].parent;
      if (parent)
        weights.follow[static_cast<std::size_t>(example.truth[*parent]) * kPartStates +
                       static_cast<std::size_t>(example.truth[i])] = 0;
    }
  }
  // What nobody labelled may still be: a joint of no part may hang anywhere and carry anything, and a part goes on.
  for (std::size_t s = 0; s < kPartStates; ++s) {
    for (const std::size_t at : {s * kPartStates, s, s * kPartStates + s})
      weights.follow[at] = std::max(weights.follow[at], 0.0f);
  }
  weights.prepare();
  Adam features, follows, axes;
  Random random(1);
  std::vector<std::size_t> order(examples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  constexpr std::size_t kBatch = 32;
  for (int epoch = 0; epoch < settings.epochs; ++epoch) {
    for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random.below(i + 1)]);
    double loss = 0;
    const double rate = settings.rate * 0.5 * (1 + std::cos(kPi * epoch / settings.epochs));
    for (std::size_t begin = 0; begin < order.size(); begin += kBatch) {
      const std::size_t end = std::min(order.size(), begin + kBatch);
      std::vector<Gradient> parts(2);
      for (Gradient& part : parts) {
        part.feature.assign(weights.feature.size(), 0);
        part.follow.assign(weights.follow.size(), 0);
        part.axes.assign(weights.axes.size(), 0);
      }
      parallelFor(parts.size(), 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t p = from; p < to; ++p) {
          for (std::size_t i = begin + p; i < end; i += parts.size())
            addGradient(examples[order[i]], weights, parts[p]);
        }
      });
      Gradient& sum = parts[0];
      const double fraction = 1.0 / static_cast<double>(end - begin);
      for (std::size_t k = 0; k < sum.feature.size(); ++k)
        sum.feature[k] = fraction * (sum.feature[k] + parts[1].feature[k]);
      for (std::size_t k = 0; k < sum.follow.size(); ++k)
        sum.follow[k] = fraction * (sum.follow[k] + parts[1].follow[k]);
      for (std::size_t k = 0; k < sum.axes.size(); ++k) sum.axes[k] = fraction * (sum.axes[k] + parts[1].axes[k]);
      loss += sum.loss + parts[1].loss;
      features.step(weights.feature, sum.feature, rate, settings.prior, false);
      follows.step(weights.follow, sum.follow, rate, settings.prior, true);
      axes.step(weights.axes, sum.axes, rate, settings.prior, false);
      weights.prepare();
    }
    if (epoch % 6 == 5 || epoch + 1 == settings.epochs)
      fmt::print(stderr, "epoch {}: loss {:.3f} for each skeleton\n", epoch + 1,
                 loss / static_cast<double>(examples.size()));
  }
  return weights;
}

// As they are read again from what is written.
void roundWeights(PartWeights& weights) {
  for (std::vector<float>* part : {&weights.feature, &weights.follow, &weights.axes}) {
    for (float& weight : *part)
      weight = writtenAs(weight) == '#' ? kNever : static_cast<float>(writtenAs(weight) - 'P') * kStep;
  }
  weights.prepare();
}

// What never follows in one of them never does in the mean: all fits have the same labels.
PartWeights meanOf(const std::vector<PartWeights>& fits) {
  PartWeights mean = fits.front();
  for (std::vector<float> PartWeights::*part : {&PartWeights::feature, &PartWeights::follow, &PartWeights::axes}) {
    for (std::size_t i = 0; i < (mean.*part).size(); ++i) {
      float sum = 0;
      for (const PartWeights& fit : fits) sum += (fit.*part)[i];
      (mean.*part)[i] = sum / static_cast<float>(fits.size());
    }
  }
  roundWeights(mean);
  return mean;
}

// Examples of a skeleton: itself and damaged copies, with names and without.
void addExamples(const LabelledSkeleton& body, double weight, const Settings& settings, Random& random,
                 std::vector<Example>& examples) {
  const auto add = [&](const LabelledSkeleton& copy, bool names) {
    if (copy.skeleton.joints.empty()) return;
    examples.push_back(exampleOf(copy, names, true));
    examples.back().weight = weight;
  };
  add(body, true);
  add(body, false);
  for (int c = 0; c < settings.copies; ++c) {
    LabelledSkeleton copy = body;
    // Most copies have one or two damages of the form; few are turned or mirrored, as few files are.
    constexpr std::array kOften = {Damage::kStretched,   Damage::kPosed,         Damage::kCropped,
                                   Damage::kJointsAdded, Damage::kJointsRemoved, Damage::kAttached};
    const std::uint64_t count = 1 + random.below(2);
    for (std::uint64_t i = 0; i < count; ++i)
      copy = damaged(std::move(copy), kOften[random.below(kOften.size())], random);
    if (random.below(12) == 0) copy = damaged(std::move(copy), Damage::kTurned, random);
    // Names that lie about sides are rarer still.
    const bool mirrored = random.below(10) == 0;
    if (mirrored) copy = damaged(std::move(copy), Damage::kMirrored, random);
    add(copy, random.below(mirrored ? 10 : 3) == 0);
  }
}

PartState stateOf(const BodyPart& part, PartState above) {
  const bool leg = part.kind == PartKind::kLeg, arm = part.kind == PartKind::kArm;
  if (leg || arm) {
    constexpr std::array kLeg = {PartState::kLegBase, PartState::kLegBase, PartState::kLegUpper, PartState::kLegMiddle,
                                 PartState::kLegHock, PartState::kLegEnd,  PartState::kLegToes};
    constexpr std::array kArm = {PartState::kArmBase,   PartState::kArmBase,   PartState::kArmUpper,
                                 PartState::kArmMiddle, PartState::kArmMiddle, PartState::kArmEnd,
                                 PartState::kArmEnd};
    // A joint without a segment goes on in that of the joint above.
    if (part.segment == Segment::kWhole && kindOf(above) == part.kind) return above;
    return (leg ? kLeg : kArm)[static_cast<std::size_t>(part.segment)];
  }
  for (std::size_t s = 0; s < kPartStates; ++s) {
    if (kindOf(static_cast<PartState>(s)) == part.kind) return static_cast<PartState>(s);
  }
  return PartState::kOther;
}

// The bodies that the project makes itself, for its tests too.
std::vector<LabelledSkeleton> madeBodies() {
  std::vector<testing::MadeBody> made = {testing::dog(), testing::crow(), testing::snake(), testing::fish(),
                                         testing::spider()};
  for (const testing::NameHabit habit : testing::kNameHabits) made.push_back(testing::personWith(habit));
  std::vector<LabelledSkeleton> bodies;
  for (const testing::MadeBody& body : made) {
    LabelledSkeleton labelledBody{fmt::format("made {}", bodies.size()), body.skeleton, {}, {}, false};
    for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
      const std::optional<Index>& parent = body.skeleton.joints[j].parent;
      const PartState above = parent ? labelledBody.labels[*parent].state : PartState::kOther;
      labelledBody.labels.push_back({stateOf(body.parts[j], above), body.parts[j].side, body.parts[j].pair});
    }
    bodies.push_back(std::move(labelledBody));
  }
  return bodies;
}

struct Score {
  std::size_t joints = 0, kinds = 0, states = 0, skeletons = 0, axes = 0;
};

void judge(const LabelledSkeleton& body, bool names, const PartWeights& weights, Score& score, bool tell) {
  const Example example = exampleOf(body, names, true);
  std::size_t best = 0;
  double most = -HUGE_VAL;
  std::vector<PartState> states;
  for (std::size_t g = 0; g < example.tables.size(); ++g) {
    const PartField field = fieldOf(example.reading->body, example.tables[g], weights, example.allowed);
    const double s = axesScore(example.reading->measures, example.reading->hypotheses[g], field, weights);
    if (s <= most) continue;
    most = s;
    best = g;
    states = field.best();
  }
  ++score.skeletons;
  score.axes += best == example.right;
  std::string wrong;
  for (std::size_t i = 0; i < states.size(); ++i) {
    ++score.joints;
    score.kinds += kindOf(states[i]) == kindOf(example.truth[i]);
    score.states += states[i] == example.truth[i];
    if (states[i] != example.truth[i]) {
      wrong += fmt::format(" {}:{}>{}", body.skeleton.joints[example.reading->body.joints[i].joint].name,
                           static_cast<int>(example.truth[i]), static_cast<int>(states[i]));
    }
  }
  if (tell && (!wrong.empty() || best != example.right)) {
    const Axes& a = example.reading->hypotheses[best];
    fmt::print("  {} {}{}{}\n", body.file, names ? "named" : "unnamed",
               best == example.right ? ""
                                     : fmt::format(" AXES up {:.0f} {:.0f} {:.0f} front {:.0f} {:.0f} {:.0f}", a.up.x(),
                                                   a.up.y(), a.up.z(), a.front.x(), a.front.y(), a.front.z()),
               wrong);
  }
}

void tell(std::string_view what, const Score& s) {
  fmt::print("{}: {} skeletons, axes {:.1f} %, kinds {:.1f} %, states {:.1f} % of {} joints (left and right as one)\n",
             what, s.skeletons, 100.0 * static_cast<double>(s.axes) / static_cast<double>(s.skeletons),
             100.0 * static_cast<double>(s.kinds) / static_cast<double>(s.joints),
             100.0 * static_cast<double>(s.states) / static_cast<double>(s.joints), s.joints);
}

std::string makerOf(const std::string& file, const std::vector<std::string>& same) {
  const std::filesystem::path path(file);
  std::vector<std::string> steps;
  for (const auto& step : path) steps.push_back(step.string());
  std::string maker;
  if (steps.size() > 2 && steps[0] == "wild") {
    maker = steps[steps[1] == "judge" && steps.size() > 3 ? 2 : 1];
  } else {
    const std::string& name = steps.size() > 2 && steps[0] == "rigged" ? steps[1] : steps.back();
    maker = name.substr(0, name.find_first_of("_. "));
  }
  for (const std::string& pair : same) {
    const std::size_t equals = pair.find('=');
    if (equals != std::string::npos && maker == pair.substr(0, equals)) return pair.substr(equals + 1);
  }
  return maker;
}

// Of makers that were left out whole: with names, without, and what the field makes of names without conventions.
struct LeftOut {
  AnatomyScore named, hidden;

  void add(const LabelledSkeleton& body, const PartWeights& weights) {
    const Pose rest = restPose(body.skeleton);
    AnatomyOptions withoutNames;
    withoutNames.names = false;
    addScore(body, readAnatomyWith(weights, body.skeleton, rest, {}), named);
    addScore(body, readAnatomyWith(weights, body.skeleton, rest, withoutNames), hidden);
  }
  void add(const LeftOut& other) {
    named.add(other.named);
    hidden.add(other.hidden);
  }
};

void printLeftOut(const std::map<std::string, LeftOut>& makers) {
  const auto percent = [](std::size_t some, std::size_t all) {
    return all > 0 ? 100.0 * static_cast<double>(some) / static_cast<double>(all) : 0.0;
  };
  Table table{{words("maker left out"), number("skeletons", 0), number("parts", 0), number("right, %", 1),
               number("landmarks, %", 1), number("up and front, %", 1), number("names hidden: right, %", 1),
               number("landmarks, %", 1), number("up and front, %", 1)}};
  const auto row = [&](const std::string& name, const LeftOut& score) {
    const AnatomyScore &a = score.named, &b = score.hidden;
    table.add({name, a.skeletons, a.parts, percent(a.right, a.parts), percent(a.landmarksRight, a.landmarks),
               percent(a.axes, a.skeletons), percent(b.right, b.parts), percent(b.landmarksRight, b.landmarks),
               percent(b.axes, b.skeletons)});
  };
  LeftOut all;
  for (const auto& [name, score] : makers) {
    row(name, score);
    all.add(score);
  }
  row("all", all);
  fmt::print("{}", toMarkdown(table));
}

void writeWeights(const PartWeights& weights, const std::string& file) {
  const auto text = [](const std::vector<float>& values) {
    std::string lines, line;
    for (const float value : values) {
      const char c = writtenAs(value);
      line.push_back(c);
      if (line.size() < 110) continue;
      lines += fmt::format("    \"{}\"\n", line);
      line.clear();
    }
    if (!line.empty()) lines += fmt::format("    \"{}\"\n", line);
    return lines;
  };
  std::ofstream(file) << fmt::format(
      "// Made by tools/fit_anatomy.cpp: the weights by which bodies are read. One character a weight, in tenths.\n"
      "#include \"limber/character/anatomy/part_field.h\"\n\nnamespace limber {{\n\nnamespace {{\n\n// clang-format "
      "off\n"
      "constexpr std::string_view kFeature =\n{};\nconstexpr std::string_view kFollow =\n{};\nconstexpr "
      "std::string_view kAxes =\n{};\n// clang-format on\n\n"
      "std::vector<float> unpacked(std::string_view text) {{\n  std::vector<float> weights;\n  "
      "weights.reserve(text.size());\n"
      "  for (const char c : text) weights.push_back(c == '#' ? kNever : static_cast<float>(c - 'P') * 0.1f);\n  "
      "return weights;\n}}\n\n}}  // namespace\n\n"
      "const PartWeights& fittedPartWeights() {{\n  static const PartWeights kWeights = [] {{\n    PartWeights "
      "weights;\n    weights.feature = unpacked(kFeature);\n    weights.follow = unpacked(kFollow);\n    weights.axes "
      "= unpacked(kAxes);\n"
      "    weights.prepare();\n    return weights;\n  }}();\n  return kWeights;\n}}\n\n}}  // namespace limber\n",
      text(weights.feature), text(weights.follow), text(weights.axes));
}

}  // namespace

int main(int argc, char** argv) {
  const double started = secondsNow();
  std::vector<std::string> files, checks, same;
  std::string data = "../shared/data", out;
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--data")
      data = argv[++i];
    else if (word == "--write")
      out = argv[++i];
    else if (word == "--folds")
      settings.folds = std::stoi(argv[++i]);
    else if (word == "--makers")
      settings.makerFolds = std::stoi(argv[++i]);
    else if (word == "--same")
      same.push_back(argv[++i]);
    else if (word == "--copies")
      settings.copies = std::stoi(argv[++i]);
    else if (word == "--fits")
      settings.fits = std::stoi(argv[++i]);
    else if (word == "--epochs")
      settings.epochs = std::stoi(argv[++i]);
    else if (word == "--prior")
      settings.prior = std::stod(argv[++i]);
    else if (word == "--rate")
      settings.rate = std::stod(argv[++i]);
    else if (word == "--check")
      checks.push_back(argv[++i]);
    else
      files.push_back(word);
  }
  const auto load = [&](const std::vector<std::string>& from) {
    std::vector<LabelledSkeleton> bodies;
    for (const std::string& file : from) {
      const Bytes text = readFile(file);
      for (const BodyLabels& labels : readBodyLabels({reinterpret_cast<const char*>(text.data()), text.size()})) {
        try {
          bodies.push_back(labelled(labels, readMotion(std::filesystem::path(data) / labels.file).skeleton));
        } catch (const Error& error) {
          fmt::print(stderr, "{}: {}\n", labels.file, error.message());
        }
      }
    }
    return bodies;
  };
  std::vector<LabelledSkeleton> all, bodies, checked;
  for (LabelledSkeleton& body : load(files)) {
    const bool isCheck = std::any_of(checks.begin(), checks.end(),
                                     [&](const std::string& prefix) { return body.file.starts_with(prefix); });
    (isCheck ? checked : all).push_back(std::move(body));
  }
  for (LabelledSkeleton& body : madeBodies()) all.push_back(std::move(body));
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
  // Skeletons with the same joints are one group; it counts as one, more or less.
  std::map<std::string, std::vector<std::size_t>> groups;
  for (LabelledSkeleton& body : all) {
    if (body.flat) continue;
    std::string key;
    for (const Joint& joint : body.skeleton.joints)
      key += joint.name + (joint.parent ? std::to_string(*joint.parent) : "-");
    groups[key].push_back(bodies.size());
    bodies.push_back(std::move(body));
  }
  fmt::print("{} skeletons in {} groups\n", bodies.size(), groups.size());
  const auto fitTo = [&](const std::vector<const std::vector<std::size_t>*>& chosen) {
    std::vector<PartWeights> fits;
    Random random(7);
    for (int f = 0; f < settings.fits; ++f) {
      std::vector<Example> examples;
      for (const auto* group : chosen) {
        const std::size_t most = std::min<std::size_t>(group->size(), 3);
        for (std::size_t i = 0; i < most; ++i)
          addExamples(bodies[(*group)[i * group->size() / most]], 1.0 / static_cast<double>(most), settings, random,
                      examples);
      }
      fits.push_back(fit(examples, settings));
    }
    return meanOf(fits);
  };
  if (settings.makerFolds > 0) {
    std::map<std::string, std::vector<const std::vector<std::size_t>*>> makers;
    for (const auto& [key, group] : groups) makers[makerOf(bodies[group.front()].file, same)].push_back(&group);
    // The largest first, each to the fold that has the fewest groups.
    std::vector<std::string> names;
    for (const auto& [name, of] : makers) names.push_back(name);
    std::stable_sort(names.begin(), names.end(),
                     [&](const std::string& a, const std::string& b) { return makers[a].size() > makers[b].size(); });
    std::vector<std::vector<std::string>> folds(static_cast<std::size_t>(settings.makerFolds));
    std::vector<std::size_t> sizes(folds.size(), 0);
    for (const std::string& name : names) {
      const auto fold = std::min_element(sizes.begin(), sizes.end()) - sizes.begin();
      folds[static_cast<std::size_t>(fold)].push_back(name);
      sizes[static_cast<std::size_t>(fold)] += makers[name].size();
    }
    std::map<std::string, LeftOut> scores;
    for (const std::vector<std::string>& fold : folds) {
      std::vector<const std::vector<std::size_t>*> in;
      for (const std::string& name : names) {
        if (std::find(fold.begin(), fold.end(), name) == fold.end())
          in.insert(in.end(), makers[name].begin(), makers[name].end());
      }
      const PartWeights weights = fitTo(in);
      for (const std::string& name : fold) {
        for (const auto* group : makers[name]) {
          for (const std::size_t b : *group) scores[name].add(bodies[b], weights);
        }
      }
    }
    printLeftOut(scores);
  }
  if (settings.folds > 0) {
    Score named, unnamed;
    for (int fold = 0; fold < settings.folds; ++fold) {
      std::vector<const std::vector<std::size_t>*> in, left;
      int number = 0;
      for (const auto& [key, group] : groups) (number++ % settings.folds == fold ? left : in).push_back(&group);
      const PartWeights weights = fitTo(in);
      for (const auto* group : left) {
        judge(bodies[group->front()], true, weights, named, true);
        judge(bodies[group->front()], false, weights, unnamed, true);
      }
    }
    tell("left out, with names", named);
    tell("left out, names hidden", unnamed);
  }
  if (out.empty() && settings.folds + settings.makerFolds > 0) return 0;
  std::vector<const std::vector<std::size_t>*> every;
  for (const auto& [key, group] : groups) every.push_back(&group);
  const PartWeights weights = fitTo(every);
  for (const bool names : {true, false}) {
    Score fitted, check;
    for (const LabelledSkeleton& body : bodies) judge(body, names, weights, fitted, true);
    for (const LabelledSkeleton& body : checked) {
      if (!body.flat) judge(body, names, weights, check, false);
    }
    tell(names ? "fitted, with names" : "fitted, names hidden", fitted);
    if (check.skeletons > 0) tell(names ? "check, with names" : "check, names hidden", check);
  }
  if (!out.empty()) writeWeights(weights, out);
  fmt::print("{:.0f} s\n", secondsNow() - started);
}
