#include "limber/session/command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

constexpr int kCommandsVersion = 2;  // 1 knew no motions that are put on as they are added

// In the order of the variant. The formatter would put each on a line of its own.
// clang-format off
constexpr std::array<std::string_view, 62> kNames = {
    "open_sample",        "open_file",     "set_handles",       "choose_methods", "pin_joint",
    "unpin_joint",        "begin_drag",    "update_drag",       "turn_drag",      "move_drag",
    "end_drag",           "cancel_drag",   "set_ik",            "set_target",     "clear_target",
    "set_limits",         "reset_joint",   "reset_pose",        "mirror_pose",    "set_rest_pose",
    "rename_joint",       "add_motion",    "add_sample_motion", "retarget",       "set_contact",
    "add_clip",           "remove_clip",   "rename_clip",       "choose_clip",    "set_time",
    "set_key",            "edit_keys",     "delete_keys",       "set_joint_key",  "set_interpolation",
    "set_tangents",       "paste_keys",    "paint_weights",     "lock_weights",   "mirror_weights",
    "add_joint",          "delete_joint",  "reparent_joint",    "place_joint",    "set_turn",
    "apply_pose",         "apply_tasks",   "undo",              "redo",           "add_sample",
    "add_file",           "remove_member", "choose_member",     "rename_member",  "place_member",
    "attach_member",      "detach_member", "set_clock",         "set_deformer",   "transfer_rig",
    "rig_from_animation", "join_clips"};
// clang-format on
static_assert(kNames.size() == std::variant_size_v<Command>);

// The fields of each command, said once for reading and writing.
template <class Visitor, class C>
void visitFields(Visitor&, C&) {}  // those that have none
template <class Visitor>
void visitFields(Visitor& field, OpenSample& c) {
  field("name", c.name);
  field("limbs_follow", c.limbsFollow);
}
template <class Visitor>
void visitFields(Visitor& field, OpenFile& c) {
  field("file", c.file);
  field("limbs_follow", c.limbsFollow);
}
template <class Visitor>
void visitFields(Visitor& field, SetHandles& c) {
  field("count", c.count);
}
template <class Visitor>
void visitFields(Visitor& field, ChooseMethods& c) {
  field("rigger", c.rigger);
  field("skinning", c.skinning);
}
template <class Visitor>
void visitFields(Visitor& field, PinJoint& c) {
  field("joint", c.joint);
  field("position", c.position);
}
template <class Visitor>
void visitFields(Visitor& field, UnpinJoint& c) {
  field("joint", c.joint);
}
template <class Visitor>
void visitFields(Visitor& field, BeginDrag& c) {
  field("joint", c.joint);
  field("mode", c.mode);
  field("ray", c.ray);
  field("view", c.view);
  field("with", c.with);
  field("mirrored", c.mirrored);
}
template <class Visitor>
void visitFields(Visitor& field, UpdateDrag& c) {
  field("ray", c.ray);
  field("view", c.view);
  field("snap", c.snap);
}
template <class Visitor>
void visitFields(Visitor& field, TurnDrag& c) {
  field("axis", c.axis);
  field("degrees", c.degrees);
}
template <class Visitor>
void visitFields(Visitor& field, MoveDrag& c) {
  field("offset", c.offset);
  field("turn", c.turn);
}
template <class Visitor>
void visitFields(Visitor& field, EndDrag& c) {
  field("goes_on", c.goesOn);
}
template <class Visitor>
void visitFields(Visitor& field, PlaceJoint& c) {
  field("joint", c.joint);
  field("position", c.position);
  field("with", c.with);
  field("mirrored", c.mirrored);
  field("relative", c.relative);
}
template <class Visitor>
void visitFields(Visitor& field, SetTurn& c) {
  field("joint", c.joint);
  field("turn", c.turn);
  field("with", c.with);
  field("mirrored", c.mirrored);
  field("relative", c.relative);
}
template <class Visitor>
void visitFields(Visitor& field, SetIk& c) {
  field("on", c.on);
  field("solver", c.solver);
}
template <class Visitor>
void visitFields(Visitor& field, SetDeformer& c) {
  field("deformer", c.deformer);
}
template <class Visitor>
void visitFields(Visitor& field, SetTarget& c) {
  field("joint", c.joint);
  field("position", c.position);
  field("with", c.with);
}
template <class Visitor>
void visitFields(Visitor& field, ClearTarget& c) {
  field("joint", c.joint);
  field("with", c.with);
}
template <class Visitor>
void visitFields(Visitor& field, SetLimits& c) {
  field.optional("limits", c.limits);
}
template <class Visitor>
void visitFields(Visitor& field, ResetJoint& c) {
  field("joint", c.joint);
  field("with", c.with);
}
template <class Visitor>
void visitFields(Visitor& field, MirrorPose& c) {
  field("from", c.from);
}

template <class Visitor>
void visitFields(Visitor& field, ApplyPose& c) {
  field("pose", c.pose);
  field("joints", c.joints);
  field("mirrored", c.mirrored);
}
template <class Visitor>
void visitFields(Visitor& field, ApplyTasks& c) {
  field("tasks", c.tasks);
  field("root_moves", c.rootMoves);
}
template <class Visitor>
void visitFields(Visitor& field, RenameJoint& c) {
  field("joint", c.joint);
  field("name", c.name);
}
template <class Visitor>
void visitFields(Visitor& field, PaintWeights& c) {
  field.optional("joint", c.joint);
  field("mode", c.mode);
  field("strength", c.strength);
  field("radius", c.radius);
  field("mirrored", c.mirrored);
  field("dabs", c.dabs);
}
template <class Visitor>
void visitFields(Visitor& field, LockWeights& c) {
  field("joint", c.joint);
  field("on", c.on);
  field("with", c.with);
}
template <class Visitor>
void visitFields(Visitor& field, MirrorWeights& c) {
  field("from", c.from);
}
template <class Visitor>
void visitFields(Visitor& field, AddJoint& c) {
  field("parent", c.parent);
  field("position", c.position);
  field.optional("name", c.name);
}
template <class Visitor>
void visitFields(Visitor& field, DeleteJoint& c) {
  field("joint", c.joint);
}
template <class Visitor>
void visitFields(Visitor& field, ReparentJoint& c) {
  field("joint", c.joint);
  field("parent", c.parent);
}
template <class Visitor>
void visitFields(Visitor& field, AddMotion& c) {
  field("file", c.file);
  field("retarget", c.retarget);
}
template <class Visitor>
void visitFields(Visitor& field, AddSampleMotion& c) {
  field("name", c.name);
  field("retarget", c.retarget);
}
template <class Visitor>
void visitFields(Visitor& field, RetargetMotion& c) {
  field("motion", c.motion);
  field.optional("clip", c.clip);
  field("method", c.method);
  field.optional("map", c.map);
  field("reach", c.reach);
  field("contacts", c.contacts);
}
template <class Visitor>
void visitFields(Visitor& field, SetContact& c) {
  field("foot", c.foot);
  field("from", c.from);
  field("to", c.to);
  field("contact", c.contact);
}
template <class Visitor>
void visitFields(Visitor& field, JoinClips& c) {
  field("clips", c.clips);
  field("seconds", c.seconds);
  field.optional("into", c.into);
}
template <class Visitor>
void visitFields(Visitor& field, AddClip& c) {
  field("clip", c.clip);
}
template <class Visitor>
void visitFields(Visitor& field, RemoveClip& c) {
  field("clip", c.clip);
}
template <class Visitor>
void visitFields(Visitor& field, RenameClip& c) {
  field("clip", c.clip);
  field("name", c.name);
}
template <class Visitor>
void visitFields(Visitor& field, ChooseClip& c) {
  field.optional("clip", c.clip);
}
template <class Visitor>
void visitFields(Visitor& field, SetTime& c) {
  field("seconds", c.seconds);
}
template <class Visitor>
void visitFields(Visitor& field, SetKey& c) {
  field("span", c.span);
}
template <class Visitor>
void visitFields(Visitor& field, EditKeys& c) {
  field("keys", c.keys);
  field("shift", c.shift);
  field("scale", c.scale);
  field("pivot", c.pivot);
  field("copy", c.copy);
}
template <class Visitor>
void visitFields(Visitor& field, DeleteKeys& c) {
  field("keys", c.keys);
}
template <class Visitor>
void visitFields(Visitor& field, SetJointKey& c) {
  field("joint", c.joint);
  field("seconds", c.seconds);
  field("turn", c.turn);
  field("offset", c.offset);
}
template <class Visitor>
void visitFields(Visitor& field, SetInterpolation& c) {
  field("interpolation", c.interpolation);
}
template <class Visitor>
void visitFields(Visitor& field, SetTangents& c) {
  field("keys", c.keys);
  field("tangents", c.tangents);
  field("turn", c.turn);
  field("offset", c.offset);
}
template <class Visitor>
void visitFields(Visitor& field, PasteKeys& c) {
  field("keys", c.keys);
}

template <class Visitor>
void visitFields(Visitor& field, AddSample& c) {
  field("name", c.name);
  field("limbs_follow", c.limbsFollow);
  field("as_prop", c.asProp);
}
template <class Visitor>
void visitFields(Visitor& field, AddFile& c) {
  field("file", c.file);
  field("limbs_follow", c.limbsFollow);
  field("as_prop", c.asProp);
}
template <class Visitor>
void visitFields(Visitor& field, RemoveMember& c) {
  field("member", c.member);
}
template <class Visitor>
void visitFields(Visitor& field, ChooseMember& c) {
  field("member", c.member);
}
template <class Visitor>
void visitFields(Visitor& field, RenameMember& c) {
  field("member", c.member);
  field("name", c.name);
}
template <class Visitor>
void visitFields(Visitor& field, PlaceMember& c) {
  field("member", c.member);
  field("position", c.position);
  field("turn", c.turn);
  field("scale", c.scale);
}
template <class Visitor>
void visitFields(Visitor& field, AttachMember& c) {
  field("member", c.member);
  field("to", c.to);
  field("joint", c.joint);
  field("snap", c.snap);
}
template <class Visitor>
void visitFields(Visitor& field, DetachMember& c) {
  field("member", c.member);
}
template <class Visitor>
void visitFields(Visitor& field, SetClock& c) {
  field("seconds", c.seconds);
}
template <class Visitor>
void visitFields(Visitor& field, TransferRig& c) {
  field("file", c.file);
}
template <class Visitor>
void visitFields(Visitor& field, RigFromAnimation& c) {
  field("bones", c.bones);
}

constexpr std::array<std::pair<DragMode, std::string_view>, 2> kDragModes = {
    {{DragMode::kMove, "move"}, {DragMode::kTurn, "turn"}}};
constexpr std::array<std::pair<MirrorFrom, std::string_view>, 3> kMirrorSides = {
    {{MirrorFrom::kBoth, "both"}, {MirrorFrom::kLeft, "left"}, {MirrorFrom::kRight, "right"}}};

constexpr std::array<std::pair<PaintMode, std::string_view>, 4> kPaintModes = {{{PaintMode::kAdd, "add"},
                                                                                {PaintMode::kSubtract, "subtract"},
                                                                                {PaintMode::kSmooth, "smooth"},
                                                                                {PaintMode::kReplace, "replace"}}};

constexpr std::array<std::pair<Interpolation, std::string_view>, 3> kInterpolations = {
    {{Interpolation::kStep, "step"}, {Interpolation::kLinear, "linear"}, {Interpolation::kCubic, "cubic"}}};

constexpr std::array<std::pair<ContactChange, std::string_view>, 3> kContactChanges = {
    {{ContactChange::kPlanted, "planted"}, {ContactChange::kFree, "free"}, {ContactChange::kFound, "found"}}};

constexpr std::array<std::pair<KeyTangents, std::string_view>, 3> kTangents = {
    {{KeyTangents::kAuto, "auto"}, {KeyTangents::kFlat, "flat"}, {KeyTangents::kFree, "free"}}};

const auto& wordsOf(KeyTangents) {
  return kTangents;
}
const auto& wordsOf(DragMode) {
  return kDragModes;
}
const auto& wordsOf(MirrorFrom) {
  return kMirrorSides;
}
const auto& wordsOf(PaintMode) {
  return kPaintModes;
}
const auto& wordsOf(ContactChange) {
  return kContactChanges;
}
const auto& wordsOf(Interpolation) {
  return kInterpolations;
}

Json numbersJson(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

class Writer {
 public:
  explicit Writer(Json& json) : json_(json) {}

  template <class T>
  void operator()(const char* key, const T& value) {
    if constexpr (std::is_enum_v<T>) {
      for (const auto& [known, word] : wordsOf(value)) {
        if (known == value) json_[key] = std::string(word);
      }
    } else if constexpr (std::is_same_v<T, Vec3>) {
      json_[key] = numbersJson(value);
    } else if constexpr (std::is_same_v<T, Ray>) {
      json_[key] = {{"origin", numbersJson(value.origin)}, {"direction", numbersJson(value.direction)}};
    } else if constexpr (std::is_same_v<T, std::vector<KeyOfJoint>>) {
      json_[key] = Json::array();
      for (const KeyOfJoint& one : value) json_[key].push_back({{"joint", one.joint}, {"seconds", one.seconds}});
    } else if constexpr (std::is_same_v<T, std::vector<PoseKey>>) {
      json_[key] = Json::array();
      for (const PoseKey& one : value) {
        json_[key].push_back({{"pose", one.pose}, {"joints", one.joints}, {"seconds", one.seconds}});
      }
    } else if constexpr (std::is_same_v<T, std::vector<SurfaceDab>>) {
      Json& list = json_[key] = Json::array();
      for (const SurfaceDab& dab : value) list.push_back(Json::array({dab.triangle, dab.u, dab.v}));
    } else {
      json_[key] = value;
    }
  }
  void optional(const char* key, const std::string& value) { (*this)(key, value); }

 private:
  Json& json_;
};

Vec3 readVector(const JsonView& object, const char* key, const Vec3& byDefault) {
  const JsonView array = object.array(key);
  if (!array.exists()) return byDefault;
  if (array.size() != 3) array.fail("is not three numbers");
  return {array[0].asNumber(), array[1].asNumber(), array[2].asNumber()};
}

class Reader {
 public:
  explicit Reader(const JsonView& object) : object_(object) {}

  // A text that has no default must be there.
  void operator()(const char* key, std::string& value) {
    if (!object_.member(key).exists() && value.empty()) object_.fail(fmt::format("has no \"{}\"", key));
    optional(key, value);
  }
  void optional(const char* key, std::string& value) {
    known_.push_back(key);
    value = object_.text(key, value);
  }
  void operator()(const char* key, Index& value) {
    known_.push_back(key);
    value = object_.index(key, kNoIndex).value_or(value);
  }
  void operator()(const char* key, double& value) {
    known_.push_back(key);
    value = object_.number(key, value);
  }
  void operator()(const char* key, bool& value) {
    known_.push_back(key);
    value = object_.flag(key, value);
  }
  void operator()(const char* key, std::vector<std::string>& value) {
    known_.push_back(key);
    const JsonView list = object_.array(key);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!list[i].json().is_string()) list[i].fail("is not a text");
      value.push_back(list[i].json().get<std::string>());
    }
  }
  void operator()(const char* key, Vec3& value) {
    known_.push_back(key);
    value = readVector(object_, key, value);
  }
  void operator()(const char* key, Ray& value) {
    known_.push_back(key);
    const JsonView ray = object_.object(key);
    value = {readVector(ray, "origin", value.origin), readVector(ray, "direction", value.direction)};
  }
  void operator()(const char* key, std::vector<KeyOfJoint>& value) {
    readEntries(key, value, [](Reader& entry, KeyOfJoint& one) {
      entry.optional("joint", one.joint);
      entry("seconds", one.seconds);
    });
  }
  void operator()(const char* key, std::vector<PoseKey>& value) {
    readEntries(key, value, [](Reader& entry, PoseKey& one) {
      entry("pose", one.pose);
      entry("joints", one.joints);
      entry("seconds", one.seconds);
    });
  }
  // [[triangle, u, v], ...]
  void operator()(const char* key, std::vector<SurfaceDab>& value) {
    known_.push_back(key);
    const JsonView list = object_.array(key);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!list[i].json().is_array() || list[i].size() != 3) list[i].fail("is not a triangle with two numbers");
      value.push_back({list[i][0].asIndex(kNoIndex), list[i][1].asNumber(), list[i][2].asNumber()});
    }
  }
  template <class E>
  std::enable_if_t<std::is_enum_v<E>> operator()(const char* key, E& value) {
    known_.push_back(key);
    if (!object_.member(key).exists()) return;
    const std::string_view word = object_.text(key);
    for (const auto& [mode, name] : wordsOf(value)) {
      if (word != name) continue;
      value = mode;
      return;
    }
    object_.member(key).fail(fmt::format("cannot be '{}'", word));
  }

  void refuseOthers() const {
    object_.forEachMember([&](std::string_view key, const JsonView& value) {
      if (key == "do" || std::find(known_.begin(), known_.end(), key) != known_.end()) return;
      value.fail("is not part of this command");
    });
  }

 private:
  template <class Entry, class Fields>
  void readEntries(const char* key, std::vector<Entry>& value, const Fields& fields) {
    known_.push_back(key);
    const JsonView list = object_.array(key);
    if (!list.exists()) object_.fail(fmt::format("has no \"{}\"", key));
    for (std::size_t i = 0; i < list.size(); ++i) {
      const JsonView item = list[i];
      Reader entry(item);
      Entry one;
      fields(entry, one);
      entry.refuseOthers();
      value.push_back(std::move(one));
    }
  }

  const JsonView& object_;
  std::vector<std::string_view> known_;
};

// The fields as members of a TypeScript type.
class TypeWriter {
 public:
  explicit TypeWriter(std::string& text) : text_(text) {}

  void operator()(const char* key, const std::string& value) { member(key, value.empty(), "string"); }
  void optional(const char* key, const std::string&) { member(key, false, "string"); }
  void operator()(const char* key, bool) { member(key, false, "boolean"); }
  void operator()(const char* key, Index) { member(key, false, "number"); }
  void operator()(const char* key, double) { member(key, false, "number"); }
  void operator()(const char* key, const Vec3&) { member(key, false, "Vector"); }
  void operator()(const char* key, const Ray&) { member(key, false, "Ray"); }
  void operator()(const char* key, const std::vector<std::string>&) { member(key, false, "string[]"); }
  void operator()(const char* key, const std::vector<KeyOfJoint>&) { member(key, true, "KeyOfJoint[]"); }
  void operator()(const char* key, const std::vector<PoseKey>&) { member(key, true, "PoseKey[]"); }
  void operator()(const char* key, const std::vector<SurfaceDab>&) { member(key, false, "SurfaceDab[]"); }
  template <class E>
  std::enable_if_t<std::is_enum_v<E>> operator()(const char* key, const E& value) {
    std::string words;
    for (const auto& [known, word] : wordsOf(value)) {
      words += fmt::format("{}'{}'", words.empty() ? "" : " | ", word);
    }
    member(key, false, words);
  }

 private:
  void member(const char* key, bool isNeeded, std::string_view type) {
    text_ += fmt::format("; {}{}: {}", key, isNeeded ? "" : "?", type);
  }

  std::string& text_;
};

template <std::size_t... I>
std::string unionOfCommands(std::index_sequence<I...>) {
  std::string text;
  const auto add = [&]<std::size_t N>(std::integral_constant<std::size_t, N>) {
    text += fmt::format("\n  | {{ do: '{}'", kNames[N]);
    TypeWriter writer(text);
    std::variant_alternative_t<N, Command> command;
    visitFields(writer, command);
    text += " }";
  };
  (add(std::integral_constant<std::size_t, I>()), ...);
  return text;
}

// Reads the alternative of that name, trying one after the other.
template <std::size_t I = 0>
std::optional<Command> readNamed(std::string_view name, const JsonView& object) {
  if constexpr (I == std::variant_size_v<Command>) {
    return std::nullopt;
  } else {
    using C = std::variant_alternative_t<I, Command>;
    if (name != kNames[I]) return readNamed<I + 1>(name, object);
    C command;
    Reader reader(object);
    visitFields(reader, command);
    reader.refuseOthers();
    return command;
  }
}

// The method "online", which older lists name, kept feet and hands in contact as limb-ik does.
void bringUpToDate(Command& command) {
  auto* const retarget = std::get_if<RetargetMotion>(&command);
  if (retarget && retarget->method == "online") retarget->method = "limb-ik";
}

// Commands of older lists that are part of others by now.
std::optional<Command> readFormer(std::string_view name, const JsonView& object) {
  std::optional<Command> command;
  Reader field(object);
  if (name == "turn_joint") {
    SetTurn turn;
    Vec3 axis = Vec3::UnitY();
    double degrees = 0;
    field("joint", turn.joint);
    field("axis", axis);
    field("degrees", degrees);
    turn.turn = degrees * axis.normalized();
    turn.relative = true;
    command = turn;
  } else if (name == "move_joint") {
    PlaceJoint move;
    field("joint", move.joint);
    field("offset", move.position);
    move.relative = true;
    command = move;
  } else if (name == "move_key") {
    double from = 0, to = 0;
    field("from", from);
    field("to", to);
    command = EditKeys{.keys = {{{}, from}}, .shift = to - from};
  } else if (name == "delete_key") {
    KeyOfJoint key;
    field("seconds", key.seconds);
    command = DeleteKeys{{key}};
  }
  if (command) field.refuseOthers();
  return command;
}

Command readCommand(const JsonView& object) {
  const std::string_view name = object.text("do");
  std::optional<Command> command = readNamed(name, object);
  if (!command) command = readFormer(name, object);
  if (!command) object.fail(fmt::format("no command is called '{}'", name));
  bringUpToDate(*command);
  return *std::move(command);
}

}  // namespace

std::string_view keyTangentsName(KeyTangents tangents) {
  const auto known =
      std::find_if(kTangents.begin(), kTangents.end(), [&](const auto& entry) { return entry.first == tangents; });
  return known->second;
}

std::string_view commandName(const Command& command) {
  return kNames[command.index()];
}

Json commandToJson(const Command& command) {
  Json json = {{"do", std::string(commandName(command))}};
  Writer writer(json);
  Command copy = command;
  std::visit([&](auto& c) { visitFields(writer, c); }, copy);
  return json;
}

Command commandFromJson(const Json& json) {
  return readCommand(JsonView(json));
}

std::string commandTypes() {
  return "// The commands of a session, made by limber session types. Vectors are in world space, metres.\n"
         "export type Vector = [number, number, number];\n"
         "export type Ray = { origin: Vector; direction: Vector };\n"
         "export type KeyOfJoint = { joint?: string; seconds?: number };\n"
         "export type PoseKey = { pose: string; joints?: string[]; seconds?: number };\n"
         "/** A triangle of the surface, and where on it: (1 - u - v, u, v) of its corners. */\n"
         "export type SurfaceDab = [triangle: number, u: number, v: number];\n"
         "export type Command =" +
         unionOfCommands(std::make_index_sequence<std::variant_size_v<Command>>()) + ";\n";
}

std::string commandsToJson(std::span<const Command> commands) {
  Json list = Json::array();
  for (const Command& command : commands) list.push_back(commandToJson(command));
  return dumpJson({{"limber_commands", kCommandsVersion}, {"commands", std::move(list)}}, 1);
}

std::vector<Command> commandsFromJson(std::string_view text) {
  Warnings warnings;
  const Json document = parseJson(text, warnings);
  const JsonView root(document);
  const double version = root.number("limber_commands", 0);
  if (version > kCommandsVersion) root.fail("is a list of commands by a newer version of limber");
  if (version < 1) root.fail("is no list of commands");
  const JsonView list = root.array("commands");
  std::vector<Command> commands;
  for (std::size_t i = 0; i < list.size(); ++i) commands.push_back(readCommand(list[i]));
  return commands;
}

}  // namespace limber
