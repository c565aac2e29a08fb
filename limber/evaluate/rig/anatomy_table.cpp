#include "limber/evaluate/rig/anatomy_table.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/file/file.h"
#include "limber/document/clip/motion_io.h"

namespace limber {

namespace {

constexpr std::array<std::string_view, 2> kCheckFolders = {"creatures/check", "wild/judge"};  // nothing was fitted to

struct LabelledPart {
  std::set<Index> joints;
  std::map<PartState, Index> landmarks;  // the first joint of each segment
};
using PartKey = std::tuple<PartKind, Side, Index, bool>;  // the last: of fingers, whether on a foot

// Fingers of hands and of feet have one kind: which limb they hang on tells them apart.
bool isOnFoot(const LabelledSkeleton& body, Index joint) {
  for (std::optional<Index> up = body.skeleton.joints[joint].parent; up; up = body.skeleton.joints[*up].parent) {
    const PartKind kind = kindOf(body.labels[*up].state);
    if (kind != PartKind::kFinger && kind != PartKind::kOther) return kind == PartKind::kLeg;
  }
  return false;
}

std::map<PartKey, LabelledPart> partsOf(const LabelledSkeleton& body) {
  std::map<PartKey, LabelledPart> parts;
  for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
    const JointLabel& label = body.labels[j];
    const PartKind kind = kindOf(label.state);
    if (kind == PartKind::kOther || kind == PartKind::kAttachment) continue;
    const bool foot = kind == PartKind::kFinger && isOnFoot(body, j);
    LabelledPart& part = parts[{kind, label.side, label.pair, foot}];
    part.joints.insert(j);
    if (kind == PartKind::kLeg || kind == PartKind::kArm) part.landmarks.emplace(label.state, j);
  }
  return parts;
}

bool sameJoints(const LabelledPart& truth, const Part& part) {
  std::size_t common = 0, read = part.joints.size() + part.branches.size();
  for (const std::vector<Index>* list : {&part.joints, &part.branches}) {
    for (const Index joint : *list) common += truth.joints.count(joint);
  }
  return 2 * common >= truth.joints.size() + read - common;
}

std::optional<Index> landmarkOf(const Part& part, PartState state) {
  switch (state) {
    case PartState::kLegUpper:
    case PartState::kArmUpper:
      return part.upper;
    case PartState::kLegMiddle:
    case PartState::kArmMiddle:
      return part.middle;
    case PartState::kLegHock:
      return part.hock;
    case PartState::kLegEnd:
    case PartState::kArmEnd:
      return part.end;
    case PartState::kLegToes:
      return part.toes;
    default:
      return std::nullopt;
  }
}

double percent(std::size_t some, std::size_t all) {
  return all > 0 ? 100.0 * static_cast<double>(some) / static_cast<double>(all) : 0;
}

struct Both {
  AnatomyScore named, hidden;
};

Table scoreTable(std::string caption) {
  return {
      {words(""), number("parts", 0), number("right, %", 1), number("landmarks, %", 1), number("up and front, %", 1),
       number("names hidden: right, %", 1), number("landmarks, %", 1), number("up and front, %", 1)},
      std::move(caption)};
}

void add(std::string_view name, const Both& scores, Table& table) {
  std::vector<Cell> cells = {name, scores.named.parts};
  for (const AnatomyScore* score : {&scores.named, &scores.hidden}) {
    cells.insert(cells.end(), {percent(score->right, score->parts), percent(score->landmarksRight, score->landmarks),
                               percent(score->axes, score->skeletons)});
  }
  table.add(std::move(cells));
}

void scoreBoth(const LabelledSkeleton& body, Both& scores) {
  AnatomyOptions hidden;
  hidden.names = false;
  addScore(body, readAnatomy(body.skeleton), scores.named);
  addScore(body, readAnatomy(body.skeleton, hidden), scores.hidden);
}

}  // namespace

void AnatomyScore::add(const AnatomyScore& other) {
  skeletons += other.skeletons;
  axes += other.axes;
  parts += other.parts;
  right += other.right;
  landmarks += other.landmarks;
  landmarksRight += other.landmarksRight;
  for (std::size_t i = 0; i < said.size(); ++i) {
    said[i] += other.said[i];
    saidRight[i] += other.saidRight[i];
  }
}

void addScore(const LabelledSkeleton& body, const Anatomy& anatomy, AnatomyScore& score) {
  ++score.skeletons;
  constexpr double kNear = 0.7;  // cosine of 45 degrees
  score.axes += anatomy.axes.up.dot(body.axes.up) > kNear && anatomy.axes.front.dot(body.axes.front) > kNear;
  const std::map<PartKey, LabelledPart> truth = partsOf(body);
  std::set<PartKey> found;
  for (const Part& part : anatomy.parts) {
    if (part.kind == PartKind::kAttachment) continue;
    const bool foot =
        part.kind == PartKind::kFinger && part.carrier && anatomy.parts[*part.carrier].kind == PartKind::kLeg;
    const PartKey key{part.kind, part.side, part.pair, foot};
    const auto known = truth.find(key);
    bool right = known != truth.end() && sameJoints(known->second, part);
    if (right && found.insert(key).second) {
      ++score.right;
      for (const auto& [state, joint] : known->second.landmarks) {
        if (landmarkOf(part, state) == joint) ++score.landmarksRight;
      }
    }
    const auto bin =
        std::upper_bound(kConfidences.begin() + 1, kConfidences.end() - 1, part.confidence) - kConfidences.begin() - 1;
    ++score.said[static_cast<std::size_t>(bin)];
    score.saidRight[static_cast<std::size_t>(bin)] += right;
  }
  score.parts += truth.size();
  for (const auto& [key, part] : truth) {
    score.landmarks +=
        static_cast<std::size_t>(std::count_if(part.landmarks.begin(), part.landmarks.end(), [](const auto& landmark) {
          return landmark.first != PartState::kLegBase && landmark.first != PartState::kArmBase;
        }));
  }
}

std::vector<LabelledSkeleton> labelledSkeletons(std::string_view labels, const std::filesystem::path& data,
                                                Warnings& skipped) {
  std::vector<LabelledSkeleton> bodies;
  for (const BodyLabels& each : readBodyLabels(labels)) {
    try {
      const std::filesystem::path file = data / each.file;
      const Bytes bytes = readFile(file.string());
      if (hashOf(std::as_bytes(std::span(bytes))) != each.hash) {
        skipped.add("changed", fmt::format("{} is not the file that was labelled", each.file));
        continue;
      }
      bodies.push_back(labelled(each, readMotion(file).skeleton));
    } catch (const Error& error) {
      skipped.add("unread", fmt::format("{}: {}", each.file, error.message()));
    }
  }
  std::sort(bodies.begin(), bodies.end(), [](const auto& a, const auto& b) { return a.file < b.file; });
  return bodies;
}

std::vector<Table> anatomyTables(const std::vector<LabelledSkeleton>& bodies, Progress& progress) {
  progress.stage("read bodies");
  const auto isCheck = [](const LabelledSkeleton& body) {
    return std::any_of(kCheckFolders.begin(), kCheckFolders.end(),
                       [&](std::string_view folder) { return std::string_view(body.file).starts_with(folder); });
  };
  Both fitted, check, flat;
  std::array<Both, kDamages> damagedFitted, damagedCheck;
  Random random(20);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    progress.update(static_cast<double>(b) / static_cast<double>(bodies.size()));
    const LabelledSkeleton& body = bodies[b];
    if (body.flat) {
      scoreBoth(body, flat);
      continue;
    }
    scoreBoth(body, isCheck(body) ? check : fitted);
    for (std::size_t d = 0; d < kDamages; ++d) {
      const LabelledSkeleton copy = damaged(body, static_cast<Damage>(d), random);
      if (!copy.skeleton.joints.empty()) scoreBoth(copy, isCheck(body) ? damagedCheck[d] : damagedFitted[d]);
    }
  }
  std::vector<Table> tables;
  for (const bool onCheck : {false, true}) {
    Table& table = tables.emplace_back(
        scoreTable(onCheck ? "Bodies that nothing was fitted to:" : "Bodies that the weights are fitted to:"));
    add("as they are", onCheck ? check : fitted, table);
    for (std::size_t d = 0; d < kDamages; ++d) {
      add(nameOf(static_cast<Damage>(d)), (onCheck ? damagedCheck : damagedFitted)[d], table);
    }
  }
  if (flat.named.skeletons > 0) {
    add("as they are", flat,
        tables.emplace_back(scoreTable("Skeletons whose joints hang on the root, or on nothing:")));
  }
  Table& confidences = tables.emplace_back(
      Table{{words("confidence")}, "How often what is said with a confidence is right, of parts as they are:"});
  for (const char* of : {"fitted", "fitted, names hidden", "check", "check, names hidden"}) {
    confidences.columns.push_back(number(fmt::format("{}: parts", of), 0));
    confidences.columns.push_back(number("right, %", 1));
  }
  for (std::size_t i = 0; i + 1 < kConfidences.size(); ++i) {
    std::vector<Cell> cells = {fmt::format("{} to {}", kConfidences[i], kConfidences[i + 1])};
    for (const AnatomyScore* score : {&fitted.named, &fitted.hidden, &check.named, &check.hidden}) {
      cells.insert(cells.end(), {score->said[i], percent(score->saidRight[i], score->said[i])});
    }
    confidences.add(std::move(cells));
  }
  return tables;
}

}  // namespace limber
