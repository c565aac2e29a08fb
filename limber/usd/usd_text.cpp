#include "limber/usd/usd_text.h"

#include <iterator>

#include <fmt/format.h>

namespace limber {

namespace {

void appendNumbers(std::string& out, std::initializer_list<float> values, int digits) {
  char before = '(';
  for (const float value : values) {
    out += before;
    appendUsd(out, value, digits);
    before = ',';
  }
  out += ')';
}

void appendValue(std::string& out, int value) {
  fmt::format_to(std::back_inserter(out), "{}", value);
}
void appendValue(std::string& out, float value) {
  appendUsd(out, value);
}
void appendValue(std::string& out, const Vec2f& value) {
  appendUsd(out, value);
}
void appendValue(std::string& out, const Vec3f& value) {
  appendUsd(out, value);
}

// Rows, which in USD are the images of the axes and, last, the translation.
void appendValue(std::string& out, const Affine& value) {
  const char* before = "(";
  for (int row = 0; row < 4; ++row) {
    out += before;
    const char* between = "(";
    for (int column = 0; column < 4; ++column) {
      fmt::format_to(std::back_inserter(out), "{}{:.10g}", between, value.matrix()(column, row) + 0.0);
      between = ",";
    }
    out += ')';
    before = ",";
  }
  out += ')';
}

}  // namespace

std::string usdNumber(double value) {
  return fmt::format("{:.7g}", value + 0.0);
}

std::string usdName(std::string_view text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::string name;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80 && static_cast<unsigned char>(c) < 0xc0) continue;  // inside a letter
    name += isLetter(c) || isDigit(c) ? c : '_';
  }
  if (name.empty() || isDigit(name[0])) name.insert(0, "_");
  return name;
}

void appendUsd(std::string& out, float value, int digits) {
  value += 0.0f;  // no negative zeros
  if (digits > 0) {
    fmt::format_to(std::back_inserter(out), "{:.{}g}", value, digits);
  } else {
    fmt::format_to(std::back_inserter(out), "{}", value);
  }
}

void appendUsd(std::string& out, const Vec2f& value, int digits) {
  appendNumbers(out, {value.x(), value.y()}, digits);
}

void appendUsd(std::string& out, const Vec3f& value, int digits) {
  appendNumbers(out, {value.x(), value.y(), value.z()}, digits);
}

void appendUsd(std::string& out, const Eigen::Quaternionf& value, int digits) {
  appendNumbers(out, {value.w(), value.x(), value.y(), value.z()}, digits);
}

void UsdText::indent() {
  out_.append(2 * depth_, ' ');
}

void UsdText::line(std::string_view text) {
  indent();
  out_ += text;
  out_ += '\n';
}

void UsdText::open(std::string_view type, std::string_view name, const std::vector<std::string_view>& schemas) {
  line(fmt::format("def {} \"{}\"{}", type, name, schemas.empty() ? "" : " ("));
  if (!schemas.empty()) {
    std::string list;
    for (const std::string_view schema : schemas) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", schema);
    line(fmt::format("  prepend apiSchemas = [{}]", list));
    line(")");
  }
  line("{");
  ++depth_;
}

void UsdText::close() {
  --depth_;
  line("}");
}

template <typename Value>
void UsdText::arrayOf(std::string_view name, std::span<const Value> values, const std::vector<std::string>& metadata) {
  indent();
  fmt::format_to(std::back_inserter(out_), "{} = [", name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out_ += ',';
    appendValue(out_, values[i]);
  }
  out_ += metadata.empty() ? "]\n" : "] (\n";
  if (metadata.empty()) return;
  for (const std::string& entry : metadata) line("  " + entry);
  line(")");
}

void UsdText::array(std::string_view name, std::span<const int> values, const std::vector<std::string>& metadata) {
  arrayOf(name, values, metadata);
}
void UsdText::array(std::string_view name, std::span<const float> values, const std::vector<std::string>& metadata) {
  arrayOf(name, values, metadata);
}
void UsdText::array(std::string_view name, std::span<const Vec2f> values, const std::vector<std::string>& metadata) {
  arrayOf(name, values, metadata);
}
void UsdText::array(std::string_view name, std::span<const Vec3f> values, const std::vector<std::string>& metadata) {
  arrayOf(name, values, metadata);
}
void UsdText::matrices(std::string_view name, std::span<const Affine> values) {
  arrayOf(name, values, {});
}

void UsdText::list(std::string_view start, std::size_t number, const Values& values, std::string_view end) {
  indent();
  out_ += start;
  values(number, out_);
  out_ += end;
  out_ += '\n';
}

void UsdText::tokens(std::string_view name, const std::vector<std::string>& values) {
  std::string list;
  for (const std::string& value : values) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", value);
  line(fmt::format("{} = [{}]", name, list));
}

}  // namespace limber
