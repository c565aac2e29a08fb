// The weights of a small network, made of random numbers, as a file. Not installed.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/core/file/file.h"
#include "limber/core/random.h"

namespace limber::testing {

struct MadeTensor {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

// Changed as a test likes, then written with file().
struct MadeWeights {
  nlohmann::json description;
  std::vector<std::pair<std::string, std::vector<std::uint16_t>>> halves;  // in the file's order
  std::map<std::string, MadeTensor> tensors;                               // the same as numbers

  Bytes file() const {
    const std::string text = description.dump();
    Bytes bytes = {'L', 'R', 'D', '1'};
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(text.size() >> (8 * i)));
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.resize((bytes.size() + 3) / 4 * 4);
    for (const auto& [name, numbers] : halves) {
      for (const std::uint16_t half : numbers) {
        bytes.push_back(static_cast<std::uint8_t>(half & 0xff));
        bytes.push_back(static_cast<std::uint8_t>(half >> 8));
      }
    }
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
  }
};

// Sizes of the made networks.
inline constexpr std::size_t kMadeWidth = 8, kMadeLayers = 2, kMadeHeads = 2, kMadeRatio = 2, kMadeSamples = 40,
                             kMadeAnchors = 9, kMadeNear = 3, kMadeGlobals = 2, kMadeRoles = 5, kMadeParts = 4,
                             kMadePlans = 3;

class WeightsMaker {
 public:
  explicit WeightsMaker(std::uint64_t seed) : random_(seed) {
    const nlohmann::json sizes = {{"width", kMadeWidth}, {"layers", kMadeLayers},  {"heads", kMadeHeads},
                                  {"ratio", kMadeRatio}, {"tokens", kMadeSamples}, {"places", kMadeAnchors},
                                  {"near", kMadeNear},   {"globals", kMadeGlobals}};
    made_.description = {{"networks", {{"reading", sizes}, {"stance", sizes}}},
                         {"roles", {"trunk_0", "fore_end.L", "fore_end.R", "ear.R", "ear.L"}},
                         {"parts", {"trunk", "fore_end.R", "fore_end.L", "tail"}},
                         {"plans", {"upright", "four", "none"}},
                         {"calibration", {{"plan_temperature", 1.5}, {"error_factor", 1.25}, {"sure_threshold", 0.4}}},
                         {"card", {{"seed", seed}}},
                         {"tensors", nlohmann::json::array()}};
  }

  MadeWeights make() {
    addTrunk("reading");
    add("reading.role_table", {kMadeRoles, kMadeWidth});
    addLinear("reading.pin", 3, kMadeWidth);
    add("reading.pin_vector", {kMadeWidth});
    addLinear("reading.vote", kMadeWidth, kMadeRoles);
    addLinear("reading.off", kMadeWidth, 3 * kMadeRoles);
    addLinear("reading.has", kMadeWidth, kMadeRoles);
    addLinear("reading.sig", kMadeWidth, kMadeRoles);
    addLinear("reading.plan", kMadeWidth, kMadePlans);
    addLinear("reading.fingers", kMadeWidth, 12);
    addLinear("reading.p1", 2 * kMadeWidth, kMadeWidth);
    addLinear("reading.p2", kMadeWidth, kMadeParts);
    addLinear("reading.p2b", kMadeWidth, 6);
    addTrunk("stance");
    addLinear("stance.score", kMadeWidth, 1);
    return std::move(made_);
  }

 private:
  void add(const std::string& name, const std::vector<std::size_t>& shape) {
    std::size_t count = 1;
    for (const std::size_t size : shape) count *= size;
    MadeTensor tensor = {shape, {}};
    std::vector<std::uint16_t> halves;
    for (std::size_t i = 0; i < count; ++i) {
      // Sign, an exponent of -4 to -1, ten bits of fraction.
      const bool negative = random_.below(2) == 1;
      const int exponent = static_cast<int>(random_.below(4)) - 4, fraction = static_cast<int>(random_.below(1024));
      halves.push_back(static_cast<std::uint16_t>((negative ? 0x8000 : 0) | (exponent + 15) << 10 | fraction));
      tensor.values.push_back((negative ? -1 : 1) * std::ldexp(1 + fraction / 1024.0, exponent));
    }
    made_.description["tensors"].push_back({{"name", name}, {"shape", shape}});
    made_.halves.emplace_back(name, std::move(halves));
    made_.tensors[name] = std::move(tensor);
  }

  void addLinear(const std::string& name, std::size_t inputs, std::size_t outputs) {
    add(name + ".weight", {inputs, outputs});
    add(name + ".bias", {outputs});
  }

  void addNorm(const std::string& name) {
    add(name + ".weight", {kMadeWidth});
    add(name + ".bias", {kMadeWidth});
  }

  void addTrunk(const std::string& network) {
    addLinear(network + ".e1", 29, 64);
    addLinear(network + ".e2", 64, kMadeWidth);
    addLinear(network + ".wf", kMadeWidth, kMadeWidth);
    addLinear(network + ".wr", 4, kMadeWidth);
    addLinear(network + ".wg", kMadeWidth, kMadeWidth);
    add(network + ".token", {kMadeGlobals, kMadeWidth});
    for (std::size_t i = 0; i < kMadeLayers; ++i) {
      const std::string layer = network + ".layers." + std::to_string(i);
      addNorm(layer + ".n1");
      addNorm(layer + ".n2");
      addLinear(layer + ".qkv", kMadeWidth, 3 * kMadeWidth);
      addLinear(layer + ".out", kMadeWidth, kMadeWidth);
      addLinear(layer + ".a", kMadeWidth, kMadeRatio * kMadeWidth);
      addLinear(layer + ".b", kMadeRatio * kMadeWidth, kMadeWidth);
    }
    addNorm(network + ".norm");
    addLinear(network + ".whole", kMadeGlobals * kMadeWidth, kMadeWidth);
  }

  Random random_;
  MadeWeights made_;
};

inline MadeWeights madeWeights(std::uint64_t seed = 1) {
  return WeightsMaker(seed).make();
}

}  // namespace limber::testing
