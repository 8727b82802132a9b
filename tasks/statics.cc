// See statics.h.
//
// With f = H⁻¹ Eᵀ λ, E H⁻¹ Eᵀ λ = w, where E f collects force and moment about the CoM, w bears the
// weight, and H weighs each contact's tangential force by 1/N², its normal force by kNormal of
// that. N is that of the iteration before; 6 x 6 whatever the number of contacts.
#include "tasks/statics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "core/capacities.h"
#include "core/index.h"

namespace footfall::tasks {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNormal = 1e-4;   // cost of a normal force against that of a tangential one
constexpr double kDamping = 1e-9;  // of the directions without rank, relative
constexpr double kLeast = 0.02;    // least N_i, of the mean: a contact hardly loaded stays one
constexpr int kIterations = 3;

// [I; r x / length] H⁻¹ of one contact.
struct Lever {
  Vector3d normal, arm;  // arm: from the CoM, over the length
  Matrix3d cheapness(double load) const {
    const Matrix3d along = normal * normal.transpose();
    return load * load * (Matrix3d::Identity() - along + along / kNormal);
  }
  Eigen::Matrix<double, 6, 3> map() const {
    Eigen::Matrix<double, 6, 3> E;
    E.topRows<3>().setIdentity();
    E.bottomRows<3>() << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
    return E;
  }
};

}  // namespace

void static_forces(const model::ControlModel& model, const int* contacts, int count,
                   double* forces) noexcept {
  std::array<Lever, core::kMaxContacts> levers;
  std::array<double, core::kMaxContacts> loads{};
  const Vector3d com(model.com().position.data());
  double length = 0.0;
  for (int i = 0; i < count; ++i) {
    levers[at(i)] = {Vector3d(model.contact_normal(contacts[i]).data()),
                     Vector3d(model.point_position(contacts[i]).data()) - com};
    length = std::max(length, levers[at(i)].arm.norm());
  }
  const double weight = model.mass() * model.gravity();
  const double share = weight / std::max(1, count);
  for (int i = 0; i < count; ++i) {
    if (length > 0.0) levers[at(i)].arm /= length;
    loads[at(i)] = share;
  }
  Vector6d wanted = Vector6d::Zero();
  wanted[2] = weight;
  for (int k = 0; k < kIterations; ++k) {
    Matrix6d M = Matrix6d::Zero();
    for (int i = 0; i < count; ++i) {
      const Eigen::Matrix<double, 6, 3> E = levers[at(i)].map();
      M += E * levers[at(i)].cheapness(loads[at(i)]) * E.transpose();
    }
    M.diagonal().array() += kDamping * M.trace();
    const Vector6d lambda = M.llt().solve(wanted);
    for (int i = 0; i < count; ++i) {
      const Lever& lever = levers[at(i)];
      const Vector3d f = lever.cheapness(loads[at(i)]) * (lever.map().transpose() * lambda);
      Vector3d::Map(forces + 3 * i) = f;
      loads[at(i)] = std::max(lever.normal.dot(f), kLeast * share);
    }
  }
}

}  // namespace footfall::tasks
