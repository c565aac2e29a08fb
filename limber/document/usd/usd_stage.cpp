#include "limber/document/usd/usd_stage.h"

namespace limber {

std::string usdName(std::string_view text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::string name;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80 && static_cast<unsigned char>(c) < 0xc0) continue;  // inside a letter
    name += isLetter(c) || isDigit(c) ? c : '_';
  }
  if (name.empty() || isDigit(name[0])) name.insert(name.begin(), '_');
  return name;
}

std::string usdLabel(std::string_view text) {
  std::string label(text);
  std::erase_if(label, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  return label;
}

void UsdPrim::display(const std::string& text) {
  if (usdName(text) != text) displayName = usdLabel(text);
}

UsdProperty& UsdPrim::add(std::string propertyType, std::string propertyName, UsdValue value) {
  UsdProperty& property = properties.emplace_back();
  property.type = std::move(propertyType);
  property.name = std::move(propertyName);
  property.value = std::move(value);
  return property;
}

UsdProperty& UsdPrim::addUniform(std::string propertyType, std::string propertyName, UsdValue value) {
  UsdProperty& property = add(std::move(propertyType), std::move(propertyName), std::move(value));
  property.isUniform = true;
  return property;
}

void UsdPrim::relate(std::string propertyName, std::vector<std::string> targets) {
  addUniform({}, std::move(propertyName), {}).targets = std::move(targets);
}

void UsdPrim::connect(std::string propertyType, std::string propertyName, std::string target) {
  add(std::move(propertyType), std::move(propertyName)).targets = {std::move(target)};
}

}  // namespace limber
