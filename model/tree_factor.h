// The mass matrix factored along the kinematic tree, A = Lᵀ D L with L unit lower triangular and
// non-zero only between a coordinate and its ancestors. Half-solves with it keep a leg's Jacobian
// zero in the other legs' rows, which a dense Cholesky factor does not.
#pragma once

namespace footfall::model {

// View of a factor owned elsewhere (MuJoCo's qLD layout: row i holds its diagonal, then the entries
// of its ancestors, nearest first).
struct TreeFactor {
  int n = 0;
  const double* entries = nullptr;          // qLD
  const int* row_start = nullptr;           // n, index of row i's diagonal in entries
  const int* parent = nullptr;              // n, parent coordinate, -1 at the root
  const double* diag_sqrt_inv = nullptr;    // n, 1/sqrt(D_i)
};

// X <- D^{-1/2} L^{-T} X for a row-major n x columns block: then Xᵀ Y = (X₀)ᵀ A⁻¹ Y₀.
inline void whiten(const TreeFactor& f, double* x, int columns, int stride) noexcept {
  for (int i = f.n - 1; i >= 0; --i) {
    const double* xi = x + i * stride;
    int entry = f.row_start[i] + 1;
    for (int j = f.parent[i]; j >= 0; j = f.parent[j], ++entry) {
      const double l = f.entries[entry];
      double* xj = x + j * stride;
      for (int c = 0; c < columns; ++c) xj[c] -= l * xi[c];
    }
  }
  for (int i = 0; i < f.n; ++i) {
    double* xi = x + i * stride;
    const double d = f.diag_sqrt_inv[i];
    for (int c = 0; c < columns; ++c) xi[c] *= d;
  }
}

}  // namespace footfall::model
