// What the labelling looks at: figures of each joint of a folded skeleton, under one guess of where up and front are.
// Internal to the module.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limber/character/anatomy/half_body.h"
#include "limber/character/anatomy/names/joint_words.h"

namespace limber {

// Of joint features the number below partFeatureCount(), and how much it applies, in (0, 1].
struct ActiveFeature {
  std::uint16_t number = 0;
  float value = 1;
};

// What does not depend on the guess of axes; made once for a skeleton.
class BodyMeasures {
 public:
  // `words`: of each joint's name (wordsOfJoints); empty: as if no joint had one. The body must outlive this.
  BodyMeasures(const HalfBody& body, std::span<const JointWords> words);

  const HalfBody& body() const { return *body_; }
  std::size_t size() const { return body_->joints.size(); }

  // Features of each half joint, one row each: rows()[i] to rows()[i + 1] of the list.
  struct Table {
    std::vector<ActiveFeature> list;
    std::vector<std::size_t> rows;
  };
  // Those that tell where up and front are, and all others.
  Table features(const Axes& axes) const;
  const Table& steadyFeatures() const { return steady_; }
  // Of the guess as a whole: how well it agrees with names for sides, and with the axes that most files have.
  std::vector<ActiveFeature> axesFeatures(const Axes& axes) const;

 private:
  const HalfBody* body_;
  std::vector<JointWords> words_;           // #half joints, of one of a pair
  std::vector<std::size_t> wordAbove_;      // nearest known word above, 0 none
  std::vector<double> bone_, reach_;        // to the parent; longest path below
  std::vector<double> whole_;               // all bones below
  std::vector<Index> count_;                // of half joints below, itself included
  std::vector<std::optional<Index>> next_;  // the child with the longest path
  std::vector<std::vector<Index>> children_;
  std::vector<std::optional<Index>> limbOf_;         // the first half joint of the limb it belongs to
  std::vector<double> along_;                        // from where the limb hangs
  std::vector<Index> rank_;                          // joints from there
  std::vector<Index> depth_, path_, tip_;            // joints above; joints of the longest path below, and its last
  std::vector<std::array<double, 3>> longestChild_;  // by HalfKind, with the bone to it
  std::vector<Index> main_;                          // half joints of the largest tree: the body
  std::vector<Index> rootOf_;
  std::vector<Index> limbs_, counted_;  // pairs' first half joints; of more than bodies have the longest
  std::vector<double> aside_;           // from the plane that all lies across
  double plane_ = 0;                    // along the fold's lateral axis
  double size_ = 1;                     // of the box around the body, along the lateral axis and across
  double total_ = 1;                    // length of all bones
  Table steady_;
  double sideVotes_ = 0;  // by names: positive where `lateral` points to the left
  double sideVoters_ = 0;
  bool named_ = false;  // whether names tell anything

  double isLong(Index limb) const;
  Vec3 directionOf(Index from, Index to) const;
  Vec3 boneAt(Index i) const;
  void measureSize();
  void tellSteady();
};

std::size_t partFeatureCount();
std::size_t axesFeatureCount();
// What a feature looks at, for reports: "height of the joint".
std::string_view partFeatureName(std::size_t number);

}  // namespace limber
