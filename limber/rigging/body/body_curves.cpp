#include "limber/rigging/body/body_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/text/numbers.h"
#include "limber/rigging/body/inside_graph.h"

namespace limber {

namespace {

constexpr double kLevel = 2;         // grid spacings from one level set to the next
constexpr double kMinBranch = 0.7;   // of the radius where it hangs: shorter ones are bumps
constexpr double kMinLength = 0.04;  // longest sides
constexpr double kOnPlane = 1.5;     // grid spacings off the plane between left and right
constexpr std::size_t kNoPiece = std::numeric_limits<std::size_t>::max();

// One piece of a level set.
struct Piece {
  BodyCurve::Point point;
  Mat3 spread = Mat3::Zero();  // covariance of its nodes' cells
  double distance = 0;
  std::size_t nodes = 0;
  bool isCentral = false;  // it lies between left and right
  std::optional<std::size_t> parent;
  std::vector<std::size_t> children;
  double farthest = 0;   // path length to the farthest end below
  double trunkEnd = -1;  // the same over central pieces
};

class CurveFinder {
 public:
  CurveFinder(const BodyVolume& body, const AnatomicalFrame& frame)
      : distance_(*body.distance), frame_(frame), graph_(distance_) {
    keepLeftHalf();
    inside_ = graph_.insideNodes();
  }

  std::vector<BodyCurve> find() {
    if (const std::optional<std::size_t> source = sourceNode()) {
      findPieces(*source);
      findEnds();
      prune();
      return curves();
    }
    return {};
  }

 private:
  // With the mesh's unit, so that what is low counts like what is high.
  Vec3 positionOf(std::size_t node) const { return frame_.height * frame_.toBody(distance_.position(node)); }
  double across() const { return kOnPlane * distance_.spacing(); }

  void keepLeftHalf() {
    std::vector<bool> blocked(distance_.nodeCount());
    for (std::size_t node = 0; node < blocked.size(); ++node) {
      const double x = positionOf(node).x();
      blocked[node] = x < -0.5 * distance_.spacing() ||
                      (x > across() && distance_.value(node) < 0 &&
                       distance_.at(frame_.mirrored(distance_.position(node))) >= distance_.spacing());
    }
    graph_.block(std::move(blocked));
  }

  // Between left and right the one farthest from the deepest one.
  std::optional<std::size_t> sourceNode() {
    if (inside_.empty()) return {};
    const std::size_t deepest = *std::max_element(inside_.begin(), inside_.end(), [&](std::size_t a, std::size_t b) {
      return graph_.depth(a) < graph_.depth(b);
    });
    graph_.spreadToAll(deepest, inside_, distances_, from_);
    std::optional<std::size_t> source;
    for (const std::size_t node : inside_) {
      if (positionOf(node).x() > across() || !std::isfinite(distances_[node])) continue;
      if (!source || distances_[node] > distances_[*source]) source = node;
    }
    return source;
  }

  std::size_t levelOf(std::size_t node) const {
    return static_cast<std::size_t>(distances_[node] / static_cast<float>(kLevel * distance_.spacing()));
  }

  void findPieces(std::size_t source) {
    distances_.assign(distance_.nodeCount(), std::numeric_limits<float>::infinity());
    from_.assign(distance_.nodeCount(), source);
    graph_.spread({source}, distances_, from_);
    std::erase_if(inside_, [&](std::size_t node) { return !std::isfinite(distances_[node]); });
    std::stable_sort(inside_.begin(), inside_.end(),
                     [&](std::size_t a, std::size_t b) { return distances_[a] < distances_[b]; });
    pieceOf_.assign(distance_.nodeCount(), kNoPiece);
    for (const std::size_t node : inside_) {
      if (pieceOf_[node] == kNoPiece) addPiece(node);
    }
  }

  void addPiece(std::size_t first) {
    const std::size_t own = pieces_.size();
    Piece piece;
    piece.distance = distances_[first];
    for (std::size_t node = first; from_[node] != node && !piece.parent;) {
      node = from_[node];
      if (graph_.inside(node)) piece.parent = pieceOf_[node];
    }
    std::vector<std::size_t> waiting = {first};
    pieceOf_[first] = own;
    while (!waiting.empty()) {
      const std::size_t node = waiting.back();
      waiting.pop_back();
      const Vec3 position = positionOf(node);
      piece.point.position += position;
      piece.spread += position * position.transpose();
      piece.point.radius = std::max(piece.point.radius, graph_.depth(node));
      piece.isCentral = piece.isCentral || position.x() <= across();
      ++piece.nodes;
      for (const std::ptrdiff_t step : graph_.steps()) {
        const std::size_t next = node + step;
        if (pieceOf_[next] != kNoPiece || !graph_.inside(next) || !std::isfinite(distances_[next])) continue;
        if (levelOf(next) != levelOf(first)) continue;
        pieceOf_[next] = own;
        waiting.push_back(next);
      }
    }
    const double spacing = distance_.spacing();
    piece.point.position /= static_cast<double>(piece.nodes);
    piece.spread /= static_cast<double>(piece.nodes);
    if (piece.isCentral) {
      // With the other half: about the plane.
      piece.point.position.x() = 0;
      piece.spread.row(0).tail<2>().setZero();
      piece.spread.col(0).tail<2>().setZero();
    }
    piece.spread -= piece.point.position * piece.point.position.transpose();
    piece.spread += spacing * spacing / 12 * Mat3::Identity();
    piece.point.area = static_cast<double>(piece.nodes) * spacing * spacing / kLevel * (piece.isCentral ? 2 : 1);
    if (piece.parent) pieces_[*piece.parent].children.push_back(own);
    pieces_.push_back(std::move(piece));
  }

  // Parents come before their children.
  void findEnds() {
    for (std::size_t p = pieces_.size(); p-- > 0;) {
      Piece& piece = pieces_[p];
      piece.farthest = piece.distance;
      if (piece.isCentral) piece.trunkEnd = piece.distance;
      for (const std::size_t child : piece.children) {
        piece.farthest = std::max(piece.farthest, pieces_[child].farthest);
        if (piece.isCentral) piece.trunkEnd = std::max(piece.trunkEnd, pieces_[child].trunkEnd);
      }
    }
  }

  // Whatever ends soon beside what goes on.
  void prune() {
    for (Piece& piece : pieces_) {
      std::erase_if(piece.children, [&](std::size_t child) {
        const bool isTrunk = pieces_[child].trunkEnd >= 0 && pieces_[child].trunkEnd == piece.trunkEnd;
        const double length = pieces_[child].farthest - piece.distance;
        return !isTrunk && length < piece.farthest - piece.distance &&
               length < std::max(kMinLength, kMinBranch * piece.point.radius);
      });
    }
  }

  std::vector<BodyCurve> curves() const {
    struct Start {
      std::size_t piece;
      std::optional<std::size_t> carrier;
      std::size_t at;
    };
    std::vector<BodyCurve> curves;
    std::vector<Start> starts = {{0, {}, 0}};
    for (std::size_t s = 0; s < starts.size(); ++s) {
      const Start start = starts[s];
      const bool isTrunk = !start.carrier;
      const auto reach = [&](std::size_t p) { return isTrunk ? pieces_[p].trunkEnd : pieces_[p].farthest; };
      BodyCurve curve;
      curve.carrier = start.carrier;
      curve.at = start.at;
      const std::size_t own = curves.size();
      if (start.carrier) add(curve, curves[*start.carrier].points[start.at]);
      for (std::size_t p = start.piece;;) {
        add(curve, pieces_[p].point);
        if (curve.points.size() > 1) {
          const Vec3 distance = curve.points.back().position - curve.points[curve.points.size() - 2].position;
          BodyCurve::Point& point = curve.points.back();
          point.flatness = flatnessAcross(pieces_[p].spread, distance);
          point.radius = std::sqrt(point.area / (kPi * point.flatness));
        }
        const std::vector<std::size_t>& children = pieces_[p].children;
        const auto next = std::max_element(children.begin(), children.end(),
                                           [&](std::size_t a, std::size_t b) { return reach(a) < reach(b); });
        const bool ends = next == children.end() || reach(*next) < 0;
        for (const std::size_t child : children) {
          if (ends || child != *next) starts.push_back({child, own, curve.points.size() - 1});
        }
        if (ends) {
          curve.isPaired = !pieces_[p].isCentral;
          break;
        }
        p = *next;
      }
      curves.push_back(std::move(curve));
    }
    return curves;
  }

  // The ratio of the roots of the two variances of `spread` across `distance`.
  static double flatnessAcross(const Mat3& spread, const Vec3& distance) {
    if (!(distance.norm() > 0)) return 1;
    const Vec3 side = distance.unitOrthogonal(), other = distance.normalized().cross(side);
    const double a = side.dot(spread * side), b = other.dot(spread * other), mixed = side.dot(spread * other);
    const double middle = 0.5 * (a + b), half = 0.5 * (a - b), apart = std::sqrt(half * half + mixed * mixed);
    return std::sqrt((middle + apart) / std::max(middle - apart, 1e-12));
  }

  static void add(BodyCurve& curve, const BodyCurve::Point& point) {
    if (!curve.points.empty()) curve.length += (point.position - curve.points.back().position).norm();
    curve.points.push_back(point);
  }

  const SignedDistance& distance_;
  const AnatomicalFrame& frame_;
  InsideGraph graph_;
  std::vector<std::size_t> inside_;
  std::vector<float> distances_;
  std::vector<std::size_t> from_;
  std::vector<std::size_t> pieceOf_;
  std::vector<Piece> pieces_;
};

}  // namespace

double BodyCurve::flatness() const {
  std::vector<double> outer;
  for (std::size_t p = (points.size() + 2) / 3; p < points.size(); ++p) {
    // What lies between left and right is both sides' in one.
    if (!isPaired || points[p].position.x() != 0) outer.push_back(points[p].flatness);
  }
  if (outer.empty()) return 1;
  const auto middle = outer.begin() + static_cast<std::ptrdiff_t>(outer.size() / 2);
  std::nth_element(outer.begin(), middle, outer.end());
  return *middle;
}

Vec3 BodyCurve::root() const {
  const Vec3 &inside = points[0].position, &outside = points[1].position;
  return {outside.x(), 0.5 * (inside.y() + outside.y()), 0.5 * (inside.z() + outside.z())};
}

double BodyCurve::meanRadius() const {
  double sum = 0;
  for (std::size_t p = 1; p < points.size(); ++p) sum += points[p].radius;
  return sum / static_cast<double>(std::max<std::size_t>(points.size(), 2) - 1);
}

std::vector<BodyCurve> bodyCurves(const BodyVolume& body, const AnatomicalFrame& frame) {
  return CurveFinder(body, frame).find();
}

}  // namespace limber
