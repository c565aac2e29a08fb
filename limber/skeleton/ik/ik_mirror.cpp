#include "limber/skeleton/ik/ik_mirror.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/skeleton/ik/ik_system.h"

namespace limber {

namespace {

constexpr double kMirrorRounding = 1e-9;  // of the size, and of a rotation's coefficients: what rounding leaves

bool same(const Quat& a, const Quat& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm()) <= kMirrorRounding;
}

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

// Rotations all over, to compare limits by.
std::array<Quat, 12> probes() {
  std::array<Quat, 12> rotations;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const double a = 1.7 * static_cast<double>(i);
    rotations[i] = Quat(1 + std::cos(1.3 * a), std::sin(a), std::cos(2.1 * a), std::sin(3.7 * a + 1)).normalized();
  }
  return rotations;
}

}  // namespace

IkMirror::IkMirror(const IkSystem& system) {
  for (const IkSystem::Effector& effector : system.effectors) size_ = std::max(size_, effector.reach);
  // The first may lie on the plane.
  for (std::size_t f = 0; f < system.effectors.size() && partners_.empty(); ++f) {
    const Vec3& first = system.positions[at(system.effectors[f].node)];
    for (std::size_t e = f + 1; e < system.effectors.size() && partners_.empty(); ++e) {
      const Vec3& other = system.positions[at(system.effectors[e].node)];
      if (!((other - first).norm() > kMirrorRounding * size_)) continue;
      const Vec3 normal = (other - first).normalized();
      const Quat plane(0, normal.x(), normal.y(), normal.z());
      if (!pairNodes(system, plane, 0.5 * (first + other)) || !pairEffectors(system) || !limitsMatch(system)) {
        partners_.clear();
      }
    }
  }
}

bool IkMirror::pairNodes(const IkSystem& system, const Quat& plane, const Vec3& point) {
  restPlane_ = plane_ = plane;
  point_ = point;
  const int count = system.nodeCount();
  partners_.assign(at(count), -1);
  turns_.assign(at(count), Quat::Identity());
  for (int n = 0; n < count; ++n) {
    const IkSystem::Node& node = system.nodes[at(n)];
    const int parent = node.parent < 0 ? -1 : partners_[at(node.parent)];
    const Vec3 image = mirrored(system.positions[at(n)]);
    for (int k = 0; k < count && partners_[at(n)] < 0; ++k) {
      const IkSystem::Node& other = system.nodes[at(k)];
      const bool alike = other.parent == parent && other.freedom == node.freedom && other.slides == node.slides &&
                         other.childCount == node.childCount && (other.limit == nullptr) == (node.limit == nullptr);
      if (alike && (system.positions[at(k)] - image).norm() <= kMirrorRounding * size_) partners_[at(n)] = k;
    }
    const int partner = partners_[at(n)];
    if (partner < 0) return false;
    turns_[at(n)] = (plane * system.globals[at(n)]).conjugate() * system.globals[at(partner)];
  }
  for (int n = 0; n < count; ++n) {
    if (partners_[at(partners_[at(n)])] != n) return false;
  }
  return true;
}

bool IkMirror::pairEffectors(const IkSystem& system) {
  const std::size_t count = system.effectors.size();
  effectorPartners_.assign(count, -1);
  for (std::size_t e = 0; e < count; ++e) {
    const IkSystem::Effector& effector = system.effectors[e];
    for (std::size_t k = 0; k < count && effectorPartners_[e] < 0; ++k) {
      const IkSystem::Effector& other = system.effectors[k];
      const bool alike = other.node == partners_[at(effector.node)] && other.level == effector.level &&
                         system.oriented(k) == system.oriented(e);
      if (alike) effectorPartners_[e] = static_cast<int>(k);
    }
    if (effectorPartners_[e] < 0) return false;
  }
  return true;
}

// Limits match where they bend an image as the image of what the other bends.
bool IkMirror::limitsMatch(const IkSystem& system) const {
  for (int n = 0; n < system.nodeCount(); ++n) {
    const JointLimit* limit = system.nodes[at(n)].limit;
    if (!limit) continue;
    const JointLimit& other = *system.nodes[at(partners_[at(n)])].limit;
    for (const Quat& probe : probes()) {
      const Quat bent = imageOf(system, n, nearestAllowed(*limit, probe));
      // The nearest allowed rotation may be one of several; allowed it must be.
      if (limitViolation(other, bent) > 1e-6) return false;
    }
    if (system.nodes[at(n)].slides && std::holds_alternative<PlaneJoint>(limit->motion)) return false;
  }
  return true;
}

bool IkMirror::referencesMatch(const IkSystem& system) const {
  if (!(system.options().referenceGain > 0)) return true;
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto k = at(partners_[at(n)]);
    if (!same(system.references[k], imageOf(system, n, system.references[at(n)]))) return false;
    if (!system.nodes[k].slides) continue;
    const Vec3 image = -(above(system, n).conjugate() * system.referenceOffsets[at(n)]);
    if ((system.referenceOffsets[k] - image).norm() > kMirrorRounding * size_) return false;
  }
  return true;
}

bool IkMirror::isImage(const IkSystem& system, int node) const {
  const auto n = at(node), k = at(partners_[n]);
  return same(system.globals[k], plane_ * system.globals[n] * turns_[n]) &&
         (system.positions[k] - mirrored(system.positions[n])).norm() <= kMirrorRounding * size_;
}

bool IkMirror::fits(const IkSystem& system) {
  if (partners_.empty()) return false;
  // The plane goes with the pose: a character that has turned round is as symmetric as before.
  const auto k = at(partners_[0]);
  plane_ = system.globals[k] * turns_[0].conjugate() * system.globals[0].conjugate();
  point_ = 0.5 * (system.positions[0] + system.positions[k]);
  const bool moved = !same(plane_, restPlane_);
  for (std::size_t e = 0; e < system.effectors.size(); ++e) {
    const IkSystem::Effector &a = system.effectors[e], &b = system.effectors[at(effectorPartners_[e])];
    if (a.weight != b.weight || (b.target - mirrored(a.target)).norm() > kMirrorRounding * size_) return false;
    if (a.pole.has_value() != b.pole.has_value()) return false;
    if (a.pole && (*b.pole - mirrored(*a.pole)).norm() > kMirrorRounding * size_) return false;
    if (a.angleScale > 0 && !same(b.orientation, plane_ * a.orientation * turns_[at(a.node)])) return false;
  }
  for (int n = 0; n < system.nodeCount(); ++n) {
    if (!isImage(system, n)) return false;
    // A base's limit is fixed in the world, from which the plane has moved away.
    if (moved && system.nodes[at(n)].parent < 0 && system.nodes[at(n)].limit) return false;
  }
  return referencesMatch(system);
}

// turn() of what the node hangs on: the parent node, or the frame that a base is given.
Quat IkMirror::above(const IkSystem& system, int node) const {
  const int parent = system.nodes[at(node)].parent;
  if (parent >= 0) return turns_[at(parent)];
  return (plane_ * system.parentRotation(node)).conjugate() * system.parentRotation(partners_[at(node)]);
}

Quat IkMirror::imageOf(const IkSystem& system, int node, const Quat& local) const {
  return above(system, node).conjugate() * local * turns_[at(node)];
}

void IkMirror::impose(IkSystem& system) const {
  for (int n = 0; n < system.nodeCount(); ++n) {
    const auto i = at(n), k = at(partners_[i]);
    if (k < i) continue;
    Quat image = imageOf(system, n, system.locals[i]);
    const Vec3 offset = -(above(system, n).conjugate() * system.offsets[i]);
    if (k > i) {
      system.locals[k] = image.normalized();
      if (system.nodes[k].slides) system.offsets[k] = offset;
      continue;
    }
    if (system.locals[i].dot(image) < 0) image.coeffs() = -image.coeffs();
    const double apart = (system.locals[i].coeffs() - image.coeffs()).norm();
    image.coeffs() += system.locals[i].coeffs();
    system.locals[i] = image.normalized();
    if (system.nodes[i].slides) system.offsets[i] = 0.5 * (system.offsets[i] + offset);
    if (apart > kMirrorRounding) system.limitNode(n);
  }
}

}  // namespace limber
