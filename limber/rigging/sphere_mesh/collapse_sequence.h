// Merging spheres two by two, cheapest first, down to one, and the record of it.
#pragma once

#include <cstdint>
#include <vector>

#include "limber/core/progress.h"
#include "limber/rigging/sphere_mesh/collapse_graph.h"
#include "limber/rigging/sphere_mesh/part_moments.h"
#include "limber/rigging/sphere_mesh/sphere_quadric.h"

namespace limber {

// What is merged. A node is one sphere, or a sphere on the side x > 0 with its image in the plane x = 0.
struct CollapseInput {
  std::vector<SphereQuadric> quadrics;  // per node; of the sphere, not of its image
  std::vector<PartMoments> moments;     // per node, likewise
  std::vector<std::uint8_t> single;     // per node: 1 where it is one sphere
  std::vector<GraphEdge> edges;         // connect everything, images included
  std::vector<Border> borders;          // per edge; empty where there are none
  double costOfEnds = 8;                // of losing the end of a limb: this, by the fourth power of the limb's length
  double area = 0;                      // of the surface, which all together weighs 1; 0 where there is none
};

// One step. Two single nodes, or a pair and its image: one sphere less. Two pairs, or a pair and a single node: two
// spheres less at once.
struct Merge {
  Index kept = 0;                // node that represents the result
  Index gone = 0;                // kept itself where a pair merges with its own image
  bool crosses = false;          // kept merged with the image of gone
  bool single = false;           // the result is one sphere
  Index keptBefore = 0;          // the merge that made kept, kNoIndex if it was still as it began
  Index goneBefore = 0;          // likewise
  Index countAfter = 0;          // spheres that are left, images counted
  Index deadBegin = 0;           // edges that went with this merge: deadEdges from here
  Index between = 0;             // of `between`: the count between, where two spheres go at once; else kNoIndex
  float error = 0;               // least error of the result's quadric: what the merge costs
  float planeError = 0;          // of the sphere below: squared distance to planes alone
  Vec3f center = Vec3f::Zero();  // of the result, on the side of kept
  float radius = 0;
  float weight = 0;  // of the result's surface, of one sphere if it is a pair; all of the surface weighs 1

  double planeErrorOfAll() const { return double{planeError} * (single ? 1 : 2); }  // of both, if it is a pair
};

// The count between, where a merge takes two spheres at once, is one of these:
// - before the merge: two nodes on the plane are one, `node` and `gone`
// - after it: an earlier merge of two nodes on the plane is `undone`; what went in it is a sphere of its own
// - before it, where there is neither: a pair, `node`, is one sphere
struct CountBetween {
  Index node = 0;                // whose sphere is another than before the merge, or after it
  Index gone = kNoIndex;         // likewise, of the first kind
  Index undone = kNoIndex;       // a merge, of the second kind
  Vec3f center = Vec3f::Zero();  // of `node`, on the plane
  float radius = 0;
  float weight = 0;
  float planeErrorChange = 0;  // by the spheres of `node` and `gone`
};

// The end of a limb (limbEnds) that no sphere has for itself from a merge on.
struct LostEnd {
  Index countBefore = 0;  // spheres until then
  Index limbs = 0;        // 2 where its image is another limb
  float length = 0;       // of the longest limb that is about as long, in the collapse's space
};

struct CollapseSequence {
  Index initialCount = 0;            // spheres before the first merge
  std::vector<std::uint8_t> single;  // per node, before the first merge
  std::vector<GraphEdge> edges;      // before the first merge
  std::vector<Merge> merges;
  std::vector<DeadEdge> deadEdges;  // every edge, in the order in which they went
  std::vector<Index> absorbedBy;    // per node: the merge in which it was `gone`, kNoIndex for the last one
  std::vector<CountBetween> between;
  std::vector<LostEnd> lostEnds;  // in the order in which they were lost
};

// Spheres at which the ends of limbs are found: the surface is still seen as it is, and few enough to be quick.
inline constexpr Index kEndsKnownFrom = 1024;

// Greedy: each merge is, of all edges at that moment, the one with the least error of the joint quadric (as a float;
// ties by edge index). From kEndsKnownFrom spheres on, a merge of the outer part of a limb (limbEnds) with anything else
// costs more, by the fourth power of the limb's length: legs, wings, a head keep a sphere at their ends before their
// middles do, fingers and ears after them. Errors only grow as quadrics are added, so an edge's error from before a
// neighbour merged is a lower bound of what it is now: an edge is evaluated again only when it reaches the top of the
// queue. Cost: O(#edges log #edges) time; about 270 bytes a node.
CollapseSequence collapse(const CollapseInput& input, Progress& progress);

}  // namespace limber
