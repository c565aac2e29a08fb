#include "limber/document/fbx/export_fbx_objects.h"

#include <cmath>

namespace limber {

namespace {

// A text is a string, never a bool.
FbxValue fbxTextValue(std::string_view text) {
  return std::string(text);
}

}  // namespace

FbxNode& addRecord(FbxNode& parent, std::string_view name, std::vector<FbxValue> values) {
  parent.children.push_back({std::string(name), std::move(values), {}});
  return parent.children.back();
}

void FbxPropertyWriter::add(std::string_view name, std::string_view type, std::string_view label,
                            std::string_view flags, std::vector<FbxValue> values) {
  FbxNode& record =
      addRecord(list_, "P", {fbxTextValue(name), fbxTextValue(type), fbxTextValue(label), fbxTextValue(flags)});
  for (FbxValue& value : values) record.values.push_back(std::move(value));
}

void FbxPropertyWriter::text(std::string_view name, std::string_view value) {
  add(name, "KString", "", "", {fbxTextValue(value)});
}

void FbxPropertyWriter::integer(std::string_view name, int value) {
  add(name, "int", "Integer", "", {std::int32_t{value}});
}

void FbxPropertyWriter::flag(std::string_view name, bool value) {
  add(name, "bool", "", "", {std::int32_t{value}});
}

void FbxPropertyWriter::choice(std::string_view name, int value) {
  add(name, "enum", "", "", {std::int32_t{value}});
}

void FbxPropertyWriter::number(std::string_view name, double value, std::string_view flags) {
  add(name, flags.empty() ? "double" : "Number", flags.empty() ? "Number" : "", flags, {value});
}

void FbxPropertyWriter::color(std::string_view name, const Vec3& value) {
  add(name, "Color", "", "A", {value.x(), value.y(), value.z()});
}

void FbxPropertyWriter::vector(std::string_view name, const Vec3& value) {
  add(name, "Vector3D", "Vector", "", {value.x(), value.y(), value.z()});
}

void FbxPropertyWriter::animatable(std::string_view name, const Vec3& value) {
  add(name, name, "", "A", {value.x(), value.y(), value.z()});
}

void FbxPropertyWriter::time(std::string_view name, std::int64_t value) {
  add(name, "KTime", "Time", "", {value});
}

std::string fbxName(std::string_view name, std::string_view objectClass) {
  std::string whole(name);
  for (char& c : whole) c = static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  whole.push_back('\0');
  whole.push_back('\1');
  return whole.append(objectClass);
}

FbxObjectWriter::Made FbxObjectWriter::make(std::string_view type, std::string_view name, std::string_view objectClass,
                                            std::string_view kind) {
  ++counts_[std::string(type)];
  const FbxId id = newId();
  return {id, addRecord(objects_, type, {id, fbxName(name, objectClass), fbxTextValue(kind)})};
}

void FbxObjectWriter::connect(FbxId child, FbxId parent) {
  addRecord(connections_, "C", {fbxTextValue("OO"), child, parent});
}

void FbxObjectWriter::connect(FbxId child, FbxId parent, std::string_view property) {
  addRecord(connections_, "C", {fbxTextValue("OP"), child, parent, fbxTextValue(property)});
}

std::vector<double> fbxMatrix(const Affine& affine) {
  const Mat4& matrix = affine.matrix();  // by columns
  return {matrix.data(), matrix.data() + matrix.size()};
}

std::int64_t fbxTime(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * static_cast<double>(kFbxSecond)));
}

}  // namespace limber
