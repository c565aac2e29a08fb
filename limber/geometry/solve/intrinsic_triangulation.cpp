#include "limber/geometry/solve/intrinsic_triangulation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {

namespace {

// Twice a negative weight smaller than this is rounding, not a reason to flip.
constexpr double kDelaunayTolerance = 1e-9;

// Four times the area of the triangle with sides a, b, c (Kahan's stable form of Heron), never quite zero.
double fourAreas(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return std::sqrt(std::max(product, 1e-20 * a * a * a * a));
}

class DelaunayFlipper {
 public:
  explicit DelaunayFlipper(IntrinsicTriangulation& t) : t_(t), waiting_(t.sideCount(), 0) {}

  Index run() {
    const Index sideCount = t_.sideCount();
    t_.cotangent.resize(sideCount);
    for (Index h = 0; h < sideCount; h += 3) updateCotangents(h);
    for (Index h = 0; h < sideCount; ++h) {
      if (h < t_.twin[h] && !isDelaunay(h)) push(h);
    }
    // Flipping ends by itself (Bobenko, Springborn 2007); the bound is there for rounding alone.
    const std::size_t maxFlips = 100 * std::size_t{sideCount} + 1000;
    std::size_t flips = 0;
    while (!stack_.empty() && flips < maxFlips) {
      const Index h = stack_.back();
      stack_.pop_back();
      waiting_[h] = 0;
      if (isDelaunay(h) || h / 3 == t_.twin[h] / 3) continue;
      flip(h);
      ++flips;
    }
    return static_cast<Index>(std::min<std::size_t>(flips, kNoIndex));
  }

 private:
  bool isDelaunay(Index h) const { return t_.cotangent[h] + t_.cotangent[t_.twin[h]] >= -kDelaunayTolerance; }

  void push(Index h) {
    h = std::min(h, t_.twin[h]);
    if (waiting_[h]) return;
    waiting_[h] = 1;
    stack_.push_back(h);
  }

  // `h` is a face's first side.
  void updateCotangents(Index h) {
    const double a = t_.length[h], b = t_.length[h + 1], c = t_.length[h + 2];
    const double scale = 1 / fourAreas(a, b, c);
    t_.cotangent[h] = (b * b + c * c - a * a) * scale;
    t_.cotangent[h + 1] = (c * c + a * a - b * b) * scale;
    t_.cotangent[h + 2] = (a * a + b * b - c * c) * scale;
  }

  // The other diagonal of the two triangles unfolded into the plane: `la` and `lb` are the sides from the shared edge's
  // start and end to one apex, `ra` and `rb` to the other.
  static double otherDiagonal(double edge, double la, double lb, double ra, double rb) {
    const double leftX = (la * la + edge * edge - lb * lb) / (2 * edge);
    const double rightX = (ra * ra + edge * edge - rb * rb) / (2 * edge);
    const double height = 0.5 * (fourAreas(edge, la, lb) + fourAreas(edge, ra, rb)) / edge;
    return std::hypot(leftX - rightX, height);
  }

  // Faces abc (side h: a to b, h1, h2) and bad (side t: b to a, t1, t2) become dca and cdb, in the same slots: h runs
  // from d to c, t from c to d, and each other side moves on by one slot round the quadrilateral.
  void flip(Index h) {
    const Index t = t_.twin[h];
    const Index h1 = nextSide(h), h2 = nextSide(h1), t1 = nextSide(t), t2 = nextSide(t1);
    const Index c = t_.from[h2], d = t_.from[t2];
    const double diagonal = otherDiagonal(t_.length[h], t_.length[h2], t_.length[h1], t_.length[t1], t_.length[t2]);

    const Index outer[4] = {h2, t1, t2, h1};  // where the sides are
    const Index index[4] = {h1, h2, t1, t2};  // where they go
    Index from[4], twin[4];
    double length[4];
    for (int i = 0; i < 4; ++i) {
      from[i] = t_.from[outer[i]];
      twin[i] = t_.twin[outer[i]];
      length[i] = t_.length[outer[i]];
      for (int k = 0; k < 4; ++k) {
        if (t_.twin[outer[i]] == outer[k]) twin[i] = index[k];
      }
    }
    for (int i = 0; i < 4; ++i) {
      t_.from[index[i]] = from[i];
      t_.length[index[i]] = length[i];
      t_.twin[index[i]] = twin[i];
      t_.twin[twin[i]] = index[i];
    }
    t_.from[h] = d;
    t_.from[t] = c;
    t_.length[h] = t_.length[t] = diagonal;
    updateCotangents(h - h % 3);
    updateCotangents(t - t % 3);
    for (const Index side : index) {
      if (!isDelaunay(side)) push(side);
    }
  }

  IntrinsicTriangulation& t_;
  std::vector<char> waiting_;  // #H: whether that index is on the stack, whichever side has it by now
  std::vector<Index> stack_;
};

}  // namespace

Index delaunayFlips(IntrinsicTriangulation& triangulation) {
  return DelaunayFlipper(triangulation).run();
}

}  // namespace limber
