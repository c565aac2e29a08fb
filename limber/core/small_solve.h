// Linear algebra for a few dozen rows, in memory that the caller keeps: same order of operations everywhere, nothing
// allocated.
#pragma once

#include <Eigen/Core>

namespace limber {

// Solves (a + damping * I) x = b by Cholesky. a is symmetric, positive semi-definite, #m x #m, its lower part is read;
// `a` is overwritten. x and b may be the same. A direction in which the sum is singular gets 0.
void solveCholesky(Eigen::Ref<Eigen::MatrixXd> a, double damping, Eigen::Ref<Eigen::VectorXd> x);

// Eigenvalues of a symmetric #m x #m matrix on its diagonal, eigenvectors in the columns of `vectors` (#m x #m), by
// Jacobi's rotations. `a` is overwritten. In no order.
void symmetricEigen(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> vectors);

// Rounds to multiples of 2^-bits of about the largest entry. Sums over effectors round otherwise for the left than for
// the right; rounded away from steps before they are made, such differences cannot grow from step to step, and
// symmetric problems have symmetric answers.
void roundTogether(int bits, Eigen::Ref<Eigen::VectorXd> x);

}  // namespace limber
