#include "limber/evaluate/skin/transfer_table.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/character/anatomy/body_part.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/file/folder.h"
#include "limber/core/random.h"
#include "limber/document/read.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/evaluate/group_summary.h"
#include "limber/evaluate/pairing.h"
#include "limber/evaluate/rig/body_joints.h"

namespace limber {

namespace {

// Of the joints that count (countedJoints), how many have their name in the source, for both to be of a family.
constexpr double kFamily = 0.8;
// Bones of a person: hips, head, and two of each limb.
constexpr std::size_t kMinBones = 10;

struct Person {
  std::filesystem::path path;
  SkinnedModel model;
  std::vector<bool> counted;
};

std::optional<Person> readPerson(const std::filesystem::path& path) {
  const Asset asset = readAsset(path);
  if (!hasRig(asset)) return std::nullopt;
  Person person{path, readSkinnedModel(asset), {}};
  if (humanoidJoints(person.model.skeleton).size() < kMinBones) return std::nullopt;
  person.counted = countedJoints(person.model);
  return person;
}

std::vector<Person> peopleBelow(const std::filesystem::path& folder, Warnings& skipped) {
  std::vector<Person> people;
  for (const std::filesystem::path& path : filesBelow(folder, {".glb", ".gltf", ".fbx"})) {
    try {
      if (std::optional<Person> person = readPerson(path)) people.push_back(std::move(*person));
    } catch (const Error& error) {
      skipped.add("unreadable", "files that cannot be read left out", error.what());
    }
  }
  return people;
}

bool areFamily(const Person& source, const Person& target) {
  std::size_t all = 0, shared = 0;
  for (Index j = 0; j < target.model.skeleton.jointCount(); ++j) {
    if (!target.counted[j]) continue;
    ++all;
    shared += source.model.skeleton.find(target.model.skeleton.joints[j].name).has_value();
  }
  return static_cast<double>(shared) >= kFamily * static_cast<double>(all);
}

// Joints of one part of the body become one: the first of them, under the part's name. What is of no part goes along
// with the joint above.
SkinnedModel byParts(const SkinnedModel& model) {
  const Anatomy anatomy = readAnatomy(model.skeleton);
  SkinnedModel result = model;
  std::map<std::string, Index> first;
  std::vector<Index> humanoidJoint;
  for (Index j = 0; j < model.skeleton.jointCount(); ++j) {
    std::optional<BodyPart> part = bodyPartAt(anatomy, j);
    const std::optional<Index> parent = model.skeleton.joints[j].parent;
    if (!part || part->kind > PartKind::kArm) {  // fingers go along with hands, faces with heads
      humanoidJoint.push_back(parent ? humanoidJoint[*parent] : j);
    } else {
      humanoidJoint.push_back(first.try_emplace(nameOf(*part), j).first->second);
    }
    result.skeleton.joints[j].name = fmt::format("joint {}", j);
  }
  for (const auto& [name, joint] : first) result.skeleton.joints[joint].name = name;
  SkinWeights& weights = result.weights;
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    Index* joints = weights.joints.data() + std::size_t{v} * weights.slots;
    float* of = weights.weights.data() + std::size_t{v} * weights.slots;
    for (Index slot = 0; slot < weights.slots; ++slot) {
      joints[slot] = humanoidJoint[joints[slot]];
      for (Index before = 0; before < slot; ++before) {
        if (joints[before] != joints[slot]) continue;
        of[before] += std::exchange(of[slot], 0.0f);
        break;
      }
    }
  }
  return result;
}

// Joints of the truth, by name, that hold nothing in the source: weights on them cannot come from it. Each such weight
// is missing on its joint and too much on another, so it counts twice (WeightComparison::l1).
double outOfReach(const SkinnedModel& source, const SkinnedModel& truth) {
  const std::vector<bool> holds = weightedJoints(source.weights, source.skeleton.jointCount());
  const std::vector<Index> partner = pairJoints(truth.skeleton, source.skeleton);
  const SkinWeights weights = strongestFour(truth.weights);
  double sum = 0;
  for (std::size_t i = 0; i < weights.joints.size(); ++i) {
    const Index joint = partner[weights.joints[i]];
    if (joint == kNoIndex || !holds[joint]) sum += 2 * weights.weights[i];
  }
  return sum / std::max<Index>(1, weights.vertexCount());
}

std::vector<std::size_t> drawn(std::vector<std::size_t> from, std::size_t most, Random& random) {
  for (std::size_t i = 0; i + 1 < from.size(); ++i) std::swap(from[i], from[i + random.below(from.size() - i)]);
  if (from.size() > most) from.resize(most);
  return from;
}

TransferTrial tryTransfer(const Person& source, const Person& target, const TransferFunction& transfer) {
  const Asset giver = readAsset(source.path);
  Asset taker = readAsset(target.path);
  joinBindPoses(taker);
  removeRig(taker);
  TransferTrial trial;
  trial.source = source.path.stem().string();
  trial.target = target.path.stem().string();
  trial.isFamily = areFamily(source, target);
  const double start = secondsNow();
  transfer(giver, taker);
  trial.seconds = secondsNow() - start;
  const SkinnedModel result = readSkinnedModel(taker);
  trial.rig = compareRigs(result, target.model);
  if (trial.isFamily) {
    const WeightComparison weights = compareWeights(result, target.model);
    trial.weightsL1 = weights.l1;
    trial.outOfReachL1 = outOfReach(source.model, target.model);
    trial.deformP95 = weights.deformP95;
  } else {
    const SkinnedModel truth = byParts(target.model);
    trial.weightsL1 = compareWeights(byParts(result), truth).l1;
    trial.outOfReachL1 = outOfReach(byParts(source.model), truth);
  }
  return trial;
}

}  // namespace

std::vector<TransferTrial> tryTransfers(const std::filesystem::path& folder, const TransferTrialOptions& options,
                                        const TransferFunction& transfer, Progress& progress, Warnings& skipped) {
  progress.stage("transfer");
  const std::vector<Person> people = peopleBelow(folder, skipped);
  Random random(1);
  std::vector<TransferTrial> trials;
  for (std::size_t t = 0; t < people.size(); ++t) {
    std::vector<std::size_t> family, others;
    for (std::size_t s = 0; s < people.size(); ++s) {
      if (s != t) (areFamily(people[s], people[t]) ? family : others).push_back(s);
    }
    std::vector<std::size_t> sources = drawn(family, options.maxSources, random);
    const std::vector<std::size_t> more = drawn(others, options.maxSources, random);
    sources.insert(sources.end(), more.begin(), more.end());
    for (std::size_t i = 0; i < sources.size(); ++i) {
      progress.update((static_cast<double>(t) + static_cast<double>(i) / static_cast<double>(sources.size())) /
                      static_cast<double>(people.size()));
      try {
        trials.push_back(tryTransfer(people[sources[i]], people[t], transfer));
      } catch (const Error& error) {
        if (error.code() == ErrorCode::kCancelled) throw;
        skipped.add("not-transferred", "pairs that nothing can be transferred between left out", error.what());
      }
    }
  }
  progress.finish();
  return trials;
}

Table transferTable(std::span<const TransferFolder> folders) {
  using Trial = TransferTrial;
  const std::vector<RowMeasure<Trial>> measures = {
      {"named joints off by (% of height)", decimals(2), Statistic::kMean,
       [](const Trial& trial) { return trial.rig.namedMean; }},
      {"worst joint, mean", decimals(2), Statistic::kMean, [](const Trial& trial) { return trial.rig.namedWorst; }},
      {"weights L1", decimals(3), Statistic::kMean, &Trial::weightsL1},
      {"of it out of reach", decimals(3), Statistic::kMean, &Trial::outOfReachL1},
      {"s", decimals(2), Statistic::kMean, &Trial::seconds}};
  Table table = summaryTable({words("folder"), words("rigs"), number("pairs", 0)}, measures);
  for (const TransferFolder& folder : folders) {
    for (const bool ofFamilies : {true, false}) {
      const RowGroup<Trial> group =
          rowsWhere<Trial>(folder.trials, [&](const Trial& trial) { return trial.isFamily == ofFamilies; });
      addSummary({folder.name, ofFamilies ? "same joints" : "other makers'", group.size()}, group, measures, table);
    }
  }
  return table;
}

Table eachTransferTrial(std::span<const TransferFolder> folders) {
  Table table{{words("folder"), words("source"), words("target"), number("family", 0), number("named_mean", 3),
               number("named_worst", 3), words("worst_joint"), number("weights_l1", 4), number("out_of_reach", 4),
               number("deform_p95", 3), number("s", 2)}};
  for (const TransferFolder& folder : folders) {
    for (const TransferTrial& t : folder.trials) {
      const auto worst = std::max_element(t.rig.named.begin(), t.rig.named.end(),
                                          [](const auto& a, const auto& b) { return a.percent < b.percent; });
      table.add({folder.name, t.source, t.target, t.isFamily, t.rig.namedMean, t.rig.namedWorst,
                 worst == t.rig.named.end() ? "" : worst->bone, t.weightsL1, t.outOfReachL1, t.deformP95, t.seconds});
    }
  }
  return table;
}

}  // namespace limber
