#include "limber/reading/network.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/reading/testing/made_weights.h"
#include "limber/reading/weights_file.h"

namespace limber {
namespace {

using Rows = std::vector<std::vector<double>>;

// The networks once more, in double, as training writes them down.
class PlainNetwork {
 public:
  PlainNetwork(const testing::MadeWeights& made, std::string name) : made_(made), name_(std::move(name)) {}

  const testing::MadeTensor& tensor(const std::string& name) const { return made_.tensors.at(name_ + "." + name); }

  Rows linear(const std::string& name, const Rows& x) const {
    const testing::MadeTensor &weight = tensor(name + ".weight"), &bias = tensor(name + ".bias");
    Rows result(x.size(), bias.values);
    for (std::size_t r = 0; r < x.size(); ++r) {
      for (std::size_t o = 0; o < bias.values.size(); ++o) {
        for (std::size_t i = 0; i < x[r].size(); ++i)
          result[r][o] += x[r][i] * weight.values[i * bias.values.size() + o];
      }
    }
    return result;
  }

  Rows norm(const std::string& name, Rows x) const {
    for (std::vector<double>& row : x) {
      double mean = 0, variance = 0;
      for (const double value : row) mean += value / static_cast<double>(row.size());
      for (const double value : row) variance += (value - mean) * (value - mean) / static_cast<double>(row.size());
      for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = (row[i] - mean) / std::sqrt(variance + 1e-5) * tensor(name + ".weight").values[i] +
                 tensor(name + ".bias").values[i];
      }
    }
    return x;
  }

  static Rows relu(Rows x) {
    for (std::vector<double>& row : x) {
      for (double& value : row) value = std::max(value, 0.0);
    }
    return x;
  }

  static void softmax(std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += std::exp(value);
    for (double& value : values) value = std::exp(value) / sum;
  }

  static Rows sum(Rows x, const Rows& y) {
    for (std::size_t r = 0; r < x.size(); ++r) {
      for (std::size_t i = 0; i < x[r].size(); ++i) x[r][i] += y[r][i];
    }
    return x;
  }

  Rows attention(const std::string& layer, const Rows& x) const {
    const Rows qkv = linear(layer + ".qkv", norm(layer + ".n1", x));
    const std::size_t width = x[0].size(), headWidth = width / testing::kMadeHeads;
    Rows mixed(x.size(), std::vector<double>(width, 0));
    for (std::size_t head = 0; head < testing::kMadeHeads; ++head) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        std::vector<double> weights(x.size(), 0);
        for (std::size_t j = 0; j < x.size(); ++j) {
          for (std::size_t c = 0; c < headWidth; ++c) {
            weights[j] += qkv[i][head * headWidth + c] * qkv[j][width + head * headWidth + c];
          }
          weights[j] /= std::sqrt(static_cast<double>(headWidth));
        }
        softmax(weights);
        for (std::size_t j = 0; j < x.size(); ++j) {
          for (std::size_t c = 0; c < headWidth; ++c) {
            mixed[i][head * headWidth + c] += weights[j] * qkv[j][2 * width + head * headWidth + c];
          }
        }
      }
    }
    return linear(layer + ".out", mixed);
  }

  struct Known {
    Rows embedded, anchors, whole;
  };

  static double distance(const std::vector<double>& a, const std::vector<double>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }

  Known run(const Rows& features, const Rows& pins) const {
    Known known;
    known.embedded = linear("e2", relu(linear("e1", features)));
    const Rows said = linear("wf", relu(known.embedded));
    Rows gathered;
    for (std::size_t a = 0; a < testing::kMadeAnchors; ++a) {
      std::vector<std::size_t> order(features.size());
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
      std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return distance(features[i], features[a]) < distance(features[j], features[a]);
      });
      std::vector<double> largest(testing::kMadeWidth, 0);
      for (std::size_t k = 0; k < testing::kMadeNear; ++k) {
        const std::vector<double>&near = features[order[k]], &own = features[a];
        const Rows relative = {{near[0] - own[0], near[1] - own[1], near[2] - own[2], distance(near, own)}};
        const Rows value = relu(sum({said[order[k]]}, linear("wr", relative)));
        for (std::size_t c = 0; c < largest.size(); ++c) largest[c] = std::max(largest[c], value[0][c]);
      }
      gathered.push_back(largest);
    }
    Rows x;
    for (std::size_t g = 0; g < testing::kMadeGlobals; ++g) {
      const auto begin = tensor("token").values.begin() + static_cast<std::ptrdiff_t>(g * testing::kMadeWidth);
      x.emplace_back(begin, begin + testing::kMadeWidth);
    }
    const Rows anchors = sum(linear("wg", gathered), known.embedded);
    x.insert(x.end(), anchors.begin(), anchors.end());
    x.insert(x.end(), pins.begin(), pins.end());
    for (std::size_t l = 0; l < testing::kMadeLayers; ++l) {
      const std::string layer = "layers." + std::to_string(l);
      x = sum(x, attention(layer, x));
      x = sum(x, linear(layer + ".b", relu(linear(layer + ".a", norm(layer + ".n2", x)))));
    }
    x = norm("norm", x);
    Rows globals(1);
    for (std::size_t g = 0; g < testing::kMadeGlobals; ++g)
      globals[0].insert(globals[0].end(), x[g].begin(), x[g].end());
    known.whole = relu(linear("whole", globals));
    known.anchors.assign(x.begin() + testing::kMadeGlobals, x.begin() + testing::kMadeGlobals + testing::kMadeAnchors);
    return known;
  }

  Rows pinTokens(std::span<const RolePin> pins) const {
    Rows tokens;
    for (const RolePin& pin : pins) {
      Rows token = linear("pin", {{pin.position.x(), pin.position.y(), pin.position.z()}});
      for (std::size_t c = 0; c < testing::kMadeWidth; ++c) {
        token[0][c] += tensor("role_table").values[pin.role * testing::kMadeWidth + c] + tensor("pin_vector").values[c];
      }
      tokens.push_back(token[0]);
    }
    return tokens;
  }

  Rows positions(const Rows& features, const Rows& anchors) const {
    const Rows votes = linear("vote", anchors), offsets = linear("off", anchors);
    Rows result;
    for (std::size_t role = 0; role < testing::kMadeRoles; ++role) {
      std::vector<double> weights, position(3, 0);
      for (const std::vector<double>& vote : votes) weights.push_back(vote[role]);
      softmax(weights);
      for (std::size_t a = 0; a < anchors.size(); ++a) {
        for (std::size_t k = 0; k < 3; ++k) position[k] += weights[a] * (features[a][k] + offsets[a][3 * role + k]);
      }
      result.push_back(position);
    }
    return result;
  }

  Rows sampleInner(const Rows& features, const Known& known) const {
    Rows both = relu(known.embedded);
    for (std::size_t i = 0; i < both.size(); ++i) {
      std::size_t nearest = 0;
      for (std::size_t a = 1; a < known.anchors.size(); ++a) {
        if (distance(features[i], features[a]) < distance(features[i], features[nearest])) nearest = a;
      }
      both[i].insert(both[i].end(), known.anchors[nearest].begin(), known.anchors[nearest].end());
    }
    return relu(linear("p1", both));
  }

 private:
  const testing::MadeWeights& made_;
  std::string name_;
};

FloatMatrix randomFeatures() {
  Random random(11);
  FloatMatrix features(testing::kMadeSamples, 29);
  for (float& value : features.values) value = static_cast<float>(random.uniform(-1.5, 1.5));
  return features;
}

Rows rowsOf(const FloatMatrix& matrix) {
  Rows rows;
  for (std::size_t r = 0; r < matrix.rows; ++r) rows.emplace_back(matrix.row(r), matrix.row(r) + matrix.columns);
  return rows;
}

void expectNear(std::span<const float> values, const Rows& expected) {
  std::vector<double> flat;
  for (const std::vector<double>& row : expected) flat.insert(flat.end(), row.begin(), row.end());
  ASSERT_EQ(values.size(), flat.size());
  for (std::size_t i = 0; i < flat.size(); ++i) EXPECT_NEAR(values[i], flat[i], 2e-5 * (1 + std::abs(flat[i])));
}

TEST(ReadingNetwork, AgreesWithTheSameInDouble) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const testing::MadeWeights made = testing::madeWeights(seed);
    const ReadingWeights weights = readReadingWeights(made.file());
    const FloatMatrix features = randomFeatures();
    const std::vector<RolePin> pins = {{3, {0.5f, -1, 0.25f}}, {0, {0, 0.75f, 1}}};
    const ReadingOutput output = evaluate(weights.reading, features, pins);

    const PlainNetwork plain(made, "reading");
    const Rows rows = rowsOf(features);
    const PlainNetwork::Known known = plain.run(rows, plain.pinTokens(pins));
    expectNear(output.positions.values, plain.positions(rows, known.anchors));
    expectNear(output.has, plain.linear("has", known.whole));
    Rows logErrors = plain.linear("sig", known.whole);
    for (double& value : logErrors[0]) value = std::clamp(value, -6.0, 2.0);
    expectNear(output.logError, logErrors);
    expectNear(output.plan, plain.linear("plan", known.whole));
    expectNear(output.fingers.values, plain.linear("fingers", known.whole));
    EXPECT_EQ(output.fingers.rows, 2u);
    const Rows inner = plain.sampleInner(rows, known);
    expectNear(output.parts.values, plain.linear("p2", inner));
    expectNear(output.bones.values, plain.linear("p2b", inner));
  }
}

TEST(ReadingNetwork, ReadsPins) {
  const ReadingWeights weights = readReadingWeights(testing::madeWeights().file());
  const FloatMatrix features = randomFeatures();
  const std::vector<RolePin> pins = {{1, {0, 1, 0}}, {4, {1, 0, 0}}};
  const ReadingOutput none = evaluate(weights.reading, features, {});
  const ReadingOutput both = evaluate(weights.reading, features, pins);
  EXPECT_NE(none.positions.values, both.positions.values);
  EXPECT_THROW(evaluate(weights.reading, features, std::vector<RolePin>{{5, {0, 0, 0}}}), Error);
  EXPECT_THROW(evaluate(weights.reading, FloatMatrix(39, 29), {}), Error);
}

TEST(StanceNetwork, AgreesWithTheSameInDouble) {
  const testing::MadeWeights made = testing::madeWeights();
  const ReadingWeights weights = readReadingWeights(made.file());
  const FloatMatrix features = randomFeatures();
  const PlainNetwork plain(made, "stance");
  const std::vector<float> score = {evaluate(weights.stance, features)};
  expectNear(score, plain.linear("score", plain.run(rowsOf(features), {}).whole));
}

}  // namespace
}  // namespace limber
