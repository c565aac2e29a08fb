// How far a motion is in its steps, at any moment: what two motions have in common that step at different speeds.
#pragma once

#include <vector>

namespace limber {

// A smooth monotone map from seconds to phase, which grows by one from knot to knot: a cubic through the knots whose
// slopes never overshoot (Fritsch, Butland 1984: A method for constructing local monotone piecewise cubic
// interpolants). Straight on before the first and after the last.
class GaitPhase {
 public:
  // At least two moments that increase, seconds; the first has the phase `first`.
  GaitPhase(std::vector<double> seconds, double first);
  // A motion without footfalls: 0 at its beginning, 1 at its end.
  static GaitPhase ofWhole(double duration);

  double at(double seconds) const;
  // Of it, for a second.
  double rate(double seconds) const;
  // When it is at that phase.
  double when(double phase) const;

 private:
  std::size_t pieceOf(double seconds) const;

  std::vector<double> seconds_, slopes_;
  double first_;
};

}  // namespace limber
