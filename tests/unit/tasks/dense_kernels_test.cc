// The Householder kernels against their definitions and against least squares by SVD.
#include "tasks/solver/dense_kernels.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

using tasks::Block;

constexpr double kRound = 1e-12;  // 1e-16 times sizes and conditions of about 100

Matrix random_matrix(Random& random, int rows, int columns) {
  Matrix m(rows, columns);
  for (int i = 0; i < m.size(); ++i) m.data()[i] = random.within(1.0);
  return m;
}

struct Factored {
  Matrix x;
  std::vector<int> order;
  std::vector<double> norm2, v, beta;
  tasks::Reflectors keep;
  double smallest = 0.0;
  int rank = 0;
};

// Factors the first `factor` columns of m; the rest is carried along.
Factored factor_columns(const Matrix& m, int factor, const tasks::RankRule& rule = {}) {
  Factored f;
  const int rows = m.rows(), columns = m.cols();
  std::vector<double> x = m.by_rows();
  f.order.resize(static_cast<std::size_t>(columns));
  std::iota(f.order.begin(), f.order.end(), 0);
  for (int c = 0; c < m.cols(); ++c) f.norm2.push_back(m.col(c).squared_norm());
  f.v.resize(static_cast<std::size_t>(rows * rows));
  f.beta.resize(static_cast<std::size_t>(rows));
  f.keep = {f.v.data(), f.beta.data(), rows, 0};
  std::vector<double> work(static_cast<std::size_t>(rows + columns));
  f.rank = tasks::pivoted_qr({x.data(), columns}, {0, rows, 0, factor, columns, rows}, rule,
                             f.order.data(), f.norm2.data(), &f.keep, &f.smallest, work.data());
  f.x = Matrix::of_rows(x.data(), rows, columns);
  return f;
}

TEST(PivotedQr, KeepsInnerProductsOfAllColumns) {
  Random random(1);
  const Matrix m = random_matrix(random, 9, 7);
  const Factored f = factor_columns(m, 4);
  EXPECT_EQ(f.rank, 4);
  Matrix permuted(9, 7);
  for (int c = 0; c < 7; ++c) {
    permuted.set_block(0, c, m.col(f.order[static_cast<std::size_t>(c)]));
  }
  EXPECT_LE((f.x.transpose() * f.x - permuted.transpose() * permuted).max_abs(), kRound);
  for (int c = 0; c < 4; ++c) {
    for (int r = c + 1; r < 9; ++r) EXPECT_EQ(f.x(r, c), 0.0);
  }
}

TEST(PivotedQr, KeptReflectionsTurnAColumnForthAndBack) {
  Random random(2);
  const Matrix m = random_matrix(random, 8, 5);
  const Factored f = factor_columns(m, 4);
  Matrix x = m.col(f.order[4]);
  const Matrix original = x;
  tasks::rotate(f.keep, 8, x.data());
  EXPECT_LE((x - f.x.col(4)).max_abs(), kRound);
  tasks::rotate_back(f.keep, 8, x.data());
  EXPECT_LE((x - original).max_abs(), kRound);
}

TEST(PivotedQr, FindsTheRankAndLeavesExactZerosBehindIt) {
  Random random(3);
  const Matrix m = random_matrix(random, 8, 3) * random_matrix(random, 3, 6);
  const Factored f = factor_columns(m, 6);
  EXPECT_EQ(f.rank, 3);
  EXPECT_EQ(f.x.tail(5).max_abs(), 0.0);
  EXPECT_GT(f.smallest, 0.0);
}

// By hand: of b = 0.999 (1, 1/50) only 0.999/50 is not in the direction of a = (1, 0).
TEST(PivotedQr, TheSmallestPivotIsWhatTheOtherColumnsLeave) {
  Matrix m(3, 2);
  m(0, 0) = 1.0;
  m(0, 1) = 0.999;
  m(1, 1) = 0.999 / 50.0;
  EXPECT_NEAR(factor_columns(m, 2).smallest, 0.999 / 50.0, kRound);
  EXPECT_NEAR(factor_columns(m, 1).smallest, 1.0, kRound);
  EXPECT_EQ(factor_columns(Matrix(3, 2), 2).smallest, 0.0);
}

TEST(PivotedQr, ColumnsBelowTheAbsoluteFloorHaveNoRank) {
  Random random(4);
  const Matrix tiny = 1e-12 * random_matrix(random, 5, 3);
  EXPECT_EQ(factor_columns(tiny, 3).rank, 0);
  EXPECT_EQ(factor_columns(Matrix(5, 3), 3).rank, 0);
  EXPECT_EQ(factor_columns(tiny, 3, {1e-6, 1e-14}).rank, 3);
}

TEST(PivotedQr, ColumnsThatAreAllOfARowsSpaceStopAtItsSize) {
  Random random(5);
  EXPECT_EQ(factor_columns(random_matrix(random, 3, 10), 10).rank, 3);
}

TEST(LeastSquares, AgreesWithTheSvd) {
  Random random(6);
  for (int rows = 3; rows < 12; ++rows) {
    const Matrix M = random_matrix(random, rows, 3);
    const Matrix b = random_matrix(random, rows, 1);
    std::vector<double> x = beside(M, b).by_rows();
    Matrix y(3), work(2 * rows + 8);
    tasks::least_squares({x.data(), 4}, rows, 3, y.data(), work.data());
    EXPECT_LE((y - pseudo_inverse(M) * b).max_abs(), 100 * kRound);
  }
}

TEST(OrthogonalFactor, GivesARotationAndATriangle) {
  Random random(7);
  const Matrix M = random_matrix(random, 6, 4);
  std::vector<double> t = M.by_rows();
  Matrix v(36), beta(6);
  tasks::Reflectors keep = {v.data(), beta.data(), 6, 0};
  tasks::orthogonal_factor({t.data(), 4}, 6, 4, &keep);
  Matrix V = Matrix::identity(6);
  for (int c = 0; c < 6; ++c) tasks::rotate_back(keep, 6, V.data() + 6 * c);
  EXPECT_LE((V.transpose() * V - Matrix::identity(6)).max_abs(), kRound);
  Matrix T(6, 4);
  for (int r = 0; r < 4; ++r) {
    for (int c = r; c < 4; ++c) T(r, c) = t[static_cast<std::size_t>(4 * r + c)];
  }
  EXPECT_LE((V * T - M).max_abs(), kRound);
}

// Two levels against the textbook cascade: minimum of the second in the null space of the first.
TEST(CascadeLevel, TheSecondLevelUsesOnlyWhatTheFirstLeaves) {
  Random random(8);
  const int dims = 6;
  for (const int second : {2, 3, 9}) {  // less than, equal to and more than what is left
    const Matrix M1 = random_matrix(random, 3, dims), M2 = random_matrix(random, second, dims);
    const Matrix rhs = random_matrix(random, 3 + second, 1);
    const int columns = 3 + second;
    const Matrix rows = beside(M1.transpose(), M2.transpose());
    std::vector<double> x = rows.by_rows();
    std::vector<int> order(static_cast<std::size_t>(columns));
    std::iota(order.begin(), order.end(), 0);
    std::vector<double> norm2, weight(static_cast<std::size_t>(columns), 1.0);
    for (int c = 0; c < columns; ++c) norm2.push_back(rows.col(c).squared_norm());
    Matrix z(dims), v(dims * dims), beta(dims), r(columns), d(columns * (dims + 1)),
        work(3 * columns + 3 * dims);
    tasks::Reflectors keep = {v.data(), beta.data(), dims, 0};
    const tasks::LevelScratch scratch = {r.data(), d.data(), work.data()};
    const Block block = {x.data(), columns};
    int done = 0;
    int first = 0;
    for (const int last : {3, columns}) {
      done += tasks::solve_cascade_level(block, {0, dims, done, first, last, columns, dims}, {},
                                         order.data(), norm2.data(), rhs.data(), weight.data(),
                                         z.data(), &keep, nullptr, scratch);
      first = last;
    }
    tasks::rotate_back(keep, dims, z.data());
    EXPECT_LE((M1 * z - rhs.head(3)).max_abs(), 100 * kRound);
    const Matrix N = Matrix::identity(dims) - pseudo_inverse(M1) * M1;
    const Matrix gradient = N.transpose() * M2.transpose() * (M2 * z - rhs.tail(second));
    EXPECT_LE(gradient.max_abs(), 100 * kRound);
  }
}

}  // namespace
}  // namespace footfall::tests
