// limber evaluate: how good a result is, in figures.
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.h"
#include "deformer_list.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/core/file/file.h"
#include "limber/core/file/folder.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "limber/evaluate/motion/ik_evaluation.h"
#include "limber/evaluate/motion/ik_page.h"
#include "limber/evaluate/rig/anatomy_table.h"
#include "limber/evaluate/rig/model_quality.h"
#include "limber/evaluate/rig/rig_table.h"
#include "limber/evaluate/rig/template_table.h"
#include "limber/evaluate/skin/weight_report.h"
#include "limber/evaluate/skin/weight_table.h"
#include "limber/preview/render.h"
#include "limber/rigging/template_rigger.h"
#include "limber/study/ranking/measure_agreement.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

struct WeightsOptions {
  std::string result, truth;
  bool json = false;
};

void runWeights(const WeightsOptions& options) {
  const WeightComparison comparison = compareWeights(readAsset(options.result), readAsset(options.truth));
  printReport(comparison, options.json);
}

struct ModelFile {
  std::string model, deformer = "linear-blend";
  bool json = false;
};

void runModel(const ModelFile& options) {
  const Deformer& deformer = findDeformer(options.deformer);
  const ModelQuality quality = measureModel(readAsset(options.model), deformer);
  printReport(quality, options.json);
}

struct AgreementFiles {
  std::vector<std::string> cells;
  std::string output = "-";
};

void runMeasures(const AgreementFiles& options) {
  checkOutput(options.output, {".md"});
  std::vector<Json> documents;
  for (const std::string& file : options.cells) {
    documents.push_back(parsedFile(file, [](std::string_view text) {
      Warnings unheard;
      Json document = parseJson(text, unheard);
      measureAgreement(std::span(&document, 1));
      return document;
    }));
  }
  const std::vector<MeasureAgreement> agreements = measureAgreement(documents);
  if (agreements.empty()) {
    throw Error(ErrorCode::kBadData, "no model was rigged in three ways and compared with a rig of its own",
                options.cells.front(), "run a study of three methods or more over characters that artists rigged");
  }
  writeText(options.output, toMarkdown(agreementTable(agreements)));
}

struct RigFiles {
  std::string predicted, truth;
  bool json = false;
};

void runRig(const RigFiles& options) {
  const RigComparison comparison = compareRigs(readAsset(options.predicted), readAsset(options.truth));
  printReport(comparison, options.json);
}

struct RiggersOptions {
  std::vector<std::string> files;
  std::vector<std::string> riggers;  // none: template alone, in tables of its own
  std::string labels, split, each, sheet, output = "-", templateName = "auto", clip;
  std::optional<double> time;  // seconds
  Common common;
};

// The rows that the list names, with its labels.
std::vector<TemplateTrial> labelled(const std::vector<RigTableRow>& rows, const std::vector<LabelledFile>& labels,
                                    const std::filesystem::path& folder) {
  std::vector<TemplateTrial> trials;
  for (const LabelledFile& file : labels) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const RigTableRow& r) { return r.path == folder / file.path; });
    if (row != rows.end()) trials.push_back({file, *row});
  }
  return trials;
}

// The split that a list gives a file, or its folder's name.
std::string groupOf(const std::filesystem::path& path, const std::vector<LabelledFile>& labels,
                    const std::filesystem::path& folder) {
  for (const LabelledFile& file : labels) {
    if (path == folder / file.path) return file.split;
  }
  return std::filesystem::absolute(path).parent_path().filename().string();
}

constexpr int kSheetColumns = 8;

PreviewOptions bonesOnSheet() {
  PreviewOptions options;
  options.show = PreviewShow::kBones;
  options.width = options.height = 160;
  return options;
}

void runRiggers(RiggersOptions options) {
  options.common.apply();
  checkOutput(options.output, {".md"});
  if (!options.sheet.empty()) checkOutput(options.sheet, {".png"});
  if (options.files.empty() == options.labels.empty()) {
    throw CLI::ValidationError("FILE", "name files, or a list of labelled ones by --labels");
  }
  std::vector<LabelledFile> labels;
  const std::filesystem::path folder = std::filesystem::path(options.labels).parent_path();
  std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  if (!options.labels.empty()) {
    labels = parsedFile(options.labels, parseLabelledFiles);
    if (!options.split.empty()) {
      std::erase_if(labels, [&](const LabelledFile& file) { return file.split != options.split; });
      if (labels.empty()) {
        throw Error(ErrorCode::kBadArgument, "no file is of the split \"" + options.split + "\"", options.labels,
                    "name one that stands in its column split");
      }
    }
    for (const LabelledFile& file : labels) files.push_back(folder / file.path);
  }
  const bool isSideBySide = !options.riggers.empty();
  if (options.riggers == std::vector<std::string>{"all"}) {
    options.riggers.clear();
    for (const RiggerMethod& method : riggerMethods()) options.riggers.emplace_back(method.name);
  }
  if (!isSideBySide) options.riggers = {"template"};
  for (const std::string& rigger : options.riggers) findRigger(rigger);
  AutoRigOptions rig;
  rig.rig.templateName = options.templateName;
  checkTemplateName(options.templateName);
  rig.existingRig = ExistingRig::kReplace;
  const auto rerig = [&](Asset& asset) {
    Progress unheard;
    const AutoRigReport report = autoRig(asset, rig, unheard);
    if (report.matches.empty()) return RigFit{};
    const TemplateMatch& match = report.matches.front();
    return RigFit{report.isAbstained, match.name, match.confidence};
  };
  std::vector<Image> pictures;
  std::vector<double> inside;
  const auto look = [&](const Asset& asset) {
    const double fraction = isSideBySide ? insideFraction(readSkinnedModel(asset)) : 0;
    if (!options.sheet.empty()) pictures.push_back(render(makeScene(asset), bonesOnSheet()));
    inside.push_back(fraction);
  };
  TerminalProgress progress(options.common.quiet);
  Warnings skipped;
  std::optional<ClipMoment> moment;
  if (!options.clip.empty() || options.time) moment = {options.clip, options.time.value_or(0)};
  std::vector<RigTableRow> rows;
  std::vector<RiggerTrial> sideBySide;
  for (const std::string& rigger : options.riggers) {
    rig.rigger = rigger;
    inside.clear();
    Warnings own;
    rows = compareRigsOf(files, rerig, *progress, own, moment, look);
    for (const Warning& warning : own.items()) {
      // All riggers skip the same files, besides those that they cannot rig.
      const bool isOfRigger = warning.kind == "not-rigged";
      const std::string where = isOfRigger && isSideBySide ? rigger + ": " + warning.where : warning.where;
      if (isOfRigger || &rigger == &options.riggers.front()) {
        skipped.add(warning.kind, warning.message, where, warning.count);
      }
    }
    for (std::size_t i = 0; isSideBySide && i < rows.size(); ++i) {
      sideBySide.push_back({rigger, groupOf(rows[i].path, labels, folder), rows[i], inside[i]});
    }
  }
  refuseNothing(rows.empty() && sideBySide.empty(), skipped);
  const std::vector<TemplateTrial> trials = labelled(rows, labels, folder);
  if (!options.sheet.empty()) {
    writeFile(options.sheet, encodePng(contactSheet(pictures, kSheetColumns, renderBackdrop(bonesOnSheet()))));
  }
  writeTexts(options.each, toTsv(eachTemplateTrial(trials)), options.output,
             isSideBySide     ? toMarkdown(riggerTable(sideBySide))
             : labels.empty() ? toMarkdown(rigTable(rows))
                              : toMarkdown(templateTables(trials)));
  printWarnings(skipped, options.common.quiet);
}

struct SkinningOptions {
  std::vector<std::string> folders, methods = {"bone-heat"};
  std::string references, output = "-", pieces = "auto";
  Common common;
};

std::vector<WeightTableRow> compareFolders(const SkinningOptions& options, std::string_view method, Progress& progress,
                                           Warnings& skipped) {
  AutoRigOptions rig;
  rig.skinning = method;
  rig.weights.pieces = findPieceMode(options.pieces);
  rig.existingRig = ExistingRig::kKeepSkeleton;
  const auto reweight = [&](Asset& asset) {
    Progress unheard;
    autoRig(asset, rig, unheard);
  };
  std::vector<WeightTableRow> rows;
  for (const std::string& folder : options.folders) {
    const std::vector<WeightTableRow> more = compareFolder(folder, reweight, progress, skipped);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

void runSkinning(SkinningOptions options) {
  options.common.apply();
  checkOutput(options.output, {".md"});
  if (options.methods == std::vector<std::string>{"all"}) {
    options.methods.clear();
    for (const WeightMethod& method : weightMethods()) options.methods.emplace_back(method.name);
  }
  for (const std::string& method : options.methods) findWeightMethod(method);
  findPieceMode(options.pieces);
  std::vector<WeightReference> references;
  if (!options.references.empty()) {
    const Bytes text = readFile(options.references);
    references = parseWeightReferences({reinterpret_cast<const char*>(text.data()), text.size()});
  }

  TerminalProgress progress(options.common.quiet);
  Warnings skipped;
  std::vector<MethodRows> methods;
  for (const std::string& method : options.methods) {
    Warnings again;  // each method skips the same files
    methods.push_back({method, compareFolders(options, method, *progress, methods.empty() ? skipped : again)});
  }
  refuseNothing(methods.front().rows.empty(), skipped);
  writeText(options.output, methods.size() == 1 ? weightPage(methods.front().rows, references)
                                                : toMarkdown(weightMethodTable(methods)));
  printWarnings(skipped, options.common.quiet);
}

struct SolverOptions {
  IkEvaluationOptions evaluation;
  std::string plots, page;
  bool json = false;
  Common common;
};

// Where `folder` lies, seen from a page.
std::string folderFrom(const std::string& page, const std::string& folder) {
  const std::filesystem::path here =
      page == "-" ? std::filesystem::path(".") : std::filesystem::path(page).parent_path();
  return std::filesystem::absolute(folder).lexically_relative(std::filesystem::absolute(here)).generic_string();
}

void runIk(const SolverOptions& options) {
  if (!options.page.empty()) checkOutput(options.page, {".md"});
  TerminalProgress progress(options.common.quiet);
  const std::vector<IkScore> scores = evaluateIk(options.evaluation, *progress);
  if (!options.plots.empty()) {
    const std::filesystem::path folder = options.plots;
    makeFolder(folder);
    writeText((folder / kIkPlotFiles.solved).string(), ikSolvedPlot(scores));
    writeText((folder / kIkPlotFiles.time).string(), ikTimePlot(scores));
  }
  if (!options.page.empty()) {
    const std::string plots = options.plots.empty() ? std::string() : folderFrom(options.page, options.plots);
    return writeText(options.page, ikPage(scores, plots == "." ? "" : plots));
  }
  if (options.json) return printJson(toJson(scores));
  fmt::print("{}", toMarkdown(ikScoreTable(scores)));
}

void addIk(CLI::App& evaluate) {
  auto options = std::make_shared<SolverOptions>();
  CLI::App* command =
      evaluate.add_subcommand("ik", "Run every inverse kinematics method over the same sets of problems");
  command->add_option("--problems", options->evaluation.problems, "problems in each set")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--solver", options->evaluation.methods, "only these methods; limber pose --help lists them")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--plot", options->plots, "write plots of the shares solved and the times there, as SVG")
      ->check(notForPlans())
      ->type_name("FOLDER");
  command->add_option("-o,--output", options->page, "write a page in Markdown, with the aims beside the figures")
      ->type_name("FILE");
  command->add_flag("--json", options->json, "print JSON");
  command->add_flag("--quiet,-q", options->common.quiet, "draw no progress");
  command->footer(
      "Chains of 3, 10, 30 and 100 joints and a humanoid of 60 joints with five effectors; targets in reach, at its\n"
      "border and out of it; with and without joint limits. A problem counts as solved within a thousandth of the\n"
      "chain's length; one that cannot be solved, when the method says that it is out of reach. \"limb alone\" is the\n"
      "closed form of two bones without a solver round it.\n"
      "\nExample:\n  limber evaluate ik --problems 100 --solver fabrik --solver dls\n"
      "  limber evaluate ik --plot docs/images -o docs/ik.md");
  command->callback([options] { runIk(*options); });
}

void addModel(CLI::App& evaluate) {
  auto options = std::make_shared<ModelFile>();
  CLI::App* command =
      evaluate.add_subcommand("model", "Measure how good a rigged model is, with nothing to compare it with");
  command->add_option("FILE", options->model, "the rigged model")->required();
  command->add_option("--deformer", options->deformer, "how the surface bends, see below")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON, with the figures of each pose");
  command->footer(
      "Prints what can be told of the skeleton (joints that move nothing, inside the body, off its middle; how much "
      "of\n"
      "the surface has a bone near; asymmetry on a symmetric surface), of the weights (joints that a vertex follows,\n"
      "roughness, weights over gaps), and of the surface in a range of motion: limbs, trunk, neck, tail, wings and "
      "fins\n"
      "bent one after the other, half as far as a person can. There: stretch of the surface and of its texture, "
      "volume\n"
      "lost, and vertices that go into the body. Compare rigs of one model by these, not rigs of different models.\n"
      "The deformer changes the figures in motion alone.\n"
      "\n" +
      deformerList() + "\nExample:\n  limber evaluate model hero.glb --json");
  command->callback([options] { runModel(*options); });
}

void addMeasures(CLI::App& evaluate) {
  auto options = std::make_shared<AgreementFiles>();
  CLI::App* command =
      evaluate.add_subcommand("measures", "Tell how far measures without a truth agree with those that know it");
  command->add_option("CELLS", options->cells, "cells.json of studies over characters that artists rigged")->required();
  addMarkdownOutput(*command, options->output, "the table");
  command->footer(
      "For each measure of limber evaluate model and each one that knows the artist's rig: Spearman's rank "
      "correlation\n"
      "over the methods tried on one model, mean over the models, and how many these are. 1: what is better by the "
      "one\n"
      "is better by the other; 0: it says nothing.\n"
      "\nExample:\n  limber study plan.json -o report\n  limber evaluate measures report/cells.json");
  command->callback([options] { runMeasures(*options); });
}

void addRig(CLI::App& evaluate) {
  auto options = std::make_shared<RigFiles>();
  CLI::App* command = evaluate.add_subcommand("rig", "Compare the skeletons of two files of one model");
  command->add_option("PREDICTED", options->predicted, "the model whose skeleton is judged")->required();
  command->add_option("TRUTH", options->truth, "the same model with a skeleton to come near to")->required();
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "Prints the Chamfer distances joint to joint, joint to bone and bone to bone in percent of the longest side of "
      "the\n"
      "model's box, precision, recall and IoU of joints paired within 5 %, with and without fingers, and how far "
      "joints\n"
      "of the same meaning are apart, in percent of the height.\n"
      "\nExample:\n  limber rig hero.glb --replace-rig --template humanoid -o predicted.glb\n"
      "  limber evaluate rig predicted.glb hero.glb --json");
  command->callback([options] { runRig(*options); });
}

void addRiggers(CLI::App& evaluate) {
  auto options = std::make_shared<RiggersOptions>();
  CLI::App* command =
      evaluate.add_subcommand("templates", "Rig characters anew from a template and compare with their own skeletons");
  command->add_option("FILE", options->files, "characters with artists' rigs");
  CLI::Option* labels = command
                            ->add_option("--labels", options->labels,
                                         "a list of such files in their place, with kinds and splits, as TSV")
                            ->type_name("FILE");
  command->add_option("--split", options->split, "with --labels: only the files of this split, such as check")
      ->needs(labels)
      ->type_name("NAME");
  command
      ->add_option("--sheet", options->sheet, "draw all with their new bones into one picture, in their order (.png)")
      ->check(notForPlans())
      ->type_name("FILE");
  CLI::Option* each =
      command->add_option("--each", options->each, "with --labels: write the figures of each file, tab separated")
          ->needs(labels)
          ->check(notForPlans())
          ->type_name("FILE");
  command
      ->add_option("--rigger", options->riggers,
                   "compare these riggers side by side instead, or \"all\"; limber rig --help lists them")
      ->excludes(each)
      ->allow_extra_args(false)
      ->type_name("NAME");
  command->add_option("--template", options->templateName, "auto, or one by name; limber rig --help lists them")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--clip", options->clip, "as they stand in this clip (default: in rest pose)")->type_name("NAME");
  command->add_option("--time", options->time, "at this moment of the clip, or of the first, in seconds")
      ->check(momentOfClip())
      ->type_name("S");
  addMarkdownOutput(*command, options->output, "the table");
  options->common.addTo(*command);
  command->footer(
      "At a moment of a clip each character is what its own weights make of it, and its joints as they stand then are\n"
      "what is compared with. The name of a clip need not hold what is before the last \"|\". Files without the clip\n"
      "are left out.\n"
      "\nWith --labels the tables are of a whole collection: how often the kind is told right, how far the confidence\n"
      "can be believed, and what was taken for what. The list has a line for each file, and columns called path, kind\n"
      "and split (docs/template-rigs.md).\n"
      "\nWith --rigger the table has a line for each rigger and split or folder: means without fingers, the share of\n"
      "the joints that lie inside the model, and seconds, over the files that all of them rigged. Riggers of handles\n"
      "choose their number themselves.\n"
      "\nExamples:\n"
      "  limber evaluate templates hero.glb --template humanoid\n"
      "  limber evaluate templates walking.glb --template humanoid --clip walk --time 0.4\n"
      "  limber evaluate templates --labels creatures/MANIFEST.tsv -o reliability.md\n"
      "  limber evaluate templates --labels creatures/MANIFEST.tsv --rigger all");
  command->callback([options] { runRiggers(*options); });
}

void addWeights(CLI::App& evaluate) {
  auto options = std::make_shared<WeightsOptions>();
  CLI::App* command = evaluate.add_subcommand("weights", "Compare the skin weights of two files of one model");
  command->add_option("RESULT", options->result, "the model whose weights are judged")->required();
  command->add_option("TRUTH", options->truth, "the same model with weights to come near to")->required();
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "Prints the mean L1 distance, precision and recall of influences above 1/256, the deformation error in 20\n"
      "random poses of up to 30 degrees at each joint (percent of the bounding box's diagonal, fixed seed), the\n"
      "smoothness over edges, and the vertices left out.\n"
      "\nExample:\n  limber rig hero.glb --keep-skeleton -o weighted.glb\n"
      "  limber evaluate weights weighted.glb hero.glb --json");
  command->callback([options] { runWeights(*options); });
}

void addSkinning(CLI::App& evaluate) {
  auto options = std::make_shared<SkinningOptions>();
  CLI::App* command = evaluate.add_subcommand(
      "skinning", "Make the weights of folders of rigged models anew and compare with their own");
  command->add_option("FOLDER", options->folders, "folders of .glb and .gltf with artists' rigs")->required();
  addMarkdownOutput(*command, options->output, "the page");
  command->add_option("--references", options->references, "another program's figures for the same files, as TSV")
      ->type_name("FILE");
  command
      ->add_option("--skinning", options->methods,
                   "how weights are made; limber rig --help lists the methods; several, or all: a table of them")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--pieces", options->pieces, "how pieces are bound; limber rig --help lists the ways")
      ->type_name("NAME")
      ->capture_default_str();
  options->common.addTo(*command);
  command->footer(
      "Examples:\n  limber evaluate skinning characters -o weights.md\n"
      "  limber evaluate skinning characters --skinning all -o methods.md");
  command->callback([options] { runSkinning(*options); });
}

struct AnatomyFiles {
  std::string labels, data, output = "-";
  Common common;
};

void runAnatomy(const AnatomyFiles& options) {
  options.common.apply();
  const Bytes labels = readFile(options.labels);
  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Warnings skipped;
  const std::vector<LabelledSkeleton> bodies =
      labelledSkeletons({reinterpret_cast<const char*>(labels.data()), labels.size()}, options.data, skipped);
  const std::vector<Table> tables = anatomyTables(bodies, *progress);
  progress.finish();
  printWarnings(skipped, options.common.quiet);
  writeText(options.output, toMarkdown(tables));
}

void addAnatomy(CLI::App& evaluate) {
  auto options = std::make_shared<AnatomyFiles>();
  CLI::App* command =
      evaluate.add_subcommand("anatomy", "Read the bodies of labelled skeletons and compare with the labels");
  command->add_option("LABELS", options->labels, "labels made by hand, such as docs/data/body_labels.json")->required();
  command->add_option("FOLDER", options->data, "where the labelled files are")->required();
  addMarkdownOutput(*command, options->output, "the tables");
  options->common.addTo(*command);
  command->footer("Example:\n  limber evaluate anatomy docs/data/body_labels.json ../shared/data -o anatomy.md");
  command->callback([options] { runAnatomy(*options); });
}

}  // namespace

void addEvaluateCommand(CLI::App& program) {
  CLI::App* evaluate =
      program.add_subcommand("evaluate", "Measure how good weights, skeletons, solvers and motions are");
  evaluate->require_subcommand(1);
  evaluate->footer(
      "Example:\n  limber rig hero.glb --keep-skeleton --skinning envelopes -o result.glb\n  limber evaluate weights "
      "result.glb hero.glb");
  addWeights(*evaluate);
  addRig(*evaluate);
  addModel(*evaluate);
  addMeasures(*evaluate);
  addVotesEvaluation(*evaluate);
  addAnatomy(*evaluate);
  addRiggers(*evaluate);
  addSkinning(*evaluate);
  addIk(*evaluate);
  addMotionEvaluation(*evaluate);
  addRetargetingEvaluation(*evaluate);
  addDecompositionEvaluation(*evaluate);
  addHandleEvaluation(*evaluate);
  addTransferEvaluation(*evaluate);
}

}  // namespace limber::cli
