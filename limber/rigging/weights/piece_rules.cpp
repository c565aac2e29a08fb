#include "limber/rigging/weights/piece_rules.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

constexpr double kPartsFraction = 0.6;   // mean largest weight from which a model is one of parts
constexpr double kPiecesPerJoint = 0.5;  // of which it then has at least so many
constexpr double kSightOfParts = 0.05;   // vertices of a piece that must see a bone
constexpr double kSightOfSkin = 0.25;
constexpr double kRigidPart = 0.62;  // largest weight of a piece from which it is rigid
constexpr double kRigidTrinket = 0.8;
constexpr double kTrinketArea = 0.1;  // of the model
constexpr double kBallCenter = 0.12;  // diagonals from the middle of a piece to the joint it is the ball of
constexpr double kBallAspect = 2;     // longest side to shortest
constexpr double kBallFraction = 0.2;

}  // namespace

PieceRules::PieceRules(const TriMesh& mesh, std::span<const Bone> bones, const std::vector<Index>& piece,
                       Index pieceCount, const std::vector<double>& pull)
    : bones_(bones),
      piece_(piece),
      vertices_(numbersByGroup(piece, pieceCount)),
      seeing_(pieceCount, 0),
      area_(pieceCount, 0),
      box_(pieceCount) {
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    seeing_[piece[v]] += pull[v] > 0;
    box_[piece[v]].add(mesh.position(v));
  }
  for (const Triangle& t : mesh.triangles) {
    area_[piece[t[0]]] += triangleArea(mesh, t);
  }
  totalArea_ = std::accumulate(area_.begin(), area_.end(), 0.0);
  std::vector<bool> hasBone;
  for (const Bone& bone : bones) {
    if (bone.joint >= hasBone.size()) hasBone.resize(bone.joint + std::size_t{1}, false);
    hasBone[bone.joint] = true;
  }
  jointCount_ = static_cast<Index>(hasBone.size());
  boneJoints_ = static_cast<Index>(std::count(hasBone.begin(), hasBone.end(), true));
}

double PieceRules::sight(Index piece) const {
  return static_cast<double>(seeing_[piece]) / static_cast<double>(vertices_.of(piece).size());
}

// Piece by piece, the part of its vertices that each joint holds.
void PieceRules::visitWeights(const SkinWeights& weights, const WeightVisitor& visit) const {
  std::vector<double> fractions(jointCount_, 0);
  for (Index piece = 0; piece < vertices_.count(); ++piece) {
    const std::span<const Index> vertices = vertices_.of(piece);
    std::fill(fractions.begin(), fractions.end(), 0.0);
    for (const Index v : vertices) {
      for (Index slot = 0; slot < weights.slots; ++slot)
        fractions[weights.jointsOf(v)[slot]] += weights.weightsOf(v)[slot];
    }
    for (double& fraction : fractions) fraction /= static_cast<double>(vertices.size());
    visit(piece, fractions);
  }
}

PieceRules::Top PieceRules::topOf(const std::vector<double>& fractions) {
  const auto most = std::max_element(fractions.begin(), fractions.end());
  return {static_cast<Index>(most - fractions.begin()), *most};
}

void PieceRules::classify(const SkinWeights& weights) {
  double sum = 0, area = 0;
  visitWeights(weights, [&](Index piece, const std::vector<double>& fractions) {
    if (sight(piece) < kSightOfParts) return;
    sum += area_[piece] * topOf(fractions).fraction;
    area += area_[piece];
  });
  madeOfParts_ = static_cast<double>(area_.size()) >= std::max(2.0, kPiecesPerJoint * boneJoints_) &&
                 sum >= kPartsFraction * area && area > 0;
}

void PieceRules::dropHardlySeen(InfluenceTable& weights) const {
  const double least = madeOfParts_ ? kSightOfParts : kSightOfSkin;
  // Loose vertices are no surface that the others could take weights from.
  const bool allHidden =
      std::none_of(piece_.begin(), piece_.end(), [&](Index p) { return area_[p] > 0 && sight(p) >= least; });
  if (allHidden) return;
  for (std::size_t v = 0; v < weights.vertexCount(); ++v) {
    if (sight(piece_[v]) < least) weights.clear(v);
  }
}

bool PieceRules::small(Index piece) const {
  return area_[piece] <= kTrinketArea * totalArea_;
}

// The joint whose bone starts in the middle of a piece that is about as wide as long.
std::optional<Index> PieceRules::jointAtMiddle(Index piece, const std::vector<double>& fractions) const {
  const Box& box = box_[piece];
  if (box.longestSide() > kBallAspect * box.size().minCoeff()) return std::nullopt;
  std::optional<Index> result;
  double nearest = kBallCenter * box.diagonal();
  for (const Bone& bone : bones_) {
    const double distance = (bone.a - box.center()).norm();
    if (distance >= nearest || fractions[bone.joint] < kBallFraction) continue;
    nearest = distance;
    result = bone.joint;
  }
  return result;
}

void PieceRules::bindRigid(SkinWeights& weights, Warnings& warnings) const {
  PieceBinding binding(area_.size());
  visitWeights(weights, [&](Index piece, const std::vector<double>& fractions) {
    const Top top = topOf(fractions);
    if (madeOfParts_) {
      binding[piece] = top.fraction >= kRigidPart ? top.joint : jointAtMiddle(piece, fractions);
    } else if (small(piece) && top.fraction >= kRigidTrinket) {
      binding[piece] = top.joint;
    }
  });
  bindPieces(binding, piece_, weights, warnings);
}

void bindPieces(const PieceBinding& binding, std::span<const Index> piece, SkinWeights& weights, Warnings& warnings) {
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    if (binding[piece[v]]) bindTo(*binding[piece[v]], v, weights);
  }
  const auto bound = std::count_if(binding.begin(), binding.end(), [](const auto& joint) { return joint.has_value(); });
  if (bound > 0) {
    warnings.add("rigid-pieces", "pieces follow one joint each, as hard parts", {}, static_cast<std::size_t>(bound));
  }
}

}  // namespace limber
