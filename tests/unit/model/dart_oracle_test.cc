// Kinematics and dynamics against an independent library, DART, on the same tree.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <map>
#include <memory>

#include "model/mjcf.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using dart::dynamics::BodyNode;
using dart::dynamics::Skeleton;

constexpr double kRelative = 1e-8;  // the project's bar; both libraries are good to 1e-13

Isometry3d placement(const double* p, const double* quat) {
  Isometry3d T = Isometry3d::Identity();
  T.translation() = Vector3d(p[0], p[1], p[2]);
  if (quat) T.linear() = Eigen::Quaterniond(quat[0], quat[1], quat[2], quat[3]).toRotationMatrix();
  return T;
}

// The same tree from the compiled MJCF's numbers: masses, inertias, joint places and axes.
class DartTwin {
 public:
  explicit DartTwin(const std::string& mjcf)
      : m_(model::load_robot_model(mjcf), &mj_deleteModel), skeleton_(Skeleton::create("twin")) {
    for (int b = 1; b < m_->nbody; ++b) add_body(b);
    skeleton_->setGravity(Vector3d(0.0, 0.0, m_->opt.gravity[2]));
  }

  // ν_dart = T ν: DART's base velocity is the body twist, angular first.
  void set(const model::State& s) {
    const auto n = static_cast<Eigen::Index>(m_->nv);
    const Isometry3d base = placement(s.p_WB.data(), s.q_WB.data());
    const Eigen::Matrix3d Rt = base.linear().transpose();
    const Vector3d v(s.v_WB[0], s.v_WB[1], s.v_WB[2]);
    const Vector3d w(s.w_WB_B[0], s.w_WB_B[1], s.w_WB_B[2]);
    T_ = MatrixXd::Identity(n, n);
    T_.topLeftCorner(6, 6).setZero();
    T_.block<3, 3>(0, 3).setIdentity();
    T_.block<3, 3>(3, 0) = Rt;
    Tdot_nu_ = VectorXd::Zero(n);
    Tdot_nu_.segment<3>(3) = -w.cross(Rt * v);
    VectorXd q(n), nu(n);
    q.head<6>() = dart::dynamics::FreeJoint::convertToPositions(base);
    nu.head<6>() << w, Rt * v;
    for (Eigen::Index j = 6; j < n; ++j) {
      q(j) = s.q[static_cast<std::size_t>(j - 6)];
      nu(j) = s.qd[static_cast<std::size_t>(j - 6)];
    }
    skeleton_->setPositions(q);
    skeleton_->setVelocities(nu);
    nu_ = nu;
  }

  MatrixXd mass_matrix() const { return T_.transpose() * skeleton_->getMassMatrix() * T_; }
  VectorXd bias() const {
    return T_.transpose() *
           (skeleton_->getCoriolisAndGravityForces() + skeleton_->getMassMatrix() * Tdot_nu_);
  }
  double mass() const { return skeleton_->getMass(); }
  MatrixXd ours(const MatrixXd& J) const { return J * T_; }
  VectorXd bias_of(const MatrixXd& J, const MatrixXd& Jdot) const {
    return Jdot * nu_ + J * Tdot_nu_;
  }
  // A point given in the world now, fixed to the body that carries `site`.
  BodyNode* body_of_site(const std::string& site) const {
    return bodies_.at(m_->site_bodyid[mj_name2id(m_.get(), mjOBJ_SITE, site.c_str())]);
  }
  Vector3d site_position(const std::string& site) const {
    const int id = mj_name2id(m_.get(), mjOBJ_SITE, site.c_str());
    const double* p = m_->site_pos + 3 * id;
    return body_of_site(site)->getTransform() * Vector3d(p[0], p[1], p[2]);
  }
  Skeleton& skeleton() const { return *skeleton_; }

 private:
  void add_body(int b) {
    BodyNode::Properties body;
    body.mName = "body_" + std::to_string(b);
    BodyNode* parent = m_->body_parentid[b] > 0 ? bodies_.at(m_->body_parentid[b]) : nullptr;
    BodyNode* node = nullptr;
    if (parent == nullptr) {
      node = skeleton_->createJointAndBodyNodePair<dart::dynamics::FreeJoint>(nullptr, {}, body)
                 .second;
    } else {
      const int j = m_->body_jntadr[b];
      dart::dynamics::RevoluteJoint::Properties joint;
      joint.mName = "joint_" + std::to_string(b);
      const double* axis = m_->jnt_axis + 3 * j;
      joint.mAxis = Vector3d(axis[0], axis[1], axis[2]);
      const Isometry3d at_joint = placement(m_->jnt_pos + 3 * j, nullptr);
      joint.mT_ParentBodyToJoint =
          placement(m_->body_pos + 3 * b, m_->body_quat + 4 * b) * at_joint;
      joint.mT_ChildBodyToJoint = at_joint;
      node =
          skeleton_->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(parent, joint, body)
              .second;
    }
    const Isometry3d principal = placement(m_->body_ipos + 3 * b, m_->body_iquat + 4 * b);
    const double* d = m_->body_inertia + 3 * b;
    const Eigen::Matrix3d moment = principal.linear() * Vector3d(d[0], d[1], d[2]).asDiagonal() *
                                   principal.linear().transpose();
    node->setInertia(dart::dynamics::Inertia(m_->body_mass[b], principal.translation(), moment));
    bodies_[b] = node;
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> m_;
  dart::dynamics::SkeletonPtr skeleton_;
  std::map<int, BodyNode*> bodies_;
  MatrixXd T_;
  VectorXd Tdot_nu_, nu_;
};

class ModelAgainstDart : public testing::Test {
 protected:
  void next() {
    const model::State s = random_state(robot_, random_, {1.0, 0.6, 3.1, 5.0, 2.0, 4.0});
    model_.update(s);
    dart_.set(s);
  }
  void expect_equal(const MatrixXd& a, const MatrixXd& b) {
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), kRelative * std::max(1e-3, b.cwiseAbs().maxCoeff()));
  }
  MatrixXd jacobian(const model::Kinematics3& k) {
    return Eigen::Map<const RowMajor>(k.jacobian.data(), 3, model_.nv());
  }
  Vector3d bias(const model::Kinematics3& k) { return {k.bias[0], k.bias[1], k.bias[2]}; }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  DartTwin dart_{robot_.model_path};
  Random random_{7};
};

TEST_F(ModelAgainstDart, MassMatrixAndBiasForcesAgree) {
  EXPECT_NEAR(dart_.mass(), model_.mass(), 1e-12);
  for (int i = 0; i < 50; ++i) {
    next();
    RowMajor A(12, 12);
    model_.mass_matrix(A.data());
    expect_equal(A, dart_.mass_matrix());
    expect_equal(Eigen::Map<const VectorXd>(model_.bias().data(), 12), dart_.bias());
  }
}

TEST_F(ModelAgainstDart, ContactAndNamedPointsAgree) {
  for (int i = 0; i < 50; ++i) {
    next();
    for (int point = 0; point < model_.point_count(); ++point) {
      const auto p = static_cast<std::size_t>(point);
      const bool contact = p < robot_.contacts.size();
      const std::string& site =
          contact ? robot_.contacts[p].site : robot_.points[p - robot_.contacts.size()].site;
      BodyNode* body = dart_.body_of_site(site);
      Vector3d place = dart_.site_position(site);
      if (contact) place.z() -= robot_.contacts[p].radius;
      const Vector3d local = body->getTransform().inverse() * place;
      const auto J = dart_.skeleton().getLinearJacobian(body, local);
      const auto Jdot = dart_.skeleton().getLinearJacobianDeriv(body, local);
      const model::Kinematics3& k = model_.point(point);
      expect_equal(Vector3d(k.position[0], k.position[1], k.position[2]), place);
      expect_equal(jacobian(k), dart_.ours(J));
      expect_equal(bias(k), dart_.bias_of(J, Jdot));
    }
  }
}

TEST_F(ModelAgainstDart, CentreOfMassAndBaseRotationAgree) {
  for (int i = 0; i < 50; ++i) {
    next();
    const MatrixXd J = dart_.skeleton().getCOMLinearJacobian();
    const MatrixXd Jdot = dart_.skeleton().getCOMLinearJacobianDeriv();
    const Vector3d com = dart_.skeleton().getCOM();
    expect_equal(
        Vector3d(model_.com().position[0], model_.com().position[1], model_.com().position[2]),
        com);
    expect_equal(jacobian(model_.com()), dart_.ours(J));
    expect_equal(bias(model_.com()), dart_.bias_of(J, Jdot));
    BodyNode* torso = dart_.skeleton().getRootBodyNode();
    const MatrixXd Jw = dart_.skeleton().getAngularJacobian(torso);
    const MatrixXd Jw_dot = dart_.skeleton().getAngularJacobianDeriv(torso);
    expect_equal(jacobian(model_.base_rotation()), dart_.ours(Jw));
    expect_equal(bias(model_.base_rotation()), dart_.bias_of(Jw, Jw_dot));
  }
}

TEST_F(ModelAgainstDart, CentroidalMomentumIsTheSumOverTheLinks) {
  for (int i = 0; i < 50; ++i) {
    next();
    const Vector3d com = dart_.skeleton().getCOM();
    VectorXd sum = VectorXd::Zero(6);
    for (BodyNode* body : dart_.skeleton().getBodyNodes()) {
      const Eigen::Matrix3d R = body->getTransform().linear();
      const Eigen::Matrix3d I = R * body->getInertia().getMoment() * R.transpose();
      const Vector3d p = body->getMass() * body->getCOMLinearVelocity();
      sum.head<3>() += p;
      sum.tail<3>() += I * body->getAngularVelocity() + (body->getCOM() - com).cross(p);
    }
    expect_equal(Eigen::Map<const VectorXd>(model_.centroidal_momentum().data(), 6), sum);
  }
}

TEST_F(ModelAgainstDart, FramesOfPointsAgree) {
  for (int i = 0; i < 50; ++i) {
    next();
    for (int point = 0; point < model_.point_count(); ++point) {
      const auto p = static_cast<std::size_t>(point);
      const bool contact = p < robot_.contacts.size();
      BodyNode* body = dart_.body_of_site(contact ? robot_.contacts[p].site
                                                  : robot_.points[p - robot_.contacts.size()].site);
      const MatrixXd J = dart_.skeleton().getAngularJacobian(body);
      const MatrixXd Jdot = dart_.skeleton().getAngularJacobianDeriv(body);
      const model::FrameRotation& frame = model_.frame(point);
      // Hume's sites are not turned against their links.
      expect_equal(
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.R_WF.data()),
          body->getTransform().linear());
      expect_equal(jacobian(frame.angular), dart_.ours(J));
      expect_equal(bias(frame.angular), dart_.bias_of(J, Jdot));
    }
  }
}

// A_G = Σ I J_ω + m (c_i - c) x J_v over the links.
TEST_F(ModelAgainstDart, TheAngularMomentumMatrixIsTheSumOverTheLinks) {
  for (int i = 0; i < 50; ++i) {
    next();
    const Vector3d com = dart_.skeleton().getCOM();
    MatrixXd sum = MatrixXd::Zero(3, 12);
    for (BodyNode* body : dart_.skeleton().getBodyNodes()) {
      const Eigen::Matrix3d R = body->getTransform().linear();
      const Vector3d arm = body->getCOM() - com;
      Eigen::Matrix3d cross;
      cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
      sum += R * body->getInertia().getMoment() * R.transpose() *
             dart_.skeleton().getAngularJacobian(body);
      sum +=
          body->getMass() * cross * dart_.skeleton().getLinearJacobian(body, body->getLocalCOM());
    }
    expect_equal(jacobian(model_.angular_momentum()), dart_.ours(sum));
  }
}

}  // namespace
}  // namespace footfall::tests
