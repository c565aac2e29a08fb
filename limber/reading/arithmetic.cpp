#include "limber/reading/arithmetic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "limber/core/file/bits.h"
#include "limber/core/float4.h"
#include "limber/core/text/numbers.h"

namespace limber {

namespace {

// Added to the variance, as in torch.
constexpr float kNormEpsilon = 1e-5f;

Float4 loadFloat4(const float* from) {
  Float4 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Everything that a product is made of; tiles go over it.
struct Product {
  ConstBlock x;
  std::size_t inputs;
  ConstBlock weight;
  const float* bias;
  float* result;
  std::size_t resultStride;
};

// kRows rows and 4 * kVectors outputs, whose sums stay in registers. Each sum is made as in one output after the other.
template <int kRows, int kVectors>
void multiplyTile(const Product& product, std::size_t row, std::size_t output) {
  Float4 sums[kRows][kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const Float4 first = product.bias ? loadFloat4(product.bias + output + 4 * v) : Float4{};
    for (int r = 0; r < kRows; ++r) sums[r][v] = first;
  }
  const float* x = product.x.values + row * product.x.stride;
  const float* weight = product.weight.values + output;
  for (std::size_t i = 0; i < product.inputs; ++i, weight += product.weight.stride) {
    Float4 weights[kVectors];
    for (int v = 0; v < kVectors; ++v) weights[v] = loadFloat4(weight + 4 * v);
    for (int r = 0; r < kRows; ++r) {
      const float value = x[r * product.x.stride + i];
      const Float4 values = {value, value, value, value};
      for (int v = 0; v < kVectors; ++v) sums[r][v] = sums[r][v] + values * weights[v];
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      std::memcpy(product.result + (row + r) * product.resultStride + output + 4 * v, &sums[r][v], sizeof(Float4));
    }
  }
}

void multiplyOne(const Product& product, std::size_t row, std::size_t output) {
  float sum = product.bias ? product.bias[output] : 0;
  const float* x = product.x.values + row * product.x.stride;
  const float* weight = product.weight.values + output;
  for (std::size_t i = 0; i < product.inputs; ++i) sum = sum + x[i] * weight[i * product.weight.stride];
  product.result[row * product.resultStride + output] = sum;
}

template <int kVectors>
void multiplyColumns(const Product& product, std::size_t rows, std::size_t output) {
  constexpr int kRows = 4;
  std::size_t row = 0;
  for (; row + kRows <= rows; row += kRows) multiplyTile<kRows, kVectors>(product, row, output);
  for (; row < rows; ++row) multiplyTile<1, kVectors>(product, row, output);
}

// 2^exponent, of -126 to 127.
float powerOfTwo(int exponent) {
  return bitCast<float>(static_cast<std::uint32_t>(exponent + 127) << 23);
}

}  // namespace

// The polynomial is that of Cephes' expf (Moshier 1989), for arguments within half of ln 2.
float portableExp(float x) {
  x = x > -87.0f ? x : -87.0f;
  x = x < 88.0f ? x : 88.0f;
  const int exponent = static_cast<int>(x * 1.44269504f + (x < 0 ? -0.5f : 0.5f));
  const auto e = static_cast<float>(exponent);
  x = x - e * 0.693359375f;  // ln 2 in two parts; the first has few bits, so that the product is exact
  x = x - e * -2.12194440e-4f;
  float p = 1.9875691500e-4f;
  p = p * x + 1.3981999507e-3f;
  p = p * x + 8.3334519073e-3f;
  p = p * x + 4.1665795894e-2f;
  p = p * x + 1.6666665459e-1f;
  p = p * x + 5.0000001201e-1f;
  return (p * (x * x) + x + 1.0f) * powerOfTwo(exponent);
}

// The polynomials are those of Cephes' sinf and cosf, within an eighth of a full circle round zero.
SineCosine portableSineCosine(float x) {
  constexpr float kLargest = 1e4f;
  x = x > -kLargest ? x : -kLargest;
  x = x < kLargest ? x : kLargest;
  const double quarters = x * (2 / kPi);
  const int quarter = static_cast<int>(quarters + (quarters < 0 ? -0.5 : 0.5));
  const auto rest = static_cast<float>(x - quarter * (kPi / 2));
  const float square = rest * rest;
  const float sine =
      ((-1.9515295891e-4f * square + 8.3321608736e-3f) * square - 1.6666654611e-1f) * square * rest + rest;
  const float cosine =
      ((2.443315711809948e-5f * square - 1.388731625493765e-3f) * square + 4.166664568298827e-2f) * (square * square) -
      0.5f * square + 1.0f;
  switch (quarter & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

void multiply(const ConstBlock& x, std::size_t rows, std::size_t inputs, const ConstBlock& weight, std::size_t outputs,
              const float* bias, float* result, std::size_t resultStride) {
  const Product product = {x, inputs, weight, bias, result, resultStride};
  std::size_t output = 0;
  for (; output + 8 <= outputs; output += 8) multiplyColumns<2>(product, rows, output);
  for (; output + 4 <= outputs; output += 4) multiplyColumns<1>(product, rows, output);
  for (; output < outputs; ++output) {
    for (std::size_t row = 0; row < rows; ++row) multiplyOne(product, row, output);
  }
}

FloatMatrix apply(const Linear& linear, const FloatMatrix& x) {
  FloatMatrix result(x.rows, linear.weight.columns);
  multiply({x.values.data(), x.columns}, x.rows, x.columns, {linear.weight.values.data(), linear.weight.columns},
           linear.weight.columns, linear.bias.data(), result.values.data(), result.columns);
  return result;
}

FloatMatrix apply(const LayerNorm& norm, const FloatMatrix& x) {
  FloatMatrix result(x.rows, x.columns);
  const auto count = static_cast<float>(x.columns);
  for (std::size_t r = 0; r < x.rows; ++r) {
    const float* from = x.row(r);
    float sum = 0, squares = 0;
    for (std::size_t c = 0; c < x.columns; ++c) sum = sum + from[c];
    const float mean = sum / count;
    for (std::size_t c = 0; c < x.columns; ++c) squares = squares + (from[c] - mean) * (from[c] - mean);
    const float scale = 1.0f / std::sqrt(squares / count + kNormEpsilon);
    for (std::size_t c = 0; c < x.columns; ++c) {
      result.row(r)[c] = (from[c] - mean) * scale * norm.gain[c] + norm.bias[c];
    }
  }
  return result;
}

void add(const FloatMatrix& summand, FloatMatrix& sum) {
  for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] = sum.values[i] + summand.values[i];
}

FloatMatrix rectified(FloatMatrix x) {
  for (float& value : x.values) value = value > 0 ? value : 0;
  return x;
}

void softmax(std::span<float> values) {
  float largest = values[0], sum = 0;
  for (const float value : values) largest = std::max(largest, value);
  for (float& value : values) {
    value = portableExp(value - largest);
    sum = sum + value;
  }
  for (float& value : values) value = value / sum;
}

double sigmoid(double logit) {
  const double e = portableExp(static_cast<float>(logit < 0 ? logit : -logit));
  return logit < 0 ? e / (1 + e) : 1 / (1 + e);
}

}  // namespace limber
