// See matrix.h.
#include "tests/support/matrix.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace footfall::tests {
namespace {

using Eigen::MatrixXd;

Eigen::Map<const MatrixXd> view(const Matrix& m) { return {m.data(), m.rows(), m.cols()}; }
Eigen::Map<MatrixXd> view(Matrix& m) { return {m.data(), m.rows(), m.cols()}; }

// Of a square matrix, which needs no QR decomposition before: half of Eigen's code to compile. Rows
// or columns of zeros add singular values of zero and change nothing else.
using Svd = Eigen::JacobiSVD<MatrixXd, Eigen::NoQRPreconditioner>;

MatrixXd squared(const Matrix& m) {
  const int n = std::max(m.rows(), m.cols());
  MatrixXd square = MatrixXd::Zero(n, n);
  square.topLeftCorner(m.rows(), m.cols()) = view(m);
  return square;
}

void require(bool sizes_fit) {
  if (!sizes_fit) throw std::invalid_argument("matrices whose sizes do not fit");
}

}  // namespace

Matrix::Matrix(int rows, int cols)
    : rows_(rows), cols_(cols), values_(static_cast<std::size_t>(rows * cols), 0.0) {}

Matrix Matrix::identity(int n) {
  Matrix m(n, n);
  for (int i = 0; i < n; ++i) m(i, i) = 1.0;
  return m;
}

Matrix Matrix::unit(int n, int i) {
  Matrix m(n);
  m(i) = 1.0;
  return m;
}

Matrix Matrix::of_rows(const double* values, int rows, int cols) {
  Matrix m(rows, cols);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < cols; ++j) m(i, j) = values[i * cols + j];
  }
  return m;
}

Matrix Matrix::vector(const double* values, int size) { return of_rows(values, size, 1); }

std::size_t Matrix::at(int i, int j) const {
  require(i >= 0 && i < rows_ && j >= 0 && j < cols_);
  return static_cast<std::size_t>(j * rows_ + i);
}

Matrix Matrix::block(int row, int col, int rows, int cols) const {
  Matrix m(rows, cols);
  for (int j = 0; j < cols; ++j) {
    for (int i = 0; i < rows; ++i) m(i, j) = (*this)(row + i, col + j);
  }
  return m;
}

void Matrix::set_block(int row, int col, const Matrix& values) {
  for (int j = 0; j < values.cols(); ++j) {
    for (int i = 0; i < values.rows(); ++i) (*this)(row + i, col + j) = values(i, j);
  }
}

std::vector<double> Matrix::by_rows() const { return transpose().values_; }

Matrix Matrix::transpose() const {
  Matrix m(cols_, rows_);
  view(m) = view(*this).transpose();
  return m;
}

Matrix& Matrix::operator+=(const Matrix& other) {
  require(rows_ == other.rows_ && cols_ == other.cols_);
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] += other.values_[k];
  return *this;
}

Matrix& Matrix::operator-=(const Matrix& other) {
  require(rows_ == other.rows_ && cols_ == other.cols_);
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] -= other.values_[k];
  return *this;
}

Matrix& Matrix::operator*=(double factor) {
  for (double& value : values_) value *= factor;
  return *this;
}

double Matrix::max_abs() const {
  double largest = 0.0;
  for (const double value : values_) {
    if (!(std::abs(value) <= largest)) largest = std::abs(value);  // also NaN
    if (std::isnan(largest)) break;
  }
  return largest;
}

double Matrix::squared_norm() const { return dot(*this, *this); }
double Matrix::norm() const { return std::sqrt(squared_norm()); }

Matrix operator+(Matrix a, const Matrix& b) { return a += b; }
Matrix operator-(Matrix a, const Matrix& b) { return a -= b; }
Matrix operator-(Matrix a) { return a *= -1.0; }
Matrix operator*(double factor, Matrix a) { return a *= factor; }
Matrix operator/(Matrix a, double divisor) { return a *= 1.0 / divisor; }

Matrix operator*(const Matrix& a, const Matrix& b) {
  require(a.cols() == b.rows());
  Matrix m(a.rows(), b.cols());
  view(m).noalias() = view(a) * view(b);
  return m;
}

double dot(const Matrix& a, const Matrix& b) {
  require(a.size() == b.size());
  double sum = 0.0;
  for (int k = 0; k < a.size(); ++k) sum += a.data()[k] * b.data()[k];
  return sum;
}

Matrix cross(const Matrix& a, const Matrix& b) {
  require(a.size() == 3 && b.size() == 3);
  Matrix m(3);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    m(i) = a(j) * b(k) - a(k) * b(j);
  }
  return m;
}

Matrix beside(const Matrix& left, const Matrix& right) {
  Matrix m(left.rows(), left.cols() + right.cols());
  m.set_block(0, 0, left);
  m.set_block(0, left.cols(), right);
  return m;
}

Matrix solve(const Matrix& A, const Matrix& B, double threshold) {
  require(A.rows() == B.rows());
  Eigen::FullPivLU<MatrixXd> lu(view(A));
  if (threshold > 0.0) lu.setThreshold(threshold);
  Matrix X(A.cols(), B.cols());
  view(X) = lu.solve(MatrixXd(view(B)));
  return X;
}

Matrix least_squares(const Matrix& A, const Matrix& B) {
  require(A.rows() == B.rows());
  Matrix X(A.cols(), B.cols());
  view(X) = Eigen::ColPivHouseholderQR<MatrixXd>(view(A)).solve(MatrixXd(view(B)));
  return X;
}

Matrix inverse(const Matrix& A) {
  require(A.rows() == A.cols());
  return solve(A, Matrix::identity(A.rows()));
}

std::vector<double> singular_values(const Matrix& A) {
  if (A.size() == 0) return {};
  const Eigen::VectorXd s = Svd(squared(A)).singularValues();
  return {s.data(), s.data() + std::min(A.rows(), A.cols())};
}

Matrix pseudo_inverse(const Matrix& A, double relative, double floor) {
  Matrix m(A.cols(), A.rows());
  if (A.size() == 0) return m;
  const Svd svd(squared(A), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::VectorXd& s = svd.singularValues();
  const double limit = std::max(floor, relative * s(0));
  MatrixXd V = svd.matrixV();
  for (Eigen::Index k = 0; k < s.size(); ++k) V.col(k) *= s(k) > limit ? 1.0 / s(k) : 0.0;
  const MatrixXd inverse = V * svd.matrixU().transpose();
  view(m) = inverse.topLeftCorner(m.rows(), m.cols());
  return m;
}

Matrix rotation(const Matrix& axis, double angle) {
  require(axis.size() == 3);
  Matrix K(3, 3);  // K v = axis x v
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    K(j, k) = -axis(i);
    K(k, j) = axis(i);
  }
  return Matrix::identity(3) + std::sin(angle) * K + (1.0 - std::cos(angle)) * (K * K);
}

Matrix rotation_vector(const Matrix& R) {
  Matrix v(3);  // axis times sine
  for (int i = 0; i < 3; ++i)
    v(i) = 0.5 * (R((i + 2) % 3, (i + 1) % 3) - R((i + 1) % 3, (i + 2) % 3));
  const double sine = v.norm();
  const double angle = std::atan2(sine, 0.5 * (R(0, 0) + R(1, 1) + R(2, 2) - 1.0));
  return (sine > 0.0 ? angle / sine : 1.0) * v;
}

}  // namespace footfall::tests
