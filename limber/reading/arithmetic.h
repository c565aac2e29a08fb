// The arithmetic of networks in float, with the same bits on every machine: each sum in the order of its index, nothing
// contracted, and no function of the C library but std::sqrt, which IEEE 754 rounds one way only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limber {

// Row by row.
struct FloatMatrix {
  std::size_t rows = 0, columns = 0;
  std::vector<float> values;  // rows x columns

  FloatMatrix() = default;
  FloatMatrix(std::size_t rowCount, std::size_t columnCount)
      : rows(rowCount), columns(columnCount), values(rowCount * columnCount, 0) {}

  float* row(std::size_t r) { return values.data() + r * columns; }
  const float* row(std::size_t r) const { return values.data() + r * columns; }
};

struct Linear {
  FloatMatrix weight;       // a row for each input
  std::vector<float> bias;  // one for each output
};

struct LayerNorm {
  std::vector<float> gain, bias;
};

// Within 3e-7 of itself. Arguments below -87 give the value of -87, those above 88 that of 88; so does NaN that of -87.
float portableExp(float x);

struct SineCosine {
  float sine, cosine;
};

// Within 1e-7 for arguments up to 1e4, to which larger ones are clamped; no number gives that of -1e4.
SineCosine portableSineCosine(float x);

// A block of a matrix inside a larger one: row r begins at values + r * stride.
struct ConstBlock {
  const float* values;
  std::size_t stride;
};

// result[r][o] = bias[o] + x[r][0] * weight[0][o] + x[r][1] * weight[1][o] + ..., from left to right. No bias: from 0.
//
// x       rows x inputs
// weight  inputs x outputs
// result  rows x outputs, resultStride apart; is none of the others
// Cost: rows * inputs * outputs multiplications, some 4 to 8 in a nanosecond on one core.
void multiply(const ConstBlock& x, std::size_t rows, std::size_t inputs, const ConstBlock& weight, std::size_t outputs,
              const float* bias, float* result, std::size_t resultStride);

// x has a column for each input of `linear`.
FloatMatrix apply(const Linear& linear, const FloatMatrix& x);

// Each row less its mean, over its deviation, times gain, plus bias.
FloatMatrix apply(const LayerNorm& norm, const FloatMatrix& x);

void add(const FloatMatrix& summand, FloatMatrix& sum);

// Each value or 0, whichever is more.
FloatMatrix rectified(FloatMatrix x);

// exp of each value over the sum of all; at least one value.
void softmax(std::span<float> values);

// Of logits, in double.
double sigmoid(double logit);

}  // namespace limber
