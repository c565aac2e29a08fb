// limber for Python: documents, arrays of their surface and rig, and what is done with them. limber/__init__.py is what
// users import.
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <nlohmann/json.hpp>

#include "limber/actions/export/engine_target.h"
#include "limber/actions/motion/retarget_asset.h"
#include "limber/actions/option_spelling.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_check_report.h"
#include "limber/actions/rig/rig_request.h"
#include "limber/actions/rig/stand_upright.h"
#include "limber/character/character.h"
#include "limber/deform/deformer.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/evaluate/rig/model_quality.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/samples/samples.h"

namespace py = pybind11;

namespace limber {

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

[[noreturn]] void refuse(const std::string& argument, const std::string& problem) {
  throw Error(ErrorCode::kBadArgument, problem, argument);
}

std::string shapeOf(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t d = 0; d < array.ndim(); ++d) text += fmt::format("{}{}", d == 0 ? "" : ", ", array.shape(d));
  return text + ")";
}

// Columns 0: any number of them.
void checkShape(const py::array& array, const std::string& argument, py::ssize_t rows, py::ssize_t columns) {
  const bool fits =
      array.ndim() == 2 && (rows < 0 || array.shape(0) == rows) && (columns == 0 || array.shape(1) == columns);
  if (fits) return;
  refuse(argument, fmt::format("must have the shape ({}, {}), not {}", rows < 0 ? "N" : std::to_string(rows),
                               columns == 0 ? "N" : std::to_string(columns), shapeOf(array)));
}

// Whole numbers: of another kind they would be cut.
Indices wholeNumbers(const py::object& given, const std::string& argument) {
  const py::array array = py::array::ensure(given);
  if (!array) {
    PyErr_Clear();
    refuse(argument, "must be an array of whole numbers");
  }
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u' && kind != 'b' && array.size() > 0) {
    refuse(argument, fmt::format("must be whole numbers, not of the type {}", std::string(py::str(array.dtype()))));
  }
  return Indices(array);
}

template <class Array>
void checkFinite(const Array& array, const std::string& argument) {
  const auto* values = array.data();
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    if (!std::isfinite(values[i])) refuse(argument, fmt::format("element {} is not a finite number", i));
  }
}

// An array that owns the vector, without a copy.
template <class Value, class Element>
py::array_t<Value> arrayOf(std::vector<Element>&& values, py::ssize_t columns) {
  auto* kept = new std::vector<Element>(std::move(values));
  const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<Element>*>(pointer); });
  const auto rows = static_cast<py::ssize_t>(kept->size() * sizeof(Element) / sizeof(Value)) / columns;
  return py::array_t<Value>({rows, columns}, reinterpret_cast<const Value*>(kept->data()), owner);
}

py::object pythonOf(const Json& json) {
  return py::module_::import("json").attr("loads")(dumpReport(json));
}

// Progress for a caller in Python, who may press Ctrl-C: asked for ten times a second at most.
class PythonProgress {
 public:
  explicit PythonProgress(py::object listener)
      : listener_(std::move(listener)),
        progress_([this](std::string_view stage, double fraction) { tell(stage, fraction); }) {}

  Progress& operator*() { return progress_; }

  // Runs without the interpreter's lock. What the listener or a signal raised goes on from here.
  template <class Work>
  void run(Work&& work) {
    try {
      const py::gil_scoped_release release;
      work(progress_);
    } catch (const Error&) {
      if (!raised_) throw;
    }
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  void tell(std::string_view stage, double fraction) {
    const double now = secondsNow();
    if (now - reported_ < kEvery || raised_) return;
    reported_ = now;
    const py::gil_scoped_acquire acquire;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!listener_.is_none()) listener_(std::string(stage), fraction);
    } catch (py::error_already_set&) {
      raised_ = std::current_exception();
      progress_.cancel();
    }
  }

  static constexpr double kEvery = 0.1;  // seconds
  py::object listener_;
  double reported_ = 0;
  std::exception_ptr raised_;
  Progress progress_;
};

SkinWeights weightsFrom(const Indices& joints, const Floats& weights, py::ssize_t vertices, Index jointCount) {
  checkShape(weights, "weights", vertices, 0);
  checkShape(joints, "joints", vertices, weights.shape(1));
  checkFinite(weights, "weights");
  SkinWeights skin;
  skin.slots = static_cast<Index>(weights.shape(1));
  if (skin.slots == 0 || skin.slots > 8) refuse("weights", fmt::format("has {} columns; 1 to 8 are kept", skin.slots));
  for (py::ssize_t i = 0; i < weights.size(); ++i) {
    const std::int64_t joint = joints.data()[i];
    if (joint < 0 || joint >= std::int64_t{jointCount}) {
      refuse("joints", fmt::format("element {} names joint {} of {}", i, joint, jointCount));
    }
    if (weights.data()[i] < 0) refuse("weights", fmt::format("element {} is below 0", i));
    skin.joints.push_back(static_cast<Index>(joint));
    skin.weights.push_back(weights.data()[i]);
  }
  normalizeWeights(skin);
  return skin;
}

Transform turnedBy(const Transform& rest, const std::string& joint, const Doubles& turn) {
  if (turn.ndim() != 1 || turn.shape(0) != 4)
    refuse(joint, "must be a quaternion (x, y, z, w), not of shape " + shapeOf(turn));
  checkFinite(turn, joint);
  const Quat rotation(turn.at(3), turn.at(0), turn.at(1), turn.at(2));
  if (rotation.norm() < 1e-9) refuse(joint, "a quaternion of length 0 turns nothing");
  Transform result = rest;
  result.rotation = rest.rotation * rotation.normalized();
  return result;
}

// A document of limber's, as Python holds it.
class Model {
 public:
  explicit Model(Asset asset) : character_(std::move(asset)) {}

  static Model read(const std::filesystem::path& path) {
    const py::gil_scoped_release release;
    return Model(readAsset(path));
  }
  static Model fromBytes(const py::bytes& data, const std::string& name) {
    const auto text = std::string_view(data);
    return Model(readAsset(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), name));
  }
  static Model fromMesh(const Floats& vertices, const py::object& given) {
    const Indices faces = wholeNumbers(given, "faces");
    checkShape(vertices, "vertices", -1, 3);
    checkShape(faces, "faces", -1, 3);
    checkFinite(vertices, "vertices");
    TriMesh mesh;
    const auto count = static_cast<std::int64_t>(vertices.shape(0));
    for (py::ssize_t v = 0; v < vertices.shape(0); ++v) {
      mesh.positions.emplace_back(vertices.at(v, 0), vertices.at(v, 1), vertices.at(v, 2));
    }
    for (py::ssize_t f = 0; f < faces.shape(0); ++f) {
      Triangle& triangle = mesh.triangles.emplace_back();
      for (py::ssize_t c = 0; c < 3; ++c) {
        const std::int64_t corner = faces.at(f, c);
        if (corner < 0 || corner >= count)
          refuse("faces", fmt::format("face {} names vertex {} of {}", f, corner, count));
        triangle[static_cast<std::size_t>(c)] = static_cast<Index>(corner);
      }
    }
    if (mesh.triangles.empty()) refuse("faces", "there is no triangle");
    return Model(meshAsset(mesh));
  }

  void write(const std::filesystem::path& path) const {
    const Character character = character_;  // another thread may change the model meanwhile
    const py::gil_scoped_release release;
    writeAsset(character.document(), path);
  }
  py::bytes glb() const {
    const Bytes bytes = writeGlb(document());
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  Model clone() const { return *this; }

  const std::string& name() const { return document().name; }
  std::vector<std::string> warnings() const {
    std::vector<std::string> lines;
    for (const Warning& warning : document().warnings.items()) lines.push_back(warningText(warning));
    return lines;
  }
  bool isRigged() const { return character_.hasRig(); }

  py::array_t<float> vertices() const { return arrayOf<float>(std::vector(character_.surface().positions), 3); }
  py::array_t<Index> faces() const { return arrayOf<Index>(std::vector(character_.surface().triangles), 3); }

  std::vector<std::string> jointNames() const {
    std::vector<std::string> names;
    for (const Joint& joint : skeleton().skeleton.joints) names.push_back(joint.name);
    return names;
  }
  py::array_t<std::int32_t> parents() const {
    std::vector<std::int32_t> parents;
    for (const Joint& joint : skeleton().skeleton.joints)
      parents.push_back(joint.parent ? static_cast<std::int32_t>(*joint.parent) : -1);
    return py::array_t<std::int32_t>(static_cast<py::ssize_t>(parents.size()), parents.data());
  }
  py::array_t<double> jointPositions() const { return arrayOf<double>(restPositions(skeleton().skeleton), 3); }
  std::pair<py::array_t<Index>, py::array_t<float>> weights() const {
    checkIsRigged();
    SkinWeights skin = character_.weights();
    const auto slots = static_cast<py::ssize_t>(skin.slots);
    return {arrayOf<Index>(std::move(skin.joints), slots), arrayOf<float>(std::move(skin.weights), slots)};
  }

  py::object rig(const RigRequest& request, const AutoRigOptions& options, const py::object& listener) {
    PythonProgress progress(listener);
    AutoRigReport report;
    Asset rigged = document().clone();  // other calls meanwhile, and what goes wrong, find the document as it was
    progress.run([&](Progress& reported) { report = autoRig(rigged, options, reported); });
    finishRig(rigged, request, report);
    character_ = Character(std::move(rigged));
    return pythonOf(toJson(report));
  }

  py::object checkRigging(const AutoRigOptions& options) const {
    RigCheckReport report;
    const Character character = character_;
    {
      const py::gil_scoped_release release;
      report = limber::checkRigging(character.document().clone(), options);
    }
    report.advice = spellOptions(report.advice, OptionSpelling::kPython);
    return pythonOf(toJson(report));
  }

  void attach(const std::vector<std::string>& names, const py::object& givenParents, const Doubles& positions,
              const py::object& givenJoints, const Floats& weights) {
    const Indices parents = wholeNumbers(givenParents, "parents"), joints = wholeNumbers(givenJoints, "joints");
    if (isRigged())
      throw Error(ErrorCode::kBadArgument, "the model has a rig already", name(),
                  "take it out with remove_rig() first");
    const auto count = static_cast<py::ssize_t>(names.size());
    if (parents.ndim() != 1 || parents.shape(0) != count)
      refuse("parents", fmt::format("must have the shape ({},), not {}", count, shapeOf(parents)));
    checkShape(positions, "positions", count, 3);
    checkFinite(positions, "positions");
    Skeleton made;
    for (py::ssize_t j = 0; j < count; ++j) {
      Joint& joint = made.joints.emplace_back();
      joint.name = names[static_cast<std::size_t>(j)];
      joint.rest.translation = Vec3(positions.at(j, 0), positions.at(j, 1), positions.at(j, 2));
      const std::int64_t parent = parents.at(j);
      if (parent < 0) continue;
      if (parent >= j)
        refuse("parents", fmt::format("joint {} has the parent {}, which must come before it", j, parent));
      joint.parent = static_cast<Index>(parent);
      joint.rest.translation -= Vec3(positions.at(parent, 0), positions.at(parent, 1), positions.at(parent, 2));
    }
    checkSkeleton(made);
    const Geometry& geometry = character_.surface();
    const SkinWeights skin =
        weightsFrom(joints, weights, static_cast<py::ssize_t>(geometry.positions.size()), made.jointCount());
    Asset rigged = document().clone();  // a failure leaves the document as it was
    attachRig(rigged, geometry, made, skin);
    character_ = Character(std::move(rigged));
  }
  void setWeights(const py::object& given, const Floats& weights) {
    const Indices joints = wholeNumbers(given, "joints");
    const AssetSkeleton& own = skeleton();
    const Geometry& geometry = character_.surface();
    const SkinWeights skin =
        weightsFrom(joints, weights, static_cast<py::ssize_t>(geometry.positions.size()), own.skeleton.jointCount());
    Asset reweighted = document().clone();
    replaceWeights(reweighted, geometry, own, skin);
    character_ = Character(std::move(reweighted));
  }
  void removeRig() {
    Asset bare = document().clone();
    limber::removeRig(bare);
    character_ = Character(std::move(bare));
  }

  py::array_t<float> posed(const std::map<std::string, Doubles>& turns, const std::string& deformer) const {
    const AssetSkeleton& own = skeleton();
    const Character character = character_;  // another thread may change the model meanwhile
    Pose pose = restPose(own.skeleton);
    for (const auto& [joint, turn] : turns) {
      const std::optional<Index> j = own.skeleton.find(joint);
      if (!j) refuse(joint, "the model has no joint of that name");
      pose.locals[*j] = turnedBy(pose.locals[*j], joint, turn);
    }
    std::vector<Vec3f> positions;
    {
      const py::gil_scoped_release release;
      positions = std::move(posedGeometry(character, own, pose, findDeformer(deformer)).geometry.positions);
    }
    return arrayOf<float>(std::move(positions), 3);
  }

  py::list retarget(const std::filesystem::path& motion, RetargetAssetOptions options) {
    std::vector<RetargetedClip> clips;
    Asset moving = document().clone();
    {
      const py::gil_scoped_release release;
      const Motion read = readMotion(motion);
      const UprightCharacter upright = standUpright(moving, moving.warnings);
      options.turn = upright.turn;
      clips = retargetOnto(moving, upright.character, read, options);
    }
    character_ = Character(std::move(moving));
    py::list added;
    for (const RetargetedClip& clip : clips) {
      py::dict one;
      one["name"] = clip.name;
      one["frames"] = clip.frames;
      one["frames_per_second"] = clip.framesPerSecond;
      added.append(one);
    }
    return added;
  }

  py::object quality() const {
    ModelQuality measured;
    const Character character = character_;
    {
      const py::gil_scoped_release release;
      measured = measureModel(character);
    }
    return pythonOf(toJson(measured));
  }

 private:
  const Asset& document() const { return character_.document(); }
  void checkIsRigged() const {
    if (!isRigged()) throw Error(ErrorCode::kUnsupported, "the model has no rig", name(), "make one with rig()");
  }
  const AssetSkeleton& skeleton() const {
    checkIsRigged();
    return character_.binding();
  }

  Character character_;  // replaced by each change, so that whoever has a copy keeps it as it was
};

std::vector<JointPin> pinsFrom(const std::map<std::string, Doubles>& given) {
  std::vector<JointPin> pins;
  for (const auto& [joint, position] : given) {
    if (position.ndim() != 1 || position.shape(0) != 3)
      refuse("pins", fmt::format("{} must be a position (x, y, z)", joint));
    pins.push_back({joint, Vec3(position.at(0), position.at(1), position.at(2))});
  }
  return pins;
}

template <class Methods>
std::map<std::string, std::string> named(const Methods& methods) {
  std::map<std::string, std::string> names;
  for (const auto& method : methods) names.emplace(method.name, method.summary);
  return names;
}

constexpr const char* kRigHelp =
    R"(Finds joints and weights. Returns what was done as a dictionary (docs/report.md of the project).

rigger          a name of limber.riggers(); None: sphere-mesh, or template where one is named
template        fit this named skeleton: "auto", a name, or the path of a file with a skeleton (.glb, .bvh, .json, ...)
skinning        a name of limber.skinning_methods()
pieces          how pieces that are joined to no other are bound: "auto", "rigid" or "soft"
handles         how many joints, for riggers that ask; None: what suits the model
max_influences  joints that a vertex may follow, 1 to 8
existing_rig    "refuse", "replace" or "keep-skeleton" (weights alone are made anew)
pins            where joints of a template must be: {"leftHand": (x, y, z)}, metres
up, front       how the model stands, for a template: "+x", "-x", "+y", ...; None: found
upright         turn a model that surely stands along another axis to stand along +Y
chains          give capes, scarves, braids and tails joints that swing (VRMC_springBone)
reading         networks of your own that read the shape: the path of a file of ./dev learn export
target          joints' names, root and axes as another program expects them: a name of limber.targets()
progress        called as progress(stage, fraction) a few times a second; what it raises stops the work
Ctrl-C stops it. Where it does not end well, the model is as it was.)";

constexpr const char* kRetargetHelp =
    R"(Puts a motion (.bvh, .glb, .gltf, .fbx, .dae) onto the rig. Returns the clips that were added, as dictionaries.

method  a name of limber.retargeting_methods()
solver  how limbs reach: two-bone, fabrik, ...
skeleton  which body of a motion of several: the name of its root joint, or its number from 1)";

// limber.Error(ValueError), with code, where and remedy.
void raiseErrors(py::module_& module) {
  static PyObject* type = PyErr_NewExceptionWithDoc(
      "limber.Error", "What limber cannot do: code, message, where, remedy.", PyExc_ValueError, nullptr);
  module.attr("Error") = py::reinterpret_borrow<py::object>(type);
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      std::rethrow_exception(std::move(raised));
    } catch (const Error& error) {
      const Error reported = spellOptions(error, OptionSpelling::kPython);
      const py::object made = py::reinterpret_borrow<py::object>(type)(reported.what());
      made.attr("code") = std::string(errorCodeName(reported.code()));
      made.attr("message") = reported.message();
      made.attr("where") = reported.where();
      made.attr("remedy") = reported.remedy();
      PyErr_SetObject(type, made.ptr());
    }
  });
}

AutoRigOptions optionsFrom(const RigRequest& request, const std::optional<std::filesystem::path>& templateName) {
  const py::gil_scoped_release release;  // the file of a template may be large
  return templateName ? optionsWithTemplate(request, templateName->string()) : optionsOf(request);
}

}  // namespace

PYBIND11_MODULE(_limber, module) {
  module.doc() = "The engine of limber. Import limber instead.";
  module.attr("__version__") = LIMBER_VERSION;
  raiseErrors(module);

  py::class_<Model>(module, "Model", "A model: what its file held, kept whole, and what was added.")
      .def_static("from_bytes", &Model::fromBytes, py::arg("data"), py::arg("name"),
                  "The bytes of a file; its name tells the format.")
      .def_static(
          "from_mesh", &Model::fromMesh, py::arg("vertices"), py::arg("faces"),
          "vertices: (V, 3) in metres, +Y up; faces: (F, 3) indices of them, counter-clockwise seen from outside.")
      .def("write", &Model::write, py::arg("path"), "A .glb or .gltf. All files or none.")
      .def("glb", &Model::glb, "The bytes of a GLB.")
      .def("copy", &Model::clone, "Another model with the same content.")
      .def_property_readonly("name", &Model::name, "The file's name.")
      .def_property_readonly("warnings", &Model::warnings, "What reading had to repair or leave out.")
      .def_property_readonly("is_rigged", &Model::isRigged)
      .def_property_readonly("vertices", &Model::vertices,
                             "(V, 3) float32: in world space, metres, in bind pose where there is a rig.")
      .def_property_readonly("faces", &Model::faces, "(F, 3) uint32: triangles of these vertices.")
      .def_property_readonly("joint_names", &Model::jointNames, "J names; parents come before children.")
      .def_property_readonly("parents", &Model::parents, "(J,) int32: -1 for a root.")
      .def_property_readonly("joint_positions", &Model::jointPositions,
                             "(J, 3) float64: in bind pose, world space, metres.")
      .def_property_readonly("weights", &Model::weights,
                             "((V, K) uint32, (V, K) float32): joints and how much each vertex follows them, strongest "
                             "first; 0 for an unused one.")
      .def(
          "rig",
          [](Model& model, const std::optional<std::string>& rigger,
             const std::optional<std::filesystem::path>& templateName, const std::string& skinning,
             const std::string& pieces, std::optional<Index> handles, Index maxInfluences, const std::string& existing,
             const std::map<std::string, Doubles>& pins, const std::optional<std::string>& up,
             const std::optional<std::string>& front, bool upright, bool chains,
             const std::optional<std::filesystem::path>& reading, const std::string& target,
             const py::object& progress) {
            RigRequest request;
            request.rigger = rigger;
            request.skinning = skinning;
            request.pieces = pieces;
            request.handles = handles;
            request.maxInfluences = maxInfluences;
            request.existingRig = existing;
            request.pins = pinsFrom(pins);
            request.up = up;
            request.front = front;
            request.upright = upright;
            request.chains = chains;
            request.reading = reading;
            request.target = target;
            return model.rig(request, optionsFrom(request, templateName), progress);
          },
          py::arg("rigger") = py::none(), py::kw_only(), py::arg("template") = py::none(),
          py::arg("skinning") = RigRequest().skinning, py::arg("pieces") = RigRequest().pieces,
          py::arg("handles") = py::none(), py::arg("max_influences") = RigRequest().maxInfluences,
          py::arg("existing_rig") = RigRequest().existingRig, py::arg("pins") = py::dict(), py::arg("up") = py::none(),
          py::arg("front") = py::none(), py::arg("upright") = false, py::arg("chains") = false,
          py::arg("reading") = py::none(), py::arg("target") = RigRequest().target, py::arg("progress") = py::none(),
          kRigHelp)
      .def(
          "check_rigging",
          [](const Model& model, const std::optional<std::string>& up, const std::optional<std::string>& front,
             const std::optional<std::filesystem::path>& reading) {
            RigRequest request;
            request.rigger = "template";
            request.up = up;
            request.front = front;
            request.reading = reading;
            return model.checkRigging(optionsFrom(request, std::nullopt));
          },
          py::kw_only(), py::arg("up") = py::none(), py::arg("front") = py::none(), py::arg("reading") = py::none(),
          "Whether a template can be fitted, before any work: kind of body, pose, what is missing or grown together, "
          "and what to do, as a dictionary (docs/report.md of the project). Options as in rig().")
      .def("attach_rig", &Model::attach, py::arg("names"), py::arg("parents"), py::arg("positions"), py::arg("joints"),
           py::arg("weights"),
           "A rig of your own: J names, (J,) parents with -1 for a root, (J, 3) places in metres; (V, K) joints and "
           "(V, K) weights of the vertices, K from 1 to 8.")
      .def("set_weights", &Model::setWeights, py::arg("joints"), py::arg("weights"),
           "Other weights for the rig that there is: (V, K) joints and (V, K) weights, K from 1 to 8.")
      .def("remove_rig", &Model::removeRig, "Takes joints, weights and the joints' animation out.")
      .def("posed", &Model::posed, py::arg("turns"), py::arg("deformer") = "linear-blend",
           "(V, 3) float32: the vertices with joints turned. turns: quaternions (x, y, z, w) by joint, in the joint's "
           "own frame.")
      .def(
          "retarget",
          [](Model& model, const std::filesystem::path& motion, const std::string& method, const std::string& solver,
             const std::string& skeleton) {
            RetargetAssetOptions options;
            options.method = method;
            options.body = skeleton;
            options.retarget.solver = solver;
            return model.retarget(motion, options);
          },
          py::arg("motion"), py::arg("method") = "limb-ik", py::kw_only(), py::arg("solver") = RetargetOptions().solver,
          py::arg("skeleton") = "", kRetargetHelp)
      .def("quality", &Model::quality,
           "How good the rig is, with nothing to compare it with: the figures of limber evaluate model.");

  module.def("read", &Model::read, py::arg("path"),
             "A model out of a .glb, .gltf, .obj, .ply, .stl, .off, .fbx, .dae or .bvh file.");
  module.def(
      "sample", [](const std::string& name) { return Model(makeSample(name)); }, py::arg("name"),
      "A model that limber makes itself: biped, quadruped, winged, ...");
  module.def(
      "riggers", [] { return named(riggerMethods()); }, "Names, and what each does.");
  module.def(
      "skinning_methods", [] { return named(weightMethods()); }, "Names, and what each does.");
  module.def(
      "targets", [] { return named(engineTargets()); }, "Names, and what each does.");
  module.def(
      "deformers", [] { return named(deformers()); }, "Names, and what each does.");
  module.def(
      "retargeting_methods", [] { return named(retargetMethods()); }, "Names, and what each does.");
}

}  // namespace limber
