#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_KERNELS_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_KERNELS_H_

namespace splitfusion {

// The inner loops of the solver over plain arrays: 6x6 blocks are 36 numbers by
// rows, vectors six numbers a node. The file is free of Eigen, so that it can
// be compiled for wide vectors as well; sums are taken in one order whatever
// the instruction set, so that results do not depend on the machine.

/// Adds J_f^T J_l for all l >= f, `f` = first: J_k are the columns 6k..6k+5 of
/// the matrix `rows` (count x 6 * nodes, by rows). The product of l is added to
/// block slots[l - f] of `blocks`.
void AddOuterProducts(const double* rows, int count, int nodes, int first,
                      const int* slots, double* blocks);

/// gradient += J^T r: adds `count` rows of `columns` numbers, six or more times
/// six, each times its residual. Of `sides` vectors r, one after the other; the
/// gradients likewise.
void AddGradients(int sides, const double* residuals, const double* rows,
                  int count, int columns, double* gradients);

/// y = A x for a symmetric A of `size` block rows, of which row i holds the
/// blocks row_begin[i] .. row_begin[i + 1] of the upper triangle, the diagonal
/// first.
void MultiplySymmetric(int size, const int* row_begin, const int* columns,
                       const double* blocks, const double* x, double* y);

/// y_i = B_i x_i for `size` symmetric blocks B_i; returns x . y.
double MultiplyDiagonal(int size, const double* blocks, const double* x,
                        double* y);

/// a . b of n numbers.
double DotProduct(int n, const double* a, const double* b);

/// y += alpha x of n numbers.
void AddScaled(int n, double alpha, const double* x, double* y);

/// x += alpha d and r -= alpha q; returns r . r. All of n numbers.
double StepAndResidual(int n, double alpha, const double* d, const double* q,
                       double* x, double* r);

/// d = z + beta d, n numbers.
void NextDirection(int n, double beta, const double* z, double* d);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_KERNELS_H_
