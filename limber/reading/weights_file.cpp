#include "limber/reading/weights_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/file/bits.h"
#include "limber/reading/surface_samples.h"

namespace limber {

namespace {

using nlohmann::json;

constexpr std::string_view kMagic = "LRD1";
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kMaxFileBytes = 16 << 20;
constexpr int kMaxDepth = 16;  // of the JSON text
constexpr std::size_t kMaxNames = 1024;
constexpr std::size_t kMaxDimension = 1 << 16;

[[noreturn]] void failWith(const std::string& message, const std::string& where = {}) {
  throw Error(ErrorCode::kBadData, message, where.empty() ? "weights of a reading" : "weights of a reading: " + where,
              "get the file again, or train it with tools/learn");
}

// IEEE 754 binary16, exactly.
float widened(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const std::uint32_t exponent = (half >> 10) & 0x1f, fraction = half & 0x3ff;
  if (exponent == 0) {
    const float size = static_cast<float>(fraction) * 0x1p-24f;
    return sign ? -size : size;
  }
  const std::uint32_t widerExponent = exponent == 0x1f ? 0xff : exponent + 112;
  return bitCast<float>(sign | widerExponent << 23 | fraction << 13);
}

// ---- the JSON text

json parseText(ByteSpan text) {
  try {
    return json::parse(text.begin(), text.end(), [](int depth, json::parse_event_t, json&) {
      if (depth > kMaxDepth) failWith("the description is nested too deeply");
      return true;
    });
  } catch (const json::exception& problem) {
    failWith(fmt::format("the description is no JSON: {}", problem.what()));
  }
}

const json& member(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) failWith(fmt::format("the description lacks '{}'", name));
  return *found;
}

std::size_t sizeOf(const json& value, std::size_t max, const std::string& what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() < 1 || value.get<std::uint64_t>() > max) {
    failWith(fmt::format("'{}' is no number from 1 to {}", what, max));
  }
  return value.get<std::size_t>();
}

double positiveMember(const json& object, const char* name) {
  const json& value = member(object, name);
  const double number = value.is_number() ? value.get<double>() : 0;
  if (!(number > 0 && number <= 1000)) failWith(fmt::format("'{}' is no number above 0, up to 1000", name));
  return number;
}

std::vector<std::string> namesMember(const json& object, const char* name) {
  const json& list = member(object, name);
  if (!list.is_array() || list.empty() || list.size() > kMaxNames) {
    failWith(fmt::format("'{}' is no list of 1 to {} names", name, kMaxNames));
  }
  std::vector<std::string> names;
  for (const json& entry : list) {
    if (!entry.is_string()) failWith(fmt::format("'{}' is no list of names", name));
    names.push_back(entry.get<std::string>());
    if (std::find(names.begin(), names.end() - 1, names.back()) != names.end() - 1) {
      failWith(fmt::format("'{}' has '{}' twice", name, names.back()));
    }
  }
  return names;
}

NetworkSizes networkSizes(const json& description, const char* network) {
  const json& entry = member(member(description, "networks"), network);
  const auto size = [&](const char* name, std::size_t max) {
    return sizeOf(member(entry, name), max, fmt::format("networks.{}.{}", network, name));
  };
  NetworkSizes sizes;
  sizes.width = size("width", 1024);
  sizes.layers = size("layers", 64);
  sizes.heads = size("heads", sizes.width);
  sizes.ratio = size("ratio", 16);
  sizes.samples = size("tokens", kSurfacePoints);
  sizes.anchors = size("places", sizes.samples);
  sizes.near = size("near", sizes.samples);
  sizes.globals = size("globals", 64);
  if (sizes.width % sizes.heads != 0) failWith("the heads of attention do not divide the width", network);
  return sizes;
}

// For each name the index of that on the other side.
std::vector<Index> mirrorTable(const std::vector<std::string>& names) {
  std::vector<Index> table;
  for (const std::string& name : names) {
    std::string other = name;
    if (name.ends_with(".L")) other.back() = 'R';
    if (name.ends_with(".R")) other.back() = 'L';
    const auto found = std::find(names.begin(), names.end(), other);
    if (found == names.end()) failWith(fmt::format("'{}' has none on the other side", name));
    table.push_back(static_cast<Index>(found - names.begin()));
  }
  return table;
}

// ---- tensors

struct Tensor {
  std::size_t rows = 0, columns = 0;  // of a vector: no rows
  ByteSpan halves;
};

// Hands tensors out by name, each once.
class Tensors {
 public:
  Tensors(const json& list, ByteSpan data) {
    if (!list.is_array()) failWith("'tensors' is no list");
    std::size_t begin = 0;
    for (const json& entry : list) {
      const json& name = member(entry, "name");
      const json& shape = member(entry, "shape");
      if (!name.is_string()) failWith("a tensor's name is no text");
      const std::string text = name.get<std::string>();
      if (!shape.is_array() || shape.empty() || shape.size() > 2) failWith("its shape is not of 1 or 2 numbers", text);
      Tensor tensor;
      if (shape.size() == 2) tensor.rows = sizeOf(shape[0], kMaxDimension, text);
      tensor.columns = sizeOf(shape.back(), kMaxDimension, text);
      const std::uint64_t bytes = std::uint64_t{2} * std::max<std::size_t>(tensor.rows, 1) * tensor.columns;
      if (bytes > data.size() - begin) failWith("the file is cut off", text);
      tensor.halves = data.subspan(begin, static_cast<std::size_t>(bytes));
      begin += tensor.halves.size();
      if (!tensors_.emplace(text, tensor).second) failWith("a tensor is listed twice", text);
    }
    if (data.size() != (begin + 3) / 4 * 4) failWith("the file does not end behind the last tensor");
  }

  FloatMatrix matrix(const std::string& name, std::size_t rows, std::size_t columns) {
    FloatMatrix result(0, columns);
    result.values = take(name, rows, columns);
    result.rows = rows;
    return result;
  }

  std::vector<float> vector(const std::string& name, std::size_t size) { return take(name, 0, size); }

  Linear linear(const std::string& name, std::size_t inputs, std::size_t outputs) {
    return {matrix(name + ".weight", inputs, outputs), vector(name + ".bias", outputs)};
  }

  LayerNorm norm(const std::string& name, std::size_t width) {
    return {vector(name + ".weight", width), vector(name + ".bias", width)};
  }

  void checkAllTaken() const {
    if (!tensors_.empty()) failWith("there is a tensor that no network has", tensors_.begin()->first);
  }

 private:
  std::vector<float> take(const std::string& name, std::size_t rows, std::size_t columns) {
    const auto found = tensors_.find(name);
    if (found == tensors_.end()) failWith("a tensor is missing", name);
    const Tensor tensor = found->second;
    if (tensor.rows != rows || tensor.columns != columns) {
      failWith(fmt::format("its shape is {} x {} in place of {} x {}", tensor.rows, tensor.columns, rows, columns),
               name);
    }
    std::vector<float> values(tensor.halves.size() / 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = widened(static_cast<std::uint16_t>(tensor.halves[2 * i] | tensor.halves[2 * i + 1] << 8));
      if (!std::isfinite(values[i])) failWith("it has a number that is not finite", name);
    }
    tensors_.erase(found);
    return values;
  }

  std::map<std::string, Tensor> tensors_;
};

NetworkTrunk takeTrunk(Tensors& tensors, const std::string& network, const NetworkSizes& sizes) {
  const std::size_t width = sizes.width;
  NetworkTrunk trunk;
  trunk.sizes = sizes;
  trunk.embedFirst = tensors.linear(network + ".e1", kSampleFeatures, kFirstWidth);
  trunk.embedSecond = tensors.linear(network + ".e2", kFirstWidth, width);
  trunk.gatherFeature = tensors.linear(network + ".wf", width, width);
  trunk.gatherOffset = tensors.linear(network + ".wr", 4, width);
  trunk.gathered = tensors.linear(network + ".wg", width, width);
  trunk.globalTokens = tensors.matrix(network + ".token", sizes.globals, width);
  for (std::size_t i = 0; i < sizes.layers; ++i) {
    const std::string name = fmt::format("{}.layers.{}", network, i);
    AttentionLayer layer;
    layer.attentionNorm = tensors.norm(name + ".n1", width);
    layer.innerNorm = tensors.norm(name + ".n2", width);
    layer.queryKeyValue = tensors.linear(name + ".qkv", width, 3 * width);
    layer.attended = tensors.linear(name + ".out", width, width);
    layer.expand = tensors.linear(name + ".a", width, sizes.ratio * width);
    layer.contract = tensors.linear(name + ".b", sizes.ratio * width, width);
    trunk.layers.push_back(std::move(layer));
  }
  trunk.norm = tensors.norm(network + ".norm", width);
  trunk.whole = tensors.linear(network + ".whole", sizes.globals * width, width);
  return trunk;
}

ReadingNetwork takeReading(Tensors& tensors, const NetworkSizes& sizes, const ReadingWeights& weights) {
  const std::size_t width = sizes.width, roles = weights.roles.size();
  ReadingNetwork network;
  network.trunk = takeTrunk(tensors, "reading", sizes);
  network.roleTokens = tensors.matrix("reading.role_table", roles, width);
  network.pinPosition = tensors.linear("reading.pin", 3, width);
  network.pinToken = tensors.vector("reading.pin_vector", width);
  network.vote = tensors.linear("reading.vote", width, roles);
  network.voteOffset = tensors.linear("reading.off", width, 3 * roles);
  network.has = tensors.linear("reading.has", width, roles);
  network.logError = tensors.linear("reading.sig", width, roles);
  network.plan = tensors.linear("reading.plan", width, weights.plans.size());
  network.fingers = tensors.linear("reading.fingers", width, kHands * kFingerCounts);
  network.sampleInner = tensors.linear("reading.p1", 2 * width, width);
  network.samplePart = tensors.linear("reading.p2", width, weights.parts.size());
  network.sampleBone = tensors.linear("reading.p2b", width, kBoneNumbers);
  return network;
}

std::uint32_t word(ByteSpan file, std::size_t begin) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(file[begin + i]) << (8 * i);
  return value;
}

}  // namespace

ReadingWeights readReadingWeights(ByteSpan file) {
  const std::size_t seen = std::min(file.size(), kMagic.size());
  if (seen == 0 || std::memcmp(file.data(), kMagic.data(), seen) != 0) {
    const bool later = file.size() >= 3 && std::memcmp(file.data(), kMagic.data(), 3) == 0;
    throw Error(ErrorCode::kUnsupported,
                later ? "a later version of limber made it" : "the file is no weights of a reading",
                "weights of a reading", later ? "update limber" : "choose a file that begins with LRD1");
  }
  if (file.size() > kMaxFileBytes)
    throw Error(ErrorCode::kLimit, "the file is larger than 16 MB", "weights of a reading");
  if (file.size() < kHeaderBytes) failWith("the file is cut off");
  const std::size_t textBytes = word(file, 4);
  if (textBytes > file.size() - kHeaderBytes) failWith("the file is cut off", "description");
  const std::size_t dataBegin = (kHeaderBytes + textBytes + 3) / 4 * 4;
  if (dataBegin > file.size()) failWith("the file is cut off", "description");
  const json description = parseText(file.subspan(kHeaderBytes, textBytes));

  ReadingWeights weights;
  weights.roles = namesMember(description, "roles");
  weights.parts = namesMember(description, "parts");
  weights.plans = namesMember(description, "plans");
  weights.mirrorRole = mirrorTable(weights.roles);
  weights.mirrorPart = mirrorTable(weights.parts);
  const json& calibration = member(description, "calibration");
  weights.calibration = {positiveMember(calibration, "plan_temperature"), positiveMember(calibration, "error_factor"),
                         positiveMember(calibration, "sure_threshold")};
  weights.card = member(description, "card").dump();

  const NetworkSizes reading = networkSizes(description, "reading"), stance = networkSizes(description, "stance");
  if (reading.samples < stance.samples) failWith("the network of the stance reads more samples than the other");
  Tensors tensors(member(description, "tensors"), file.subspan(dataBegin));
  weights.reading = takeReading(tensors, reading, weights);
  weights.stance.trunk = takeTrunk(tensors, "stance", stance);
  weights.stance.score = tensors.linear("stance.score", stance.width, 1);
  tensors.checkAllTaken();
  return weights;
}

}  // namespace limber
