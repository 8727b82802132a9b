// Small dense kernels on row-major blocks for the whole-body controller: pivoted Householder QR
// that carries further columns along, and least-squares levels in a cascade of null spaces. Plain
// arrays: no allocation, no bounds beyond the caller's.
#pragma once

namespace footfall::tasks {

// A row-major block: element (r, c) is data[r * stride + c].
struct Block {
  double* data = nullptr;
  int stride = 0;
  double* row(int r) const noexcept { return data + r * stride; }
};

// Householder vectors kept for later, each over the rows [row0, rows) of its own factorisation.
struct Reflectors {
  double* v = nullptr;     // capacity x stride
  double* beta = nullptr;  // capacity
  int stride = 0;
  int count = 0;
};

// x <- H_k ... H_1 x and its inverse x <- H_1 ... H_k x; reflection i acts on x[i .. dims).
void rotate(const Reflectors& h, int dims, double* x) noexcept;
void rotate_back(const Reflectors& h, int dims, double* x) noexcept;

struct QrRange {
  int row_first = 0, row_last = 0;  // rows that the reflections act on
  int col_first = 0, col_last = 0;  // columns to factor (pivoted among themselves)
  int col_end = 0;                  // columns [col_last, col_end) are carried along
  int swap_rows = 0;                // column swaps act on rows [0, swap_rows)
};

// Rank rules; norm2 is the squared norm of each column of the block before any projection.
struct RankRule {
  double tolerance = 1e-6;
  double floor = 1e-10;
  // Optional, by original column number: heavier columns are chosen first, so that what a light
  // one adds is judged in what the heavy ones leave.
  const double* weight = nullptr;
};

// Pivoted Householder QR. `order` and `norm2` are indexed by column and permuted with the columns.
// Writes exact zeros below the diagonal. Returns the rank; `smallest` (may be null) gets the
// smallest kept pivot, 0 without any. `keep` (may be null) collects the reflections.
int pivoted_qr(const Block& x, const QrRange& range, const RankRule& rule, int* order,
               double* norm2, Reflectors* keep, double* smallest, double* work) noexcept;

// One priority level of a cascade. Columns [col_first, col_last) of x are the level's rows
// transposed, expressed in coordinates of which the first `done` are already spent on earlier
// levels: finds the smallest change z[done..done+rank) with M z = rhs in the (weighted) least-
// squares sense. Columns up to col_end are carried along. rhs and weight are indexed by the
// original column number (order[col]). Weights are above 0; however small, one claims what
// heavier columns leave. Below kLightest of the heaviest it counts as that.
inline constexpr double kLightest = 1e-24;  // (1e-12)²: beyond it the solution's digits end
struct LevelRange {
  int row0 = 0;  // block row of coordinate 0
  int dims = 0;  // coordinates in all
  int done = 0;  // spent on earlier levels
  int col_first = 0, col_last = 0, col_end = 0;
  int swap_rows = 0;
};
struct LevelScratch {
  double* rhs = nullptr;    // >= columns of the level
  double* dense = nullptr;  // >= columns x (dims + 1)
  double* work = nullptr;   // >= stride of the block + dims
};
int solve_cascade_level(const Block& x, const LevelRange& level, const RankRule& rule, int* order,
                        double* norm2, const double* rhs, const double* weight, double* z,
                        Reflectors* keep, double* smallest, const LevelScratch& scratch) noexcept;

// Householder QR without pivoting of a (rows x cols, rows >= cols) block, then the right-hand side
// column `cols` is carried along and R y = (Qᵀ b) solved: least squares. y has `cols` entries.
void least_squares(const Block& m, int rows, int cols, double* y, double* work) noexcept;

// QR without pivoting of the (rows x cols) block (full column rank): M = V [T; 0] with T left in
// the block's upper triangle and V kept as reflections: rotate_back gives V x, rotate gives Vᵀ x.
void orthogonal_factor(const Block& m, int rows, int cols, Reflectors* keep) noexcept;

}  // namespace footfall::tasks
