// limber parts: a model taken apart, as materials or as meshes.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "command.h"
#include "limber/actions/parts/part_materials.h"
#include "limber/actions/parts/part_meshes.h"
#include "limber/core/counted.h"
#include "limber/core/text/names.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/document/read.h"
#include "limber/document/write.h"
#include "limber/preview/image/palette.h"
#include "part_arguments.h"
#include "progress_line.h"

namespace limber::cli {

namespace {

namespace fs = std::filesystem;

struct PartsArguments {
  std::string input, output;
  PartArguments parts;
  bool split = false, open = false, keepColors = false;
  Common common;
};

void describe(const Geometry& geometry, const SurfaceParts& parts, const Account& account) {
  std::vector<double> areas(parts.partCount(), 0);
  std::vector<std::size_t> counts(parts.partCount(), 0);
  double all = 0;
  for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
    const auto& [a, b, c] = geometry.triangles[t];
    const Vec3 from = geometry.positions[a].cast<double>();
    const double area =
        (geometry.positions[b].cast<double>() - from).cross(geometry.positions[c].cast<double>() - from).norm();
    areas[parts.partOf[t]] += area;
    all += area;
    ++counts[parts.partOf[t]];
  }
  for (Index p = 0; p < parts.partCount(); ++p) {
    account.line(fmt::format("  {:<24} {:>8} triangles {:5.1f} % of the surface", parts.names[p], counts[p],
                             all > 0 ? 100 * areas[p] / all : 0.0));
  }
}

// What some of the nodes show.
Geometry geometryOf(const Geometry& all, const std::vector<Index>& nodes) {
  Geometry some;
  std::vector<Index> moved(all.positions.size(), kNoIndex);
  for (PrimitiveInstance instance : all.instances) {
    if (std::find(nodes.begin(), nodes.end(), instance.node) == nodes.end()) continue;
    const auto first = static_cast<Index>(some.positions.size());
    for (Index v = 0; v < instance.vertexCount; ++v) {
      moved[instance.firstVertex + v] = first + v;
      some.positions.push_back(all.positions[instance.firstVertex + v]);
    }
    instance.firstVertex = first;
    some.instances.push_back(instance);
  }
  for (const Triangle& t : all.triangles) {
    if (moved[t[0]] != kNoIndex) some.triangles.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
  }
  return some;
}

// With what no file system takes replaced: Windows refuses more than others.
std::string fileNameOf(std::string name) {
  const auto isRefused = [](unsigned char c) {
    return c < 0x20 || std::string_view("<>:\"/\\|?*").find(static_cast<char>(c)) != std::string_view::npos;
  };
  std::replace_if(name.begin(), name.end(), isRefused, '_');
  return name;
}

// Names that differ by more than by upper and lower case: file systems of macOS and Windows do not tell these apart.
class FileNames {
 public:
  std::string add(const std::string& wanted) {
    std::string name = wanted;
    for (std::size_t n = 2; !used_.insert(lowerCase(name)).second; ++n) name = fmt::format("{}_{}", wanted, n);
    return name;
  }

 private:
  std::set<std::string> used_;
};

// A file for each part: OUT_PART.stl.
void writePartFiles(const Character& written, const std::vector<PartNodes>& parts, const PartsArguments& options,
                    const Account& account) {
  const fs::path output = options.output;
  const bool stl = lowerExtension(output) == ".stl";
  FileNames names;
  std::vector<std::pair<fs::path, Bytes>> files;
  for (const PartNodes& part : parts) {
    const std::string name = names.add(fileNameOf(part.name));
    fs::path path = output;
    path.replace_filename(output.stem().string() + "_" + name + output.extension().string());
    checkBeside("--output", path.string(), {options.input});
    const ExportMesh mesh = exportMesh(written.document(), geometryOf(written.surface(), part.nodes));
    files.emplace_back(path, stl ? encodeStl(mesh) : encodePly(mesh));
  }
  std::vector<OutputFile> outputs;
  outputs.reserve(files.size());
  for (const auto& [path, bytes] : files) outputs.push_back({path, bytes});
  writeFiles(outputs);
  for (const auto& [path, bytes] : files) account.line(fmt::format("written: {}", path.string()));
}

void write(const Character& written, const std::vector<PartNodes>& nodes, const PartsArguments& options,
           const Account& account) {
  const std::string extension = lowerExtension(options.output);
  if (extension == ".stl" || extension == ".ply") return writePartFiles(written, nodes, options, account);
  if (extension == ".obj") {
    writeMesh(exportMesh(written.document(), written.surface()), options.output);
  } else {
    writeAsset(written.document(), options.output);
  }
  if (options.output != "-") account.line(fmt::format("written: {}", options.output));
}

void checkArguments(const PartsArguments& options) {
  checkOutput(options.output, {".glb", ".gltf", ".obj", ".stl", ".ply"});
  const std::string extension = lowerExtension(options.output);
  if (!options.split && (extension == ".stl" || extension == ".ply")) {
    throw Error(ErrorCode::kBadArgument, "holds no materials that could tell parts", options.output,
                "add --split for a file for each part, or write .glb or .obj");
  }
  if (options.open && !options.split) {
    throw Error(ErrorCode::kBadArgument, "--open is for parts that are split", "", "add --split");
  }
  if (options.keepColors && options.split) {
    throw Error(ErrorCode::kBadArgument, "--split keeps all materials as they are", "", "leave --keep-colours out");
  }
}

void run(const PartsArguments& options) {
  options.common.apply();
  checkArguments(options);
  const PartOptions method = options.parts.options();
  const Account account(options.common.quiet, options.output);
  TerminalProgress progress(options.common.quiet);
  progress->stage("read");
  Asset asset = readAsset(options.input);
  const Character character(asset);
  const Geometry& geometry = character.surface();
  progress->stage("parts");
  const SurfaceParts parts = modelParts(character, method, *progress);
  progress->stage("write");
  std::vector<PartNodes> nodes;
  if (options.split) {
    nodes = splitParts(asset, geometry, parts, {!options.open}, *progress);
  } else {
    std::vector<Vec3f> tints;
    for (Index p = 0; p < parts.partCount() && !options.keepColors; ++p) tints.push_back(jointColor(p));
    paintParts(asset, geometry, parts, tints);
  }
  progress.finish();
  account.line(fmt::format("{}: {}", options.input, counted(parts.partCount(), "part")));
  describe(geometry, parts, account);
  write(asset, nodes, options, account);
  printWarnings(asset.warnings, options.common.quiet);
}

}  // namespace

void addPartsCommand(CLI::App& program) {
  auto options = std::make_shared<PartsArguments>();
  CLI::App* command = program.add_subcommand("parts", "Take a model apart: limbs as materials, or as meshes to print");
  command->add_option("FILE", options->input, "the model; - is standard input")->required();
  command
      ->add_option("-o,--output", options->output,
                   "the .glb, .gltf or .obj to write, with --split also .stl or .ply; - is standard output (GLB)")
      ->required()
      ->type_name("FILE");
  options->parts.addTo(*command);
  command->add_flag("--split", options->split, "a mesh for each part, closed where it was cut; materials stay");
  command->add_flag("--open", options->open, "leave the cuts of --split open");
  command->add_flag("--keep-colours,--keep-colors", options->keepColors,
                    "without --split: materials named by the parts, in the colours that they had");
  options->common.addTo(*command);
  command->footer(
      "Parts by weights are named after the limbs, or after the joints (--detail joints); parts by shape have "
      "numbers,\n"
      "from the largest. Without --split each part has materials of its own: copies of those that were there, "
      "textures\n"
      "and all, in a colour of the part. With --split a GLB or OBJ has a mesh for each part, with its skin in a GLB;\n"
      "STL and PLY get a file for each part, OUT_PART.stl, watertight where the model was.\n"
      "\nExamples:\n"
      "  limber parts hero.glb -o hero_parts.glb\n"
      "  limber parts hero.glb --detail joints --split -o hero_split.glb\n"
      "  limber parts person.glb --by shape --count 6 --split -o print.stl");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
