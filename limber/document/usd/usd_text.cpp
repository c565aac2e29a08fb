#include "limber/document/usd/usd_text.h"

#include <iterator>

#include <fmt/format.h>

namespace limber {

namespace {

// A label as it is written in quotes.
std::string escaped(std::string_view label) {
  std::string result;
  for (const char c : label) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

class UsdTextWriter {
 public:
  std::string write(const UsdStage& stage) {
    line("#usda 1.0");
    line("(");
    ++depth_;
    line(fmt::format("defaultPrim = \"{}\"", kUsdRoot));
    line("metersPerUnit = 1");
    line("upAxis = \"Y\"");
    if (stage.endTimeCode > 0) {
      line("startTimeCode = 0");
      line(fmt::format("endTimeCode = {}", stage.endTimeCode));
      line(fmt::format("timeCodesPerSecond = {}", stage.timeCodesPerSecond));
    }
    --depth_;
    line(")");
    writePrim(stage.root);
    return std::move(out_);
  }

 private:
  void line(std::string_view text) {
    out_.append(depth_, ' ');
    out_ += text;
    out_ += '\n';
  }

  void writePrim(const UsdPrim& prim) {
    const bool hasMetadata = !prim.schemas.empty() || !prim.displayName.empty();
    line(fmt::format("def {} \"{}\"{}", prim.type, prim.name, hasMetadata ? " (" : ""));
    if (!prim.schemas.empty()) {
      line(fmt::format(" prepend apiSchemas = [\"{}\"]", fmt::join(prim.schemas, "\", \"")));
    }
    if (!prim.displayName.empty()) line(fmt::format(" displayName = \"{}\"", escaped(prim.displayName)));
    if (hasMetadata) line(")");
    line("{");
    ++depth_;
    for (const UsdProperty& property : prim.properties) writeProperty(property);
    for (const UsdPrim& child : prim.children) writePrim(child);
    --depth_;
    line("}");
  }

  void writeProperty(const UsdProperty& property) {
    const bool isRelationship = property.type.empty();
    decimals_ = property.decimals;
    type_ = property.type;
    const std::string start = fmt::format("{}{} {}", property.isUniform && !isRelationship ? "uniform " : "",
                                          isRelationship ? "rel" : property.type, property.name);
    if (!property.samples.empty()) writeSamples(start, property);
    if (!property.samples.empty() && std::holds_alternative<std::monostate>(property.value)) return;
    out_.append(depth_, ' ');
    out_ += start;
    if (!property.targets.empty()) {
      const std::string targets = fmt::format("<{}>", fmt::join(property.targets, ">, <"));
      out_ += isRelationship ? " = " : ".connect = ";
      out_ += property.targets.size() > 1 ? fmt::format("[{}]", targets) : targets;
    } else if (!std::holds_alternative<std::monostate>(property.value)) {
      out_ += " = ";
      std::visit([this](const auto& content) { append(content); }, property.value);
    }
    writeMetadata(property);
    out_ += '\n';
  }

  void writeSamples(const std::string& start, const UsdProperty& property) {
    line(start + ".timeSamples = {");
    for (const auto& [time, value] : property.samples) {
      out_.append(depth_, ' ');
      fmt::format_to(std::back_inserter(out_), " {}: ", time);
      std::visit([this](const auto& content) { append(content); }, value);
      out_ += ",\n";
    }
    line("}");
  }

  void writeMetadata(const UsdProperty& property) {
    if (!property.elementSize && property.interpolation.empty()) return;
    out_ += " (\n";
    if (property.elementSize) line(fmt::format(" elementSize = {}", *property.elementSize));
    if (!property.interpolation.empty()) line(fmt::format(" interpolation = \"{}\"", property.interpolation));
    out_.append(depth_, ' ');
    out_ += ')';
  }

  void append(std::monostate) {}
  void append(bool value) { out_ += value ? '1' : '0'; }
  void append(int value) { fmt::format_to(std::back_inserter(out_), "{}", value); }
  void append(float value) {
    if (type_ == "half3[]") value = static_cast<float>(Eigen::half(value));  // what readers make of it
    if (!decimals_) {
      fmt::format_to(std::back_inserter(out_), "{}", value + 0.0f);  // no negative zeros
      return;
    }
    fmt::format_to(std::back_inserter(out_), "{:.{}f}", value, *decimals_);
    if (*decimals_ > 0) {
      while (out_.back() == '0') out_.pop_back();
      if (out_.back() == '.') out_.pop_back();
    }
    if (out_.ends_with("-0")) out_.replace(out_.size() - 2, 2, "0");
  }
  void append(double value) { fmt::format_to(std::back_inserter(out_), "{:.10g}", value + 0.0); }
  void append(const std::string& value) {
    const bool isAsset = type_ == "asset";
    const std::string_view quote = !isAsset ? "\"" : value.find('@') == std::string::npos ? "@" : "@@@";
    out_ += quote;
    out_ += isAsset ? value : escaped(value);
    out_ += quote;
  }
  void append(const Vec2f& value) { appendTuple(value.x(), value.y()); }
  void append(const Vec3f& value) { appendTuple(value.x(), value.y(), value.z()); }
  void append(const Vec4f& value) { appendTuple(value.x(), value.y(), value.z(), value.w()); }
  void append(const Eigen::Quaternionf& value) { appendTuple(value.w(), value.x(), value.y(), value.z()); }
  // Rows, which in USD are the images of the axes and, last, the translation.
  void append(const Affine& value) {
    for (int row = 0; row < 4; ++row) {
      const Vec4 column = value.matrix().col(row);
      out_ += row == 0 ? '(' : ',';
      appendTuple(column.x(), column.y(), column.z(), column.w());
    }
    out_ += ')';
  }
  template <typename Value>
  void append(const std::vector<Value>& values) {
    out_ += '[';
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) out_ += ',';
      append(values[i]);
    }
    out_ += ']';
  }
  template <typename... Numbers>
  void appendTuple(Numbers... numbers) {
    char before = '(';
    const auto appendOne = [&](auto number) {
      out_ += before;
      append(number);
      before = ',';
    };
    (appendOne(numbers), ...);
    out_ += ')';
  }

  std::string out_;
  std::size_t depth_ = 0;
  std::string_view type_;        // of the property that is being written
  std::optional<int> decimals_;  // likewise
};

}  // namespace

std::string usdText(const UsdStage& stage) {
  return UsdTextWriter().write(stage);
}

}  // namespace limber
