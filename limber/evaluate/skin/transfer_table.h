// Rigs transferred between characters of a folder, compared with the rigs that artists made for them.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/evaluate/rig/rig_metrics.h"
#include "limber/evaluate/skin/weight_metrics.h"
#include "limber/report/table.h"

namespace limber {

// Gives the target, which has no rig, that of the source.
using TransferFunction = std::function<void(const Asset& source, Asset& target)>;

struct TransferTrial {
  std::string source, target;  // files' names, without folder and extension
  bool isFamily = false;       // most joints of the target's artist have the names of the source's
  RigComparison rig;
  // By joints of one name in a family; else by the parts of the body (bodyPartAt): makers cut trunks differently.
  double weightsL1 = 0;
  // At least this much of it no transfer could avoid: weights on joints, or parts, to which the source binds nothing.
  double outOfReachL1 = 0;
  double deformP95 = 0;  // of a family (WeightComparison)
  double seconds = 0;    // of the transfer alone
};

struct TransferTrialOptions {
  std::size_t maxSources = 2;  // for each target: of its family, and of others
};

// Every model below the folder that has a rig, triangles and the skeleton of a person, as target of others there: of
// each kind that many, drawn at random with a fixed seed. What cannot be read or transferred is counted in `skipped`.
std::vector<TransferTrial> tryTransfers(const std::filesystem::path& folder, const TransferTrialOptions& options,
                                        const TransferFunction& transfer, Progress& progress, Warnings& skipped);

struct TransferFolder {
  std::string name;
  std::vector<TransferTrial> trials;
};

// Means: two lines for each folder; and a line for each trial.
Table transferTable(std::span<const TransferFolder> folders);
Table eachTransferTrial(std::span<const TransferFolder> folders);

}  // namespace limber
