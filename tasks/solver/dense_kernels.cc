// Householder kernels; see dense_kernels.h.
#include "tasks/solver/dense_kernels.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace footfall::tasks {
namespace {

// Two doubles that the compiler keeps in one register; any address.
using Pair = double __attribute__((vector_size(16), aligned(8), may_alias));

// Columns [c, c + 2 kPairs): their products with v stay in registers between the two passes.
template <int kPairs>
inline void reflect_block(double* first_row, int stride, int rows, const double* v,
                          double beta) noexcept {
  Pair w[kPairs] = {};
  const double* x = first_row;
  for (int r = 0; r < rows; ++r, x += stride) {
    const Pair vr = {v[r], v[r]};
    for (int p = 0; p < kPairs; ++p) w[p] += vr * reinterpret_cast<const Pair*>(x)[p];
  }
  const Pair scale = {beta, beta};
  for (int p = 0; p < kPairs; ++p) w[p] *= scale;
  double* y = first_row;
  for (int r = 0; r < rows; ++r, y += stride) {
    const Pair vr = {v[r], v[r]};
    for (int p = 0; p < kPairs; ++p) reinterpret_cast<Pair*>(y)[p] -= vr * w[p];
  }
}

// x -= beta v (vᵀ x) on rows [first, last) and columns [c0, c1); v[0] belongs to row `first`.
void reflect(const Block& x, int first, int last, int c0, int c1, const double* v,
             double beta) noexcept {
  const int rows = last - first;
  double* top = x.row(first);
  int c = c0;
  for (; c + 8 <= c1; c += 8) reflect_block<4>(top + c, x.stride, rows, v, beta);
  if (c + 4 <= c1) {
    reflect_block<2>(top + c, x.stride, rows, v, beta);
    c += 4;
  }
  if (c + 2 <= c1) {
    reflect_block<1>(top + c, x.stride, rows, v, beta);
    c += 2;
  }
  if (c == c1) return;
  double w = 0.0;
  for (int r = 0; r < rows; ++r) w += v[r] * top[r * x.stride + c];
  w *= beta;
  for (int r = 0; r < rows; ++r) top[r * x.stride + c] -= w * v[r];
}

// Makes the reflector of column c over rows [first, last): v (v[0] at row first) and beta; writes
// the resulting column (alpha, 0, ...). Returns |alpha|.
double make_reflector(const Block& x, int first, int last, int c, double* v,
                      double* beta) noexcept {
  double norm2 = 0.0;
  for (int r = first; r < last; ++r) {
    v[r - first] = x.row(r)[c];
    norm2 += v[r - first] * v[r - first];
  }
  const double norm = std::sqrt(norm2);
  const double alpha = v[0] > 0.0 ? -norm : norm;
  const double half_vtv = norm2 - alpha * v[0];
  v[0] -= alpha;
  *beta = half_vtv > 0.0 ? 1.0 / half_vtv : 0.0;
  x.row(first)[c] = alpha;
  for (int r = first + 1; r < last; ++r) x.row(r)[c] = 0.0;
  return norm;
}

void swap_columns(const Block& x, int rows, int a, int b, int* order, double* norm2) noexcept {
  for (int r = 0; r < rows; ++r) std::swap(x.row(r)[a], x.row(r)[b]);
  std::swap(order[a], order[b]);
  std::swap(norm2[a], norm2[b]);
}

double heaviest(const LevelRange& level, const double* weight, const int* order) noexcept {
  double most = 0.0;
  for (int c = level.col_first; c < level.col_last; ++c) most = std::max(most, weight[order[c]]);
  return most;
}

// The column with the largest remaining (weighted) norm among those that pass the rank rule; -1:
// none does.
int choose_pivot(const Block& x, int first, const QrRange& range, const RankRule& rule,
                 const int* order, const double* norm2, int next,
                 double* __restrict remaining) noexcept {
  const int n = range.col_last - next;
  const int rows = range.row_last - first;
  const double* top = x.row(first) + next;
  int done = 0;
  for (; done + 2 <= n; done += 2) {
    Pair sum = {};
    const double* xr = top + done;
    for (int r = 0; r < rows; ++r, xr += x.stride) {
      const Pair v = *reinterpret_cast<const Pair*>(xr);
      sum += v * v;
    }
    *reinterpret_cast<Pair*>(remaining + done) = sum;
  }
  if (done < n) {
    remaining[done] = 0.0;
    for (int r = 0; r < rows; ++r) {
      const double v = top[r * x.stride + done];
      remaining[done] += v * v;
    }
  }
  const double tolerance2 = rule.tolerance * rule.tolerance;
  const double floor2 = rule.floor * rule.floor;
  int best = -1;
  double best_norm = -1.0;
  for (int c = 0; c < n; ++c) {
    const double limit = std::max(tolerance2 * norm2[next + c], floor2);
    const double size =
        rule.weight == nullptr ? remaining[c] : rule.weight[order[next + c]] * remaining[c];
    if (remaining[c] > limit && size > best_norm) {
      best = next + c;
      best_norm = size;
    }
  }
  return best;
}

void reflect_vector(const Reflectors& h, int i, int dims, double* x) noexcept {
  const double* v = h.v + i * h.stride;
  double s = 0.0;
  for (int q = i; q < dims; ++q) s += v[q - i] * x[q];
  s *= h.beta[i];
  for (int q = i; q < dims; ++q) x[q] -= s * v[q - i];
}

}  // namespace

void rotate(const Reflectors& h, int dims, double* x) noexcept {
  for (int i = 0; i < h.count; ++i) reflect_vector(h, i, dims, x);
}

void rotate_back(const Reflectors& h, int dims, double* x) noexcept {
  for (int i = h.count - 1; i >= 0; --i) reflect_vector(h, i, dims, x);
}

int pivoted_qr(const Block& x, const QrRange& range, const RankRule& rule, int* order,
               double* norm2, Reflectors* keep, double* smallest, double* work) noexcept {
  const int columns = range.col_last - range.col_first;
  const int most = std::min(columns, range.row_last - range.row_first);
  double least = 0.0;
  int rank = 0;
  for (; rank < most; ++rank) {
    const int first = range.row_first + rank;
    const int c = range.col_first + rank;
    const int pivot = choose_pivot(x, first, range, rule, order, norm2, c, work);
    if (pivot < 0) break;
    if (pivot != c) swap_columns(x, range.swap_rows, c, pivot, order, norm2);
    double local_v[1 + 6 + 64];
    double local_beta = 0.0;
    double* v = keep ? keep->v + keep->count * keep->stride : local_v;
    double* beta = keep ? keep->beta + keep->count : &local_beta;
    const double size = make_reflector(x, first, range.row_last, c, v, beta);
    if (keep) ++keep->count;
    reflect(x, first, range.row_last, c + 1, range.col_end, v, *beta);
    least = rank == 0 ? size : std::min(least, size);
  }
  // What the rank rule rejected is round-off or close to it: it must not feed later levels.
  for (int r = range.row_first + rank; r < range.row_last; ++r) {
    std::fill(x.row(r) + range.col_first + rank, x.row(r) + range.col_last, 0.0);
  }
  if (smallest) *smallest = least;
  return rank;
}

int solve_cascade_level(const Block& x, const LevelRange& level, const RankRule& rule, int* order,
                        double* norm2, const double* rhs, const double* weight, double* z,
                        Reflectors* keep, double* smallest, const LevelScratch& scratch) noexcept {
  const int m = level.col_last - level.col_first;
  const int row_first = level.row0 + level.done;
  const QrRange range = {row_first,      level.row0 + level.dims, level.col_first,
                         level.col_last, level.col_end,           level.swap_rows};
  const RankRule by_weight = {rule.tolerance, rule.floor, weight};
  const int k = pivoted_qr(x, range, by_weight, order, norm2, keep, smallest, scratch.work);
  for (int i = 0; i < m; ++i) {
    const int c = level.col_first + i;
    double value = rhs[order[c]];
    for (int q = 0; q < level.done; ++q) value -= x.row(level.row0 + q)[c] * z[q];
    scratch.rhs[i] = value;
  }
  double* y = z + level.done;
  if (k == m) {  // R11ᵀ y = rhs
    for (int i = 0; i < m; ++i) {
      double value = scratch.rhs[i];
      for (int q = 0; q < i; ++q) value -= x.row(row_first + q)[level.col_first + i] * y[q];
      y[i] = value / x.row(row_first + i)[level.col_first + i];
    }
    return k;
  }
  if (k == 0) return 0;
  const Block dense = {scratch.dense, k + 1};
  const double most = heaviest(level, weight, order);
  for (int i = 0; i < m; ++i) {
    const int c = level.col_first + i;
    const double w = std::sqrt(std::max(weight[order[c]] / most, kLightest));
    for (int q = 0; q < k; ++q) dense.row(i)[q] = w * x.row(row_first + q)[c];
    dense.row(i)[k] = w * scratch.rhs[i];
  }
  least_squares(dense, m, k, y, scratch.work);
  return k;
}

void least_squares(const Block& m, int rows, int cols, double* y, double* work) noexcept {
  double* v = work;
  for (int c = 0; c < cols; ++c) {
    double beta = 0.0;
    make_reflector(m, c, rows, c, v, &beta);
    reflect(m, c, rows, c + 1, cols + 1, v, beta);
  }
  for (int i = cols - 1; i >= 0; --i) {
    double value = m.row(i)[cols];
    for (int q = i + 1; q < cols; ++q) value -= m.row(i)[q] * y[q];
    y[i] = value / m.row(i)[i];
  }
}

void orthogonal_factor(const Block& m, int rows, int cols, Reflectors* keep) noexcept {
  for (int c = 0; c < cols; ++c) {
    double* v = keep->v + keep->count * keep->stride;
    double* beta = keep->beta + keep->count;
    make_reflector(m, c, rows, c, v, beta);
    ++keep->count;
    reflect(m, c, rows, c + 1, cols, v, *beta);
  }
}

}  // namespace footfall::tasks
