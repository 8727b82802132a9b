// Packs and unpacks; see inputs.h.
#include "engine/tick/inputs.h"

#include <array>
#include <bit>
#include <cstring>

namespace footfall::engine {
namespace {

// Calls visit(double&) for every number of a tick in the order of the columns behind the integers.
template <typename Sensors, typename Visit>
void visit_numbers(Sensors& s, std::size_t joints, std::size_t contacts, Visit&& visit) {
  for (std::size_t j = 0; j < joints; ++j) visit(s.qd[j]);
  for (std::size_t j = 0; j < joints; ++j) visit(s.q[j]);
  for (std::size_t j = 0; j < joints; ++j) visit(s.tau[j]);
  for (auto& x : s.gyro) visit(x);
  for (auto& x : s.accelerometer) visit(x);
  for (std::size_t c = 0; c < contacts; ++c) {
    for (auto& x : s.force[c]) visit(x);
  }
  for (auto& x : s.v_WB) visit(x);
  for (auto& x : s.p_WB) visit(x);
  for (auto& x : s.q_WB) visit(x);
  for (auto& x : s.w_WB_B) visit(x);
}

}  // namespace

InputLayout::InputLayout(const std::vector<std::string>& joints,
                         const std::vector<std::string>& contacts)
    : joints_(joints.size()), contacts_(contacts.size()) {
  const auto add = [&](const std::string& stem, const std::vector<std::string>& names) {
    for (const std::string& name : names) names_.push_back(stem + name);
  };
  const std::vector<std::string> xyz = {"x", "y", "z"};
  add("command.", joints);
  add("", {"time_ns", "flags"});
  add("qd.", joints);
  add("q.", joints);
  add("tau.", joints);
  add("gyro.", xyz);
  add("accelerometer.", xyz);
  for (const std::string& contact : contacts) add("force." + contact + ".", xyz);
  add("v_WB.", xyz);
  add("p_WB.", xyz);
  add("q_WB.", {"w", "x", "y", "z"});
  add("w_WB_B.", xyz);
}

std::vector<std::pair<int, int>> InputLayout::integrals() const {
  const auto joints = static_cast<int>(joints_);
  const int qd = joints + 2;
  const int v = qd + 3 * joints + 6 + 3 * static_cast<int>(contacts_);
  std::vector<std::pair<int, int>> pairs;
  for (int j = 0; j < joints; ++j) pairs.emplace_back(qd + j, qd + joints + j);
  for (int k = 0; k < 3; ++k) pairs.emplace_back(v + k, v + 3 + k);
  return pairs;
}

void InputLayout::pack(const hal::Sensors& sensors, bool fresh, const hal::Commands& commands,
                       std::uint64_t* row) const noexcept {
  std::memcpy(row, commands.tau.data(), joints_ * sizeof(double));
  row += joints_;
  *row++ = static_cast<std::uint64_t>(sensors.time_ns);
  std::uint64_t flags =
      (fresh ? kFresh : 0) | (sensors.has_truth ? kTruth : 0) |
      (sensors.body_contact ? kBodyContact : 0) | (sensors.backend_fault ? kBackendFault : 0) |
      (sensors.imu_fresh ? kImuFresh : 0) | (sensors.mocap_fresh ? kMocapFresh : 0);
  for (std::size_t c = 0; c < contacts_; ++c) flags |= sensors.contact[c] ? kContact << c : 0;
  *row++ = flags;
  visit_numbers(sensors, joints_, contacts_,
                [&](const double& x) { *row++ = std::bit_cast<std::uint64_t>(x); });
}

bool InputLayout::unpack(const std::uint64_t* row, hal::Sensors& sensors,
                         hal::Commands& commands) const noexcept {
  std::memcpy(commands.tau.data(), row, joints_ * sizeof(double));
  row += joints_;
  sensors.time_ns = static_cast<std::int64_t>(*row++);
  const std::uint64_t flags = *row++;
  sensors.has_truth = (flags & kTruth) != 0;
  sensors.body_contact = (flags & kBodyContact) != 0;
  sensors.backend_fault = (flags & kBackendFault) != 0;
  sensors.imu_fresh = (flags & kImuFresh) != 0;
  sensors.mocap_fresh = (flags & kMocapFresh) != 0;
  for (std::size_t c = 0; c < contacts_; ++c) sensors.contact[c] = (flags >> c & kContact) != 0;
  visit_numbers(sensors, joints_, contacts_, [&](double& x) { x = std::bit_cast<double>(*row++); });
  return (flags & kFresh) != 0;
}

// Four lanes, since a multiplication waits for the one before it.
std::uint64_t digest(const double* values, int count) noexcept {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;  // 2^64 / golden ratio
  std::array<std::uint64_t, 4> lanes = {1, 2, 3, 4};
  const auto mix = [](std::uint64_t& lane, double value) {
    lane = (lane ^ std::bit_cast<std::uint64_t>(value)) * kOdd;
    lane ^= lane >> 29;
  };
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    for (int l = 0; l < 4; ++l) mix(lanes[static_cast<std::size_t>(l)], values[i + l]);
  }
  for (; i < count; ++i) mix(lanes[0], values[i]);
  std::uint64_t all = 0;
  for (const std::uint64_t lane : lanes) all = (std::rotl(all, 17) ^ lane) * kOdd;
  return all;
}

}  // namespace footfall::engine
