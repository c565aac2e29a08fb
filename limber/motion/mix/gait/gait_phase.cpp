#include "limber/motion/mix/gait/gait_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr double kShortest = 1e-3;  // seconds; above 0, up to a frame; least length without footfalls; rounding only
constexpr int kMaxRounds = 60;      // 53 (bits of a double) and more: halving alone ends by then

}  // namespace

GaitPhase::GaitPhase(std::vector<double> seconds, double first) : seconds_(std::move(seconds)), first_(first) {
  const auto increase = [](double a, double b) { return a >= b; };
  if (seconds_.size() < 2 || std::adjacent_find(seconds_.begin(), seconds_.end(), increase) != seconds_.end()) {
    throw Error(ErrorCode::kBadArgument, "a phase needs two moments that increase");
  }
  const auto span = [&](std::size_t k) { return seconds_[k + 1] - seconds_[k]; };
  slopes_.assign(seconds_.size(), 1 / span(0));
  slopes_.back() = 1 / span(seconds_.size() - 2);
  for (std::size_t k = 1; k + 1 < seconds_.size(); ++k) {
    const double before = span(k - 1), after = span(k);
    slopes_[k] = 3 * (before + after) / ((2 * after + before) * before + (after + 2 * before) * after);
  }
}

GaitPhase GaitPhase::ofWhole(double duration) {
  return GaitPhase({0, std::max(duration, kShortest)}, 0);
}

std::size_t GaitPhase::pieceOf(double seconds) const {
  const auto next = std::upper_bound(seconds_.begin() + 1, seconds_.end() - 1, seconds);
  return static_cast<std::size_t>(next - seconds_.begin()) - 1;
}

double GaitPhase::at(double seconds) const {
  const std::size_t k = pieceOf(seconds);
  const double phase = first_ + static_cast<double>(k);
  if (seconds <= seconds_.front()) return phase + slopes_.front() * (seconds - seconds_.front());
  if (seconds >= seconds_.back()) return phase + 1 + slopes_.back() * (seconds - seconds_.back());
  const double span = seconds_[k + 1] - seconds_[k], u = (seconds - seconds_[k]) / span;
  return phase + u * u * (3 - 2 * u) + span * u * (1 - u) * ((1 - u) * slopes_[k] - u * slopes_[k + 1]);
}

double GaitPhase::rate(double seconds) const {
  if (seconds <= seconds_.front()) return slopes_.front();
  if (seconds >= seconds_.back()) return slopes_.back();
  const std::size_t k = pieceOf(seconds);
  const double span = seconds_[k + 1] - seconds_[k], u = (seconds - seconds_[k]) / span;
  return 6 * u * (1 - u) / span + (1 - u) * (1 - 3 * u) * slopes_[k] - u * (2 - 3 * u) * slopes_[k + 1];
}

double GaitPhase::when(double phase) const {
  const double last = first_ + static_cast<double>(seconds_.size() - 1);
  if (phase <= first_) return seconds_.front() + (phase - first_) / slopes_.front();
  if (phase >= last) return seconds_.back() + (phase - last) / slopes_.back();
  const auto k = std::min(static_cast<std::size_t>(phase - first_), seconds_.size() - 2);
  double low = seconds_[k], high = seconds_[k + 1],
         estimate = low + (phase - first_ - static_cast<double>(k)) * (high - low);
  for (int i = 0; i < kMaxRounds; ++i) {
    const double off = at(estimate) - phase;
    (off > 0 ? high : low) = estimate;
    const double slope = rate(estimate), newton = estimate - off / slope;
    const double next = slope > 0 && newton > low && newton < high ? newton : (low + high) / 2;
    if (off == 0 || next == estimate) break;
    estimate = next;
  }
  return estimate;
}

}  // namespace limber
