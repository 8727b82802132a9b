// Dense matrices for tests: whole matrices in, whole matrices out, by functions of one source file.
// That file alone instantiates Eigen, whose templates take most of a test's compile time otherwise.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace footfall::tests {

// Column-major. A vector is a matrix of one column. Operands whose sizes do not fit throw
// std::invalid_argument.
class Matrix {
 public:
  Matrix() = default;
  explicit Matrix(int rows, int cols = 1);  // zeros
  static Matrix identity(int n);
  static Matrix unit(int n, int i);
  // From `rows` x `cols` numbers, row by row.
  static Matrix of_rows(const double* values, int rows, int cols);
  static Matrix vector(const double* values, int size);
  static Matrix vector(const std::array<double, 3>& values) { return vector(values.data(), 3); }

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int size() const { return rows_ * cols_; }
  double* data() { return values_.data(); }
  const double* data() const { return values_.data(); }
  double& operator()(int i, int j = 0) { return values_[at(i, j)]; }
  double operator()(int i, int j = 0) const { return values_[at(i, j)]; }

  Matrix block(int row, int col, int rows, int cols) const;
  Matrix middle_rows(int row, int rows) const { return block(row, 0, rows, cols_); }
  Matrix head(int rows) const { return block(0, 0, rows, cols_); }
  Matrix tail(int rows) const { return block(rows_ - rows, 0, rows, cols_); }
  Matrix row(int i) const { return block(i, 0, 1, cols_); }
  Matrix col(int j) const { return block(0, j, rows_, 1); }
  void set_block(int row, int col, const Matrix& values);
  void set_row(int i, const Matrix& values) { set_block(i, 0, values); }
  std::vector<double> by_rows() const;

  Matrix transpose() const;
  Matrix& operator+=(const Matrix& other);
  Matrix& operator-=(const Matrix& other);
  Matrix& operator*=(double factor);
  double max_abs() const;  // 0 if empty
  double squared_norm() const;
  double norm() const;

 private:
  std::size_t at(int i, int j) const;
  int rows_ = 0;
  int cols_ = 0;
  std::vector<double> values_;
};

// A copy of a matrix of another kind, Eigen's: its products here are instantiated once for all
// sizes.
template <typename Other>
Matrix dense(const Other& other) {
  Matrix out(static_cast<int>(other.rows()), static_cast<int>(other.cols()));
  for (int j = 0; j < out.cols(); ++j) {
    for (int i = 0; i < out.rows(); ++i) out(i, j) = other(i, j);
  }
  return out;
}

Matrix operator+(Matrix a, const Matrix& b);
Matrix operator-(Matrix a, const Matrix& b);
Matrix operator-(Matrix a);
Matrix operator*(double factor, Matrix a);
Matrix operator/(Matrix a, double divisor);
Matrix operator*(const Matrix& a, const Matrix& b);
double dot(const Matrix& a, const Matrix& b);
Matrix cross(const Matrix& a, const Matrix& b);  // of two vectors in space
Matrix beside(const Matrix& left, const Matrix& right);

// By full-pivot LU. Directions below `threshold` times the largest pivot count as singular; 0: by
// Eigen's default. Of a singular system one solution, if there is any.
Matrix solve(const Matrix& A, const Matrix& B, double threshold = 0.0);
Matrix inverse(const Matrix& A);
// By QR with column pivoting, of an A of full column rank.
Matrix least_squares(const Matrix& A, const Matrix& B);

// By Jacobi SVD, largest first.
std::vector<double> singular_values(const Matrix& A);
// Singular values below the larger of `floor` and `relative` times the largest count as zero.
Matrix pseudo_inverse(const Matrix& A, double relative = 1e-11, double floor = 1e-13);

// The rotation by `angle` about a unit axis (Rodrigues' formula), 3 x 3.
Matrix rotation(const Matrix& axis, double angle);
// Unit axis times angle of a rotation by less than pi.
Matrix rotation_vector(const Matrix& R);

}  // namespace footfall::tests
