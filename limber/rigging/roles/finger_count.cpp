#include "limber/rigging/roles/finger_count.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace limber {

namespace {

// In lengths of the hand.
constexpr double kFirst = 0.3, kLast = 1.7, kStep = 0.07;         // planes, from the wrist
constexpr double kAside = 0.9;                                    // that parts of the hand lie beside its axis
constexpr double kHandOfForearm = 0.6;                            // length of a hand, of that of the forearm, about
constexpr double kThinnestFinger = 0.02, kThickestFinger = 0.16;  // half widths of fingers

using Edge = std::pair<Index, Index>;

// Where a plane cuts triangles, by the edges that it cuts: those of one triangle belong together.
class Cut {
 public:
  void add(const Edge& edge, const Vec3& position, const Edge& other, const Vec3& otherPosition) {
    unite(idOf(edge, position), idOf(other, otherPosition));
  }

  struct Part {
    Vec3 middle = Vec3::Zero();
    double halfWidth = 0;
  };

  // What hangs together; pieces of a model that lie in one another count once.
  std::vector<Part> parts() const {
    std::map<std::size_t, std::vector<Vec3>> together;
    for (std::size_t i = 0; i < positions_.size(); ++i) together[root(i)].push_back(positions_[i]);
    std::vector<Part> parts;
    for (const auto& [first, positions] : together) {
      Part part;
      for (const Vec3& position : positions) part.middle += position / static_cast<double>(positions.size());
      for (const Vec3& position : positions) part.halfWidth = std::max(part.halfWidth, (position - part.middle).norm());
      parts.push_back(part);
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.halfWidth > b.halfWidth; });
    std::vector<Part> apart;
    for (const Part& part : parts) {
      const auto holds = [&](const Part& wider) { return (wider.middle - part.middle).norm() < wider.halfWidth; };
      if (std::none_of(apart.begin(), apart.end(), holds)) apart.push_back(part);
    }
    return apart;
  }

 private:
  std::size_t idOf(const Edge& edge, const Vec3& position) {
    const auto [entry, isNew] = ids_.try_emplace(edge, positions_.size());
    if (isNew) {
      positions_.push_back(position);
      above_.push_back(entry->second);
    }
    return entry->second;
  }
  std::size_t root(std::size_t i) const {
    while (above_[i] != i) i = above_[i];
    return i;
  }
  void unite(std::size_t a, std::size_t b) { above_[root(a)] = root(b); }

  std::map<Edge, std::size_t> ids_;
  std::vector<Vec3> positions_;
  std::vector<std::size_t> above_;
};

}  // namespace

std::size_t countFingers(const TriMesh& mesh, const Vec3& hand, const Vec3& tip) {
  const double length = (tip - hand).norm();
  if (!(length > 0)) return 0;
  const Vec3 axis = (tip - hand) / length;
  const auto along = [&](Index v) { return (mesh.position(v) - hand).dot(axis) / length; };
  std::vector<Triangle> near;
  for (const Triangle& t : mesh.triangles) {
    const auto [low, high] = std::minmax({along(t[0]), along(t[1]), along(t[2])});
    if (high > kFirst && low < kLast) near.push_back(t);
  }
  std::size_t most = 0;
  for (double at = kFirst; at < kLast; at += kStep) {
    Cut cut;
    for (const Triangle& t : near) {
      std::vector<std::pair<Edge, Vec3>> crossed;
      for (int i = 0; i < 3; ++i) {
        const Index a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
        const double first = along(a) - at, second = along(b) - at;
        if ((first > 0) == (second > 0)) continue;
        const Vec3 position = mesh.position(a) + first / (first - second) * (mesh.position(b) - mesh.position(a));
        crossed.emplace_back(Edge(a, b), position);
      }
      if (crossed.size() == 2) cut.add(crossed[0].first, crossed[0].second, crossed[1].first, crossed[1].second);
    }
    const auto isFinger = [&](const Cut::Part& part) {
      const double aside = (part.middle - hand - at * length * axis).norm();
      return aside < kAside * length && part.halfWidth > kThinnestFinger * length &&
             part.halfWidth < kThickestFinger * length;
    };
    const std::vector<Cut::Part> parts = cut.parts();
    most = std::max(most, static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), isFinger)));
  }
  return most;
}

std::size_t countFingers(const TriMesh& mesh, const RoleReading& reading) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const char* side : {".L", ".R"}) {
    const std::string wristRole = std::string("fore_end") + side, elbowRole = std::string("fore_middle") + side;
    if (!reading.has(wristRole) || !reading.has(elbowRole)) return 0;
    const Vec3 wrist = reading.position(atRole(wristRole)), elbow = reading.position(atRole(elbowRole));
    const AnatomicalFrame& frame = reading.frame();
    const Vec3 tip = wrist + kHandOfForearm * (wrist - elbow);
    fewest = std::min(fewest, countFingers(mesh, frame.fromBody(wrist), frame.fromBody(tip)));
  }
  return fewest;
}

}  // namespace limber
