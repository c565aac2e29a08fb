// How a program of the user's is run as a rigger, for weights or for retargeting: one JSON file,
// docs/adapter.schema.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limber/jobs/job.h"

namespace limber {

enum class AdapterKind {
  kRig,       // a model goes in; a skeleton comes out, with weights or without
  kWeights,   // a rigged model goes in; the same skeleton comes out with other weights
  kRetarget,  // a motion and a skeleton go in; a motion of that skeleton comes out
};

enum class AdapterFormat { kObj, kGlb, kFbx, kRignetText, kBvh };

enum class AdapterUp { kY, kZ };  // +Z is what Blender has: the model then looks along -Y

struct AdapterStep {
  std::vector<std::string> command;  // a program and its arguments, with placeholders; no shell reads them
  std::filesystem::path folder;      // that it works in, with placeholders; empty: the run's own
};

// Placeholders stand for absolute paths of one run, whose folder is removed after it, unless limber is killed:
//   {folder}        the run's own
//   {input}         the file that is handed over: {folder}/input/model.obj (or .glb)
//   {motion}        of kind retarget instead: {folder}/input/motion.bvh,
//   {skeleton}      and {folder}/input/skeleton.bvh
//   {input_folder}  {folder}/input, which holds nothing else
//   {output}        the file that is read when the last step is done
//   {seed}          a whole number
struct Adapter {
  std::string name;            // the file's, without .json
  std::filesystem::path file;  // that it was read from; empty: none
  std::string summary;
  AdapterKind kind = AdapterKind::kRig;
  std::vector<AdapterStep> steps;  // one after the other
  JobLimits limits;                // of each step
  std::uint64_t seed = 0;

  AdapterFormat inputFormat = AdapterFormat::kObj;
  AdapterUp inputUp = AdapterUp::kY;
  double inputSize = 1;           // the longest side of the box that is handed over; its centre is the origin
  double inputMetresPerUnit = 1;  // of kind retarget, instead of a size
  bool takesWeights = true;  // of kind weights: else it is handed the skeleton, and each vertex with its nearest bone

  AdapterFormat outputFormat = AdapterFormat::kRignetText;
  AdapterUp outputUp = AdapterUp::kY;
  double outputMetresPerUnit = 1;
  std::string outputFile;       // seen from the run's folder
  bool mayRescale = false;      // the program moves and scales what it is given, and gives that back
  bool ignoresWeights = false;  // what the file says of weights is none of the program's work
};

// "rig", "weights", "retarget".
std::string_view adapterKindName(AdapterKind kind);
// With a dot: ".obj", ".txt", ...
std::string_view adapterExtension(AdapterFormat format);
// What files that go in and come out are called without it: "model", "motion".
std::string_view adapterFileStem(AdapterKind kind);

// Throws Error kBadData that names the entry: not JSON, another version, a key, format or placeholder that is not
// known, formats that do not go with the kind, no step.
Adapter adapterFromJson(std::string_view text, std::string name);

// What the placeholders of one run stand for.
struct AdapterPaths {
  std::filesystem::path folder, input, output;
  std::filesystem::path skeleton = {};  // of kind retarget, whose input is the motion
};
std::string filledIn(std::string_view text, const AdapterPaths& paths, std::uint64_t seed);

}  // namespace limber
