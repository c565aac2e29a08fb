// For each vertex, the point that the parts of the surface bound like it turn about.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// #V centres for centersOfRotation: the mean of the triangles' centroids by area and by how alike vertex and triangle
// are bound, s = sum over joints j != k of w_j w_k u_j u_k exp(-(w_j u_k - w_k u_j)^2 / 0.01), w the vertex' weights
// and u the mean of the triangle's (Le, Hodgins 2016, equations 1 and 6). A vertex bound to a single joint, or like no
// triangle, is its own centre: any point serves it.
//
// Triangles alike in the weights of two joints, within a 64th of each, count as one with their mean weights: off by
// less than a thousandth of the model's size. Cost: for each vertex and each two of its joints, the triangles bound to
// both or at most some 2000 such groups; 10 to 100 microseconds a vertex. In parallel; the result does not depend on
// the number of threads. Throws Error kBadArgument where sizes do not match or a triangle names a vertex that is not
// there.
//
// positions  #V, as bound
// weights    of #V vertices, each with a sum of 1 or 0
std::vector<Vec3f> rotationCenters(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                   const SkinWeights& weights);

}  // namespace limber
