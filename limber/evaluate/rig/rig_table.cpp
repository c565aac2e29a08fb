#include "limber/evaluate/rig/rig_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"

namespace limber {

namespace {

Json distancesJson(const RigDistances& d) {
  return {{"joints", d.joints},
          {"truth_joints", d.truthJoints},
          {"joint_to_joint", d.jointToJoint},
          {"joint_to_bone", d.jointToBone},
          {"bone_to_bone", d.boneToBone},
          {"precision", d.precision},
          {"recall", d.recall},
          {"iou", d.iou}};
}

std::string distancesText(const RigDistances& d) {
  return fmt::format(
      "J2J {:.2f} %, J2B {:.2f} %, B2B {:.2f} %; precision {:.2f}, recall {:.2f}, IoU {:.2f} ({}/{} joints)",
      d.jointToJoint, d.jointToBone, d.boneToBone, d.precision, d.recall, d.iou, d.joints, d.truthJoints);
}

RigDistances& operator+=(RigDistances& sum, const RigDistances& d) {
  sum.jointToJoint += d.jointToJoint;
  sum.jointToBone += d.jointToBone;
  sum.boneToBone += d.boneToBone;
  sum.precision += d.precision;
  sum.recall += d.recall;
  sum.iou += d.iou;
  return sum;
}

std::string cells(const RigDistances& all, const RigDistances& d, double parts) {
  return fmt::format("{:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f}",
                     all.jointToJoint / parts, all.jointToBone / parts, all.boneToBone / parts, d.jointToJoint / parts,
                     d.jointToBone / parts, d.boneToBone / parts, d.precision / parts, d.recall / parts, d.iou / parts);
}

}  // namespace

Json toJson(const RigComparison& c) {
  Json named = Json::object();
  for (const NamedJointError& error : c.named) named[error.bone] = error.percent;
  return {{"all", distancesJson(c.all)},
          {"without_fingers", distancesJson(c.withoutFingers)},
          {"named", std::move(named)},
          {"named_mean", c.namedMean},
          {"named_worst", c.namedWorst}};
}

std::string toText(const RigComparison& c) {
  std::string text =
      fmt::format("all joints       {}\nwithout fingers  {}\n", distancesText(c.all), distancesText(c.withoutFingers));
  if (c.named.empty()) return text + "named joints     none in common\n";
  text += fmt::format("named joints     {} in common, off by {:.2f} % of the height, worst {:.2f} %\n", c.named.size(),
                      c.namedMean, c.namedWorst);
  for (const NamedJointError& error : c.named) text += fmt::format("  {:<15}{:6.2f} %\n", error.bone, error.percent);
  return text;
}

std::vector<RigTableRow> compareRigsOf(std::span<const std::filesystem::path> files, const Rerig& rerig,
                                       Progress& progress, Warnings& skipped, const std::optional<ClipMoment>& moment,
                                       const RiggedSeen& seen) {
  std::vector<RigTableRow> rows;
  progress.stage("compare rigs");
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(files.size()));
    std::string_view failure = "unreadable";
    try {
      Asset asset = readAsset(files[i]);
      if (!hasRig(asset)) {
        skipped.add("without-rig", "files without a rig left out", files[i].filename().string());
        continue;
      }
      RigTableRow row;
      row.path = files[i];
      row.name = files[i].stem().string();
      if (moment) {
        standAt(asset, *moment);
        row.name += fmt::format(" {} {:.2f}", moment->clip, moment->seconds);
      }
      const SkinnedModel truth = readSkinnedModel(asset);
      failure = "not-rigged";
      const double start = secondsNow();
      row.fit = rerig(asset);
      row.seconds = secondsNow() - start;
      row.comparison = compareRigs(readSkinnedModel(asset), truth);
      if (seen) seen(asset);
      rows.push_back(std::move(row));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add(
          failure,
          failure == "not-rigged" ? "files that were not rigged left out" : "files that cannot be compared left out",
          error.what());
    }
  }
  progress.finish();
  return rows;
}

std::string rigTable(std::span<const RigTableRow> rows) {
  std::string table =
      "| file | fit | joints limber/artist | J2J | J2B | B2B | no fingers: J2J | J2B | B2B | precision | recall | IoU "
      "| "
      "named mean | named worst | s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  RigDistances all, without;
  double named = 0, worst = 0, seconds = 0, namedRows = 0;
  for (const RigTableRow& row : rows) {
    const RigComparison& c = row.comparison;
    all += c.all;
    without += c.withoutFingers;
    seconds += row.seconds;
    if (!c.named.empty()) {
      named += c.namedMean;
      worst += c.namedWorst;
      ++namedRows;
    }
    const std::string names = c.named.empty() ? "- | -" : fmt::format("{:.2f} | {:.2f}", c.namedMean, c.namedWorst);
    table += fmt::format("| {} | {} {:.2f} | {}/{} | {} | {} | {:.2f} |\n", row.name, row.fit.likeliest,
                         row.fit.confidence, c.withoutFingers.joints, c.withoutFingers.truthJoints,
                         cells(c.all, c.withoutFingers, 1), names, row.seconds);
  }
  if (rows.empty()) return table;
  const double count = static_cast<double>(rows.size());
  const std::string names =
      namedRows > 0 ? fmt::format("{:.2f} | {:.2f}", named / namedRows, worst / namedRows) : std::string("- | -");
  return table + fmt::format("| **mean of {}** | | | {} | {} | {:.2f} |\n", rows.size(), cells(all, without, count),
                             names, seconds / count);
}

}  // namespace limber
