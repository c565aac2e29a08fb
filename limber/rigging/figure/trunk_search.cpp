#include "limber/rigging/figure/trunk_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limber/core/text/numbers.h"
#include "limber/rigging/figure/best_apart.h"
#include "limber/rigging/figure/steady.h"

namespace limber {

namespace {

// Of heads.
constexpr double kStatureOverRadius = 1 / 0.058;        // of the sphere inside a head
constexpr double kMinStature = 0.5, kMaxStature = 2.4;  // heights of the body
constexpr double kLowestHead = 0.3;                     // heights
constexpr double kBallOverSphere = 1.07;                // a head is longer than the sphere in it is wide
constexpr double kLessRound = 0.15;                     // than the roundest
constexpr std::size_t kMaxHeads = 6;
constexpr std::array<double, 3> kHeadFractions = {0.064, 0.057, 0.05};  // radius of the sphere by stature

// Of trunks.
constexpr int kTrunkDirections = 240, kTurns = 12;
constexpr std::size_t kMaxNecks = 30, kMaxPelvises = 4;
constexpr double kNeckUp = 0.3;                  // most that a neck's base lies above the head, as a sine
constexpr double kNeckDeep = 0.04;               // statures, of a neck's base
constexpr double kMinNod = 0.45, kMinBow = 0.5;  // least cosine between neck and chest, chest and pelvis
constexpr double kInside = 0.02;                 // statures, of waist and hips
constexpr double kAlikeWaist = 0.04, kAlikeWaistTurn = 0.94;
constexpr double kAlikeHips = 0.05, kAlikePelvis = 0.9;
constexpr std::array<double, 5> kTwists = {-0.7, -0.35, 0, 0.35, 0.7};

struct Rated {
  Figure figure;
  double match;
};

double matchOf(const Rated& rated) {
  return rated.match;
}

// Axes with `up` as the second column, turned about it.
Mat3 axesAbout(const Vec3& up, const SteadyAngle& angle) {
  const Vec3 x = up.unitOrthogonal(), z = x.cross(up);
  Mat3 axes;
  axes.col(0) = (angle.cos * x + angle.sin * z).normalized();
  axes.col(1) = up;
  axes.col(2) = axes.col(0).cross(up);
  return axes;
}

const std::vector<Vec3>& allDirections() {
  static const std::vector<Vec3> kDirections = evenDirections(kTrunkDirections);
  return kDirections;
}

class TrunkSearch {
 public:
  TrunkSearch(const BodyVolume& body, const FigureMatch& match, const Vec3& up) : body_(body), match_(match), up_(up) {}

  std::vector<Rated> chests(const Figure& start, std::size_t most) const {
    std::vector<Rated> chests;
    for (const Rated& neck : necks(start)) {
      Figure figure = neck.figure;
      for (const Vec3& down : allDirections()) {
        const double nod = down.dot(figure.neck);
        if (nod < kMinNod) continue;
        figure.chest.col(1) = -down;
        if (!isInside(figure, figure.waist())) continue;
        for (int turn = 0; turn < kTurns; ++turn) {
          figure.chest = axesAbout(-down, SteadyAngle(kPi * turn / kTurns));
          chests.push_back({figure, match_.chest(figure) - nodCost(figure)});
        }
      }
    }
    return bestApart(std::move(chests), most, matchOf, [](const Rated& a, const Rated& b) {
      return (a.figure.waist() - b.figure.waist()).norm() < kAlikeWaist * a.figure.stature &&
             std::abs(a.figure.chest.col(0).dot(b.figure.chest.col(0))) > kAlikeWaistTurn;
    });
  }

  std::vector<Rated> pelvises(const Figure& start) const {
    std::vector<Rated> pelvises;
    Figure figure = start;
    for (const Vec3& down : allDirections()) {
      if (-down.dot(start.chest.col(1)) < kMinBow) continue;
      const Vec3 left = (start.chest.col(0) + start.chest.col(0).dot(down) * -down).normalized();
      Mat3 axes;
      axes << left, -down, left.cross(-down);
      figure.pelvis = axes;
      if (!isInside(figure, figure.hips())) continue;
      for (const double twist : kTwists) {
        figure.pelvis = axes * turnBy(twist * Vec3::UnitY());
        pelvises.push_back({figure, match_.trunk(figure)});
      }
    }
    return bestApart(std::move(pelvises), kMaxPelvises, matchOf, [](const Rated& a, const Rated& b) {
      return (a.figure.hips() - b.figure.hips()).norm() < kAlikeHips * a.figure.stature &&
             a.figure.pelvis.col(0).dot(b.figure.pelvis.col(0)) > kAlikePelvis;
    });
  }

 private:
  bool isInside(const Figure& figure, const Vec3& position) const {
    return body_.distance->at(position) < -kInside * figure.stature;
  }

  std::vector<Rated> necks(const Figure& start) const {
    std::vector<Rated> necks;
    Figure figure = start;
    for (const Vec3& direction : allDirections()) {
      if (direction.dot(up_) > kNeckUp) continue;
      figure.neck = direction;
      const double deep = -body_.distance->at(figure.neckBase()) / (kNeckDeep * figure.stature);
      if (deep > 0.3) necks.push_back({figure, match_.neck(figure) + 0.3 * std::min(deep, 1.2)});
    }
    return bestOf(std::move(necks), kMaxNecks, matchOf);
  }

  const BodyVolume& body_;
  const FigureMatch& match_;
  Vec3 up_;
};

}  // namespace

std::vector<HeadBall> findHeads(const BodyVolume& body, const FigureMatch& match, const Vec3& up) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const MedialSphere& sphere : body.spheres) {
    low = std::min(low, sphere.center.dot(up) - sphere.radius);
    high = std::max(high, sphere.center.dot(up) + sphere.radius);
  }
  const double height = high - low;
  std::vector<HeadBall> balls;
  for (const MedialSphere& sphere : body.spheres) {
    const double stature = kStatureOverRadius * sphere.radius;
    if (stature < kMinStature * height || stature > kMaxStature * height) continue;
    if (sphere.center.dot(up) < low + kLowestHead * height) continue;
    const double radius = kBallOverSphere * sphere.radius;
    balls.push_back({sphere.center, radius, match.head(sphere.center, radius)});
  }
  std::vector<HeadBall> heads = bestApart(
      std::move(balls), kMaxHeads, [](const HeadBall& ball) { return ball.match; },
      [](const HeadBall& kept, const HeadBall& ball) {
        return (kept.middle - ball.middle).norm() < 0.5 * kept.radius;
      });
  std::erase_if(heads, [most = heads.empty() ? 0 : heads.front().match](const HeadBall& head) {
    return head.match < most - kLessRound;
  });
  return heads;
}

std::vector<double> staturesFor(const HeadBall& head) {
  std::vector<double> statures;
  for (const double fraction : kHeadFractions) statures.push_back(head.radius / kBallOverSphere / fraction);
  return statures;
}

std::vector<MatchedFigure> findTrunks(const BodyVolume& body, const FigureMatch& match, const HeadBall& head,
                                      double stature, const Vec3& up, std::size_t most) {
  Figure start;
  start.stature = stature;
  start.head = head.middle;
  start.headRadius = head.radius;
  const TrunkSearch search(body, match, up);
  std::vector<MatchedFigure> trunks;
  for (const Rated& chest : search.chests(start, most)) {
    for (const Rated& pelvis : search.pelvises(chest.figure)) {
      MatchedFigure trunk;
      trunk.figure = pelvis.figure;
      trunk.trunk = trunk.total = pelvis.match;
      trunks.push_back(trunk);
      for (Mat3* axes : {&trunk.figure.chest, &trunk.figure.pelvis}) {
        axes->col(0) *= -1;
        axes->col(2) *= -1;
      }
      trunks.push_back(trunk);
    }
  }
  return trunks;
}

}  // namespace limber
