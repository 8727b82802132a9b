// The mass matrix factored along the kinematic tree, A = Lᵀ D L with L unit lower triangular and
// non-zero only between a coordinate and its ancestors. Half-solves with it keep a leg's Jacobian
// zero in the other legs' rows, which a dense Cholesky factor does not.
#pragma once

namespace footfall::model {

// View of a factor owned elsewhere (MuJoCo's qLD layout: row i holds its diagonal, then the entries
// of its ancestors, nearest first).
struct TreeFactor {
  int n = 0;
  const double* entries = nullptr;        // qLD
  const int* row_start = nullptr;         // n, index of row i's diagonal in entries
  const int* parent = nullptr;            // n, parent coordinate, -1 at the root
  const double* diag_sqrt_inv = nullptr;  // n, 1/sqrt(D_i)
};

// Two doubles in one register; any address.
using DoublePair = double __attribute__((vector_size(16), aligned(8), may_alias));

// X <- D^{-1/2} L^{-T} X for a row-major n x columns block: then Xᵀ Y = (X₀)ᵀ A⁻¹ Y₀. An odd count
// of columns takes the next one along: the block needs an even stride.
inline void whiten(const TreeFactor& f, double* x, int columns, int stride) noexcept {
  const int pairs = (columns + 1) / 2;
  for (int i = f.n - 1; i >= 0; --i) {
    const auto* xi = reinterpret_cast<const DoublePair*>(x + i * stride);
    const double* entry = f.entries + f.row_start[i] + 1;
    for (int j = f.parent[i]; j >= 0; j = f.parent[j], ++entry) {
      const DoublePair l = {*entry, *entry};
      auto* xj = reinterpret_cast<DoublePair*>(x + j * stride);
      for (int c = 0; c < pairs; ++c) xj[c] -= l * xi[c];
    }
  }
  for (int i = 0; i < f.n; ++i) {
    auto* xi = reinterpret_cast<DoublePair*>(x + i * stride);
    const DoublePair d = {f.diag_sqrt_inv[i], f.diag_sqrt_inv[i]};
    for (int c = 0; c < pairs; ++c) xi[c] *= d;
  }
}

}  // namespace footfall::model
