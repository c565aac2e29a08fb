// A pair of legs followed from the ground up to where they part.
#pragma once

#include <array>
#include <vector>

#include "limber/rigging/body/body_section.h"

namespace limber {

// Joints of a template: where a leg begins, bends, and from where on it is looked at.
struct LegChain {
  Index hip = 0, knee = 0, ankle = 0;
};

class LegFinder {
 public:
  // positions  of the template's joints, body space; all arguments must outlive the finder
  LegFinder(const BodyVolume& body, const AnatomicalFrame& frame, const std::vector<Vec3>& positions,
            const LegChain& left, const LegChain& right)
      : body_(body), frame_(frame), positions_(positions), legs_{left, right} {}

  // Cuts both legs at rising heights until they have grown together. False where they do not, or so low that they are
  // no legs.
  bool findParting();

  double parting() const { return parting_; }
  bool known() const { return sections_[0].size() > 3; }  // whether the legs were seen at all

  // Of the leg just below where it parts from the other one.
  double halfWidth(int side) const;

  // Of the leg from front to back, near a height below the parting.
  double halfDepth(int side, double y) const;

  // The middle of the leg at a height; above where it parts as just below.
  Vec3 middle(int side, double y) const;

 private:
  Vec3 seed(int side, double y) const;

  const BodyVolume& body_;
  const AnatomicalFrame& frame_;
  const std::vector<Vec3>& positions_;
  std::array<LegChain, 2> legs_;
  std::array<std::vector<BodySection>, 2> sections_;  // upwards
  double parting_ = 0;
};

}  // namespace limber
