#include "limber/study/ranking/measure_agreement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/study/ranking/paired_statistics.h"

namespace limber {

namespace {

constexpr std::size_t kMinMethods = 3;  // two agree or not by chance alone

// Of one method on one model.
using MethodValues = std::map<std::string, double, std::less<>>;  // by the measure's name
using ModelMethods = std::map<std::string, MethodValues>;         // by the method's names

std::string textOf(const Json& row, const char* key) {
  const auto found = row.find(key);
  if (found == row.end() || !found->is_string()) {
    throw Error(ErrorCode::kBadData, fmt::format("a row of a study's cells has no \"{}\"", key), {},
                "use the cells.json that limber study writes");
  }
  return found->get<std::string>();
}

std::vector<ModelMethods> readModels(const Json& document) {
  if (!document.is_object() || !document.contains("cells") || !document["cells"].is_array()) {
    throw Error(ErrorCode::kBadData, "has no cells of a study", {}, "use the cells.json that limber study writes");
  }
  std::map<std::pair<std::string, std::string>, ModelMethods> models;
  for (const Json& row : document["cells"]) {
    if (!row.is_object() || textOf(row, "kind") != "rig") continue;
    if (!row.contains("value") || !row["value"].is_number()) continue;
    std::string method = textOf(row, "rigger") + "\n" + textOf(row, "skinning") + "\n" + textOf(row, "options");
    if (row.contains("deformer")) method += "\n" + textOf(row, "deformer");  // not in earlier versions
    models[{textOf(row, "group"), textOf(row, "model")}][method][textOf(row, "measure")] = row["value"].get<double>();
  }
  std::vector<ModelMethods> result;
  for (auto& [name, methods] : models) result.push_back(std::move(methods));
  return result;
}

// More is better.
double goodness(const Measure& measure, double value) {
  return measure.better == Better::kMore ? value : -value;
}

MeasureAgreement agreementOf(const Measure& measure, const Measure& truth, std::span<const ModelMethods> models) {
  MeasureAgreement result{&measure, &truth, 0, 0};
  for (const ModelMethods& methods : models) {
    std::vector<double> a, b;
    for (const auto& [method, values] : methods) {
      const auto own = values.find(measure.name), known = values.find(truth.name);
      if (own == values.end() || known == values.end()) continue;
      a.push_back(goodness(measure, own->second));
      b.push_back(goodness(truth, known->second));
    }
    if (a.size() < kMinMethods) continue;
    const std::optional<double> correlation = rankCorrelation(a, b);
    if (!correlation) continue;
    ++result.models;
    result.correlation += *correlation;
  }
  if (result.models > 0) result.correlation /= static_cast<double>(result.models);
  return result;
}

bool knowsTruth(const Measure& measure) {
  return measure.source == MeasureSource::kSkeletonTruth || measure.source == MeasureSource::kWeightTruth;
}

}  // namespace

std::optional<double> rankCorrelation(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) throw Error(ErrorCode::kBadArgument, "ranks are compared of as many values as others");
  const std::vector<double> ranksA = meanRanks(a), ranksB = meanRanks(b);
  const double middle = 0.5 * (static_cast<double>(a.size()) - 1);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (ranksA[i] - middle) * (ranksB[i] - middle);
    aa += (ranksA[i] - middle) * (ranksA[i] - middle);
    bb += (ranksB[i] - middle) * (ranksB[i] - middle);
  }
  if (!(aa > 0) || !(bb > 0)) return std::nullopt;
  return ab / std::sqrt(aa * bb);
}

std::vector<MeasureAgreement> measureAgreement(std::span<const Json> cells) {
  std::vector<ModelMethods> models;
  for (const Json& document : cells) {
    for (ModelMethods& methods : readModels(document)) models.push_back(std::move(methods));
  }
  std::vector<MeasureAgreement> agreements;
  for (const Measure& measure : studyMeasures()) {
    if (!includes(MeasureSource::kModel, measure)) continue;
    for (const Measure& truth : studyMeasures()) {
      if (!knowsTruth(truth)) continue;
      const MeasureAgreement agreement = agreementOf(measure, truth, models);
      if (agreement.models > 0) agreements.push_back(agreement);
    }
  }
  return agreements;
}

Table agreementTable(std::span<const MeasureAgreement> agreements) {
  std::vector<const Measure*> rows, columns;
  std::map<std::pair<const Measure*, const Measure*>, const MeasureAgreement*> found;
  for (const MeasureAgreement& one : agreements) found[{one.measure, one.truth}] = &one;
  for (const Measure& measure : studyMeasures()) {
    const auto isIn = [&](auto member) {
      return std::any_of(agreements.begin(), agreements.end(), [&](const auto& a) { return a.*member == &measure; });
    };
    if (isIn(&MeasureAgreement::measure)) rows.push_back(&measure);
    if (isIn(&MeasureAgreement::truth)) columns.push_back(&measure);
  }
  Table table{{words("measure")}};
  for (const Measure* truth : columns) table.columns.push_back(words(fmt::format("`{}`", truth->name)));
  for (const Measure* measure : rows) {
    table.addAcross(fmt::format("`{}`", measure->name), columns, [&](const Measure* truth) {
      const auto one = found.find({measure, truth});
      return one == found.end() ? Cell()
                                : Cell(fmt::format("{:.2f} ({})", one->second->correlation, one->second->models));
    });
  }
  return table;
}

}  // namespace limber
