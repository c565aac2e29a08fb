// Joints of their own for what hangs on a body and swings with it: capes, scarves, ponytails, tails.
#pragma once

#include <string>
#include <vector>

#include "limber/actions/rig/accessories.h"
#include "limber/document/asset.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// Joints that hang one on the other and follow their carrier as springs do.
struct HangingChain {
  std::string name;
  std::vector<Index> joints;  // of the skeleton; the last one ends it and does not swing
  // As VRMC_springBone has them.
  double stiffness = 1;     // how soon it returns to rest
  double gravityPower = 0;  // how much it hangs down
};

// Adds a chain of three joints and an end to the skeleton for each accessory that hangs, from where it is nearest to
// the body to its far end, and binds its vertices along it.
//
// hung     from hangAccessories
// made     in world space; joints are added to it
// weights  of prepared.mesh
std::vector<HangingChain> addChains(const PreparedMesh& prepared, const Accessories& accessories,
                                    const std::vector<HungAccessory>& hung, Skeleton& made, SkinWeights& weights);

// Those that the skeleton has already: tails of two joints and more.
std::vector<HangingChain> chainsOfTails(const Skeleton& made);

// Writes VRMC_springBone 1.0 into the asset: one spring a chain, beside those that it has.
// jointNode  #J nodes of the skeleton's joints, as attachRig gives them
void writeSprings(Asset& asset, const std::vector<Index>& jointNode, const std::vector<HangingChain>& chains);

}  // namespace limber
