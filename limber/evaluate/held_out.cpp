#include "limber/evaluate/held_out.h"

#include <cctype>
#include <cstdint>

namespace limber {

std::string makerOf(const std::filesystem::path& file) {
  const std::string stem = file.stem().string(), folder = file.parent_path().filename().string();
  const std::string& name = folder.find('_') != std::string::npos ? folder : stem;
  std::string maker = name.substr(0, name.find('_'));
  while (!maker.empty() && std::isdigit(static_cast<unsigned char>(maker.back()))) maker.pop_back();
  return maker;
}

bool isHeldOut(const std::filesystem::path& file) {
  std::uint32_t hash = 2166136261u;
  for (const char letter : makerOf(file)) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619u;
  return (hash & 1) != 0;
}

}  // namespace limber
