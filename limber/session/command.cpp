#include "limber/session/command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

constexpr int kCommandsVersion = 2;  // 1 knew no motions that are put on as they are added

template <class E>
using Word = std::pair<E, std::string_view>;

constexpr auto wordsOf(DragMode) {
  return std::to_array<Word<DragMode>>(
      {{DragMode::kMove, "move"}, {DragMode::kTurn, "turn"}, {DragMode::kScale, "scale"}});
}
constexpr auto wordsOf(MirrorFrom) {
  return std::to_array<Word<MirrorFrom>>(
      {{MirrorFrom::kBoth, "both"}, {MirrorFrom::kLeft, "left"}, {MirrorFrom::kRight, "right"}});
}
constexpr auto wordsOf(PaintMode) {
  return std::to_array<Word<PaintMode>>({{PaintMode::kAdd, "add"},
                                         {PaintMode::kSubtract, "subtract"},
                                         {PaintMode::kSmooth, "smooth"},
                                         {PaintMode::kReplace, "replace"}});
}
constexpr auto wordsOf(Interpolation) {
  return std::to_array<Word<Interpolation>>(
      {{Interpolation::kStep, "step"}, {Interpolation::kLinear, "linear"}, {Interpolation::kCubic, "cubic"}});
}
constexpr auto wordsOf(ContactChange) {
  return std::to_array<Word<ContactChange>>(
      {{ContactChange::kPlanted, "planted"}, {ContactChange::kFree, "free"}, {ContactChange::kFound, "found"}});
}
constexpr auto wordsOf(KeyTangents) {
  return std::to_array<Word<KeyTangents>>(
      {{KeyTangents::kAuto, "auto"}, {KeyTangents::kFlat, "flat"}, {KeyTangents::kFree, "free"}});
}

template <class E>
std::string_view wordFor(E value) {
  const auto words = wordsOf(value);
  return std::find_if(words.begin(), words.end(), [&](const Word<E>& word) { return word.first == value; })->second;
}

template <class T, class Visitor>
concept HasFields = requires(T value, Visitor visitor) {
  value.fields(visitor);
};

// Commands without fields have no list of them.
template <class C, class Visitor>
void visitFields(C& command, Visitor& visitor) {
  if constexpr (HasFields<C, Visitor>) command.fields(visitor);
}

class Writer {
 public:
  explicit Writer(Json& json) : json_(json) {}

  template <class T>
  Writer& operator()(const char* key, const T& value) {
    json_[key] = jsonOf(value);
    return *this;
  }
  Writer& optional(const char* key, const std::string& value) { return (*this)(key, value); }

 private:
  template <class T>
  static Json jsonOf(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return std::string(wordFor(value));
    } else if constexpr (std::is_same_v<T, Vec3>) {
      return Json::array({value.x(), value.y(), value.z()});
    } else if constexpr (std::is_same_v<T, SurfaceDab>) {
      return Json::array({value.triangle, value.u, value.v});
    } else if constexpr (HasFields<T, Writer>) {
      Json json;
      Writer writer(json);
      T copy = value;
      copy.fields(writer);
      return json;
    } else {
      return value;
    }
  }
  template <class T>
  static Json jsonOf(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values) list.push_back(jsonOf(value));
    return list;
  }

  Json& json_;
};

class Reader {
 public:
  explicit Reader(const JsonView& object) : object_(object) {}

  template <class T>
  Reader& operator()(const char* key, T& value) {
    known_.push_back(key);
    read(key, value);
    return *this;
  }
  Reader& optional(const char* key, std::string& value) {
    known_.push_back(key);
    value = object_.text(key, value);
    return *this;
  }

  void refuseOthers() const {
    object_.forEachMember([&](std::string_view key, const JsonView& value) {
      if (key == "do" || std::find(known_.begin(), known_.end(), key) != known_.end()) return;
      value.fail("is not part of this command");
    });
  }

 private:
  // A text that has no default must be there.
  void read(const char* key, std::string& value) const {
    if (value.empty()) require(key);
    value = object_.text(key, value);
  }
  void read(const char* key, Index& value) const { value = object_.index(key, kNoIndex).value_or(value); }
  void read(const char* key, double& value) const { value = object_.number(key, value); }
  void read(const char* key, bool& value) const { value = object_.flag(key, value); }
  void read(const char* key, Vec3& value) const {
    const JsonView array = object_.array(key);
    if (!array.exists()) return;
    if (array.size() != 3) array.fail("is not three numbers");
    value = {array[0].asNumber(), array[1].asNumber(), array[2].asNumber()};
  }
  void read(const char* key, Ray& value) const {
    const JsonView ray = object_.object(key);
    Reader reader(ray);
    value.fields(reader);
  }
  template <class E>
  requires std::is_enum_v<E>
  void read(const char* key, E& value) const {
    if (!object_.member(key).exists()) return;
    const std::string_view text = object_.text(key);
    for (const auto& [known, word] : wordsOf(value)) {
      if (text != word) continue;
      value = known;
      return;
    }
    object_.member(key).fail(fmt::format("cannot be '{}'", text));
  }
  template <class Item>
  void read(const char* key, std::vector<Item>& value) const {
    if constexpr (HasFields<Item, Reader>) require(key);
    const JsonView list = object_.array(key);
    for (std::size_t i = 0; i < list.size(); ++i) readItem(list[i], value.emplace_back());
  }

  static void readItem(const JsonView& json, std::string& item) {
    if (!json.json().is_string()) json.fail("is not a text");
    item = json.json().get<std::string>();
  }
  static void readItem(const JsonView& json, SurfaceDab& item) {
    if (!json.json().is_array() || json.size() != 3) json.fail("is not a triangle with two numbers");
    item = {json[0].asIndex(kNoIndex), json[1].asNumber(), json[2].asNumber()};
  }
  template <HasFields<Reader> Item>
  static void readItem(const JsonView& json, Item& item) {
    Reader entry(json);
    item.fields(entry);
    entry.refuseOthers();
  }

  void require(const char* key) const {
    if (!object_.member(key).exists()) object_.fail(fmt::format("has no \"{}\"", key));
  }

  const JsonView& object_;
  std::vector<std::string_view> known_;
};

// The fields as members of a TypeScript type.
class TypeWriter {
 public:
  explicit TypeWriter(std::string& text) : text_(text) {}

  template <class T>
  TypeWriter& operator()(const char* key, const T& value) {
    return member(key, isNeeded(value), typeOf(value));
  }
  TypeWriter& optional(const char* key, const std::string& value) { return member(key, false, typeOf(value)); }

 private:
  static bool isNeeded(const std::string& value) { return value.empty(); }
  template <HasFields<TypeWriter> T>
  static bool isNeeded(const std::vector<T>&) {
    return true;
  }
  template <class T>
  static bool isNeeded(const T&) {
    return false;
  }

  static std::string typeOf(const std::string&) { return "string"; }
  static std::string typeOf(bool) { return "boolean"; }
  static std::string typeOf(Index) { return "number"; }
  static std::string typeOf(double) { return "number"; }
  static std::string typeOf(const Vec3&) { return "Vector"; }
  static std::string typeOf(const Ray&) { return "Ray"; }
  static std::string typeOf(const KeyOfJoint&) { return "KeyOfJoint"; }
  static std::string typeOf(const PoseKey&) { return "PoseKey"; }
  static std::string typeOf(const SurfaceDab&) { return "SurfaceDab"; }
  template <class T>
  static std::string typeOf(const std::vector<T>&) {
    return typeOf(T()) + "[]";
  }
  template <class E>
  requires std::is_enum_v<E>
  static std::string typeOf(const E& value) {
    std::string words;
    for (const auto& [known, word] : wordsOf(value)) {
      words += fmt::format("{}'{}'", words.empty() ? "" : " | ", word);
    }
    return words;
  }

  TypeWriter& member(const char* key, bool isNeeded, std::string_view type) {
    text_ += fmt::format("; {}{}: {}", key, isNeeded ? "" : "?", type);
    return *this;
  }

  std::string& text_;
};

template <class C>
std::string typeOfCommand() {
  std::string text = fmt::format("\n  | {{ do: '{}'", C::kName);
  TypeWriter writer(text);
  C command;
  visitFields(command, writer);
  return text + " }";
}

template <class... C>
std::string unionOf(std::type_identity<std::variant<C...>>) {
  return (typeOfCommand<C>() + ...);
}

template <class C>
C readFields(const JsonView& object) {
  C command;
  Reader reader(object);
  visitFields(command, reader);
  reader.refuseOthers();
  return command;
}

template <class... C>
std::optional<Command> readNamed(std::string_view name, const JsonView& object,
                                 std::type_identity<std::variant<C...>>) {
  std::optional<Command> command;
  static_cast<void>(((name == C::kName && (command = readFields<C>(object), true)) || ...));
  return command;
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
    field("joint", turn.joint)("axis", axis)("degrees", degrees);
    turn.turn = degrees * axis.normalized();
    turn.relative = true;
    command = turn;
  } else if (name == "move_joint") {
    PlaceJoint move;
    field("joint", move.joint)("offset", move.position);
    move.relative = true;
    command = move;
  } else if (name == "move_key") {
    double from = 0, to = 0;
    field("from", from)("to", to);
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
  std::optional<Command> command = readNamed(name, object, std::type_identity<Command>());
  if (!command) command = readFormer(name, object);
  if (!command) object.fail(fmt::format("no command is called '{}'", name));
  bringUpToDate(*command);
  return *std::move(command);
}

}  // namespace

std::string_view keyTangentsName(KeyTangents tangents) {
  return wordFor(tangents);
}

std::string_view commandName(const Command& command) {
  return std::visit([](const auto& c) { return c.kName; }, command);
}

Json commandToJson(const Command& command) {
  Json json = {{"do", std::string(commandName(command))}};
  Writer writer(json);
  std::visit([&](auto c) { visitFields(c, writer); }, command);
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
         unionOf(std::type_identity<Command>()) + ";\n";
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
