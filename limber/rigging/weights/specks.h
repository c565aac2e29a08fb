// Specks that float about a body, as scans leave them: none of them is torn when the body is posed.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Gives all vertices of each speck the mean of their weights, of which the strongest influences are kept. A speck is a
// connected piece of at most 16 triangles whose box is at most 1/20 of modelBox in each direction: the bones that its
// few vertices see depend on the direction in which they happen to face. Where such pieces are more than a tenth of the
// surface, the model is made of them, and they stay as they are.
//
// mesh  #V as the weights have vertices
// Cost: O(#V + #F).
void holdSpecks(const TriMesh& mesh, SkinWeights& weights);

}  // namespace limber
