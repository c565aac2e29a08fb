#include "limber/evaluate/rig/rig_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/evaluate/group_summary.h"
#include "limber/evaluate/model_files.h"

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
  forEachFile(files.size(), "compare rigs", kNotCompared, progress, skipped, [&](std::size_t i) {
    Asset asset = readAsset(files[i]);
    if (!hasRig(asset)) {
      skipped.add("without-rig", "files without a rig left out", files[i].filename().string());
      return;
    }
    RigTableRow row;
    row.path = files[i];
    row.name = files[i].stem().string();
    if (moment) {
      standAt(asset, *moment);
      row.name += fmt::format(" {} {:.2f}", moment->clip, moment->seconds);
    }
    const SkinnedModel truth = readSkinnedModel(asset);
    try {
      const double start = secondsNow();
      row.fit = rerig(asset);
      row.seconds = secondsNow() - start;
      row.comparison = compareRigs(readSkinnedModel(asset), truth);
      if (seen) seen(asset);
      rows.push_back(std::move(row));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::kCancelled) throw;
      skipped.add("not-rigged", "files that were not rigged left out", error.what());
    }
  });
  return rows;
}

Table rigTable(std::span<const RigTableRow> rows) {
  using Row = RigTableRow;
  std::vector<RowMeasure<Row>> measures;
  const auto add = [&](std::string name, const auto& value) {
    measures.push_back({std::move(name), decimals(2), Statistic::kMean, value});
  };
  const auto addDistance = [&](std::string name, RigDistances RigComparison::*joints, double RigDistances::*distance) {
    add(std::move(name), [=](const Row& row) { return row.comparison.*joints.*distance; });
  };
  addDistance("J2J", &RigComparison::all, &RigDistances::jointToJoint);
  addDistance("J2B", &RigComparison::all, &RigDistances::jointToBone);
  addDistance("B2B", &RigComparison::all, &RigDistances::boneToBone);
  addDistance("no fingers: J2J", &RigComparison::withoutFingers, &RigDistances::jointToJoint);
  addDistance("J2B", &RigComparison::withoutFingers, &RigDistances::jointToBone);
  addDistance("B2B", &RigComparison::withoutFingers, &RigDistances::boneToBone);
  addDistance("precision", &RigComparison::withoutFingers, &RigDistances::precision);
  addDistance("recall", &RigComparison::withoutFingers, &RigDistances::recall);
  addDistance("IoU", &RigComparison::withoutFingers, &RigDistances::iou);
  const auto ofNamed = [](double RigComparison::*measure) {
    return [=](const Row& row) {
      return row.comparison.named.empty() ? std::nullopt : std::optional(row.comparison.*measure);
    };
  };
  add("named mean", ofNamed(&RigComparison::namedMean));
  add("named worst", ofNamed(&RigComparison::namedWorst));
  add("s", &Row::seconds);
  Table table = summaryTable({words("file"), words("fit"), words("joints limber/artist")}, measures);
  RowGroup<Row> all;
  for (const Row& row : rows) {
    const RigDistances& d = row.comparison.withoutFingers;
    addSummary({row.name, fmt::format("{} {:.2f}", row.fit.likeliest, row.fit.confidence),
                fmt::format("{}/{}", d.joints, d.truthJoints)},
               RowGroup<Row>{&row}, measures, table);
    all.push_back(&row);
  }
  addSummary({fmt::format("**mean of {}**", rows.size()), "", ""}, all, measures, table);
  return table;
}

}  // namespace limber
