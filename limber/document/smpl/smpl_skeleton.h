// The skeletons of SMPL (Loper and others 2015), SMPL-H (Romero and others 2017) and SMPL-X (Pavlakos and others 2019).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "limber/document/smpl/npz.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// All of them begin with these, from the pelvis to the wrists.
constexpr std::size_t kSmplBodyJoints = 22;

// 22 of the body, 24 with SMPL's hands, 52 with SMPL-H's fingers, 55 with SMPL-X's jaw, eyes and fingers?
bool isSmplJointCount(std::size_t joints);

// As the models' own programs call them ("left_wrist", "right_pinky3"), in their order; of other counts than those
// above "joint_00", ...
std::vector<std::string> smplJointNames(std::size_t joints);

// A person of 1.70 m in the models' rest pose: a T-pose with its feet on y = 0, facing +Z, the joints' frames aligned
// with the world. Its proportions are not a model's, which nobody may redistribute, but the lengths of segments by
// Drillis and Contini (D. A. Winter, Biomechanics and Motor Control of Human Movement, 4th edition 2009, figure 4.1).
// Throws Error kBadArgument for other counts than those above.
Skeleton smplSkeleton(std::size_t joints);

// That of a body in SMPL's layout of arrays (pipeline/smpl_body.h) whose vertices are these (#V): joints are
// J_regressor
// (#J x #V) times them, or without one the array J (#J x 3); the tree is kintree_table's (2 x #J), parents first.
// Throws Error kBadData, naming the array, where one is missing, has another shape or holds what cannot be, and
// kUnsupported as readNpy does.
Skeleton smplSkeleton(const NpzFiles& body, std::span<const Vec3> vertices);

// Its array v_template (#V x 3), and that plus shapedirs (#V x 3 x #S) times betas as far as both go; without shapedirs
// the first. Throws likewise.
std::vector<Vec3> smplVertices(const NpzFiles& body);
std::vector<Vec3> smplVertices(const NpzFiles& body, std::span<const double> betas);

}  // namespace limber
