// Compile-time checks of the tables in sensor_fields.h; they are slow, so one file makes them.
#include "hal/sensor_fields.h"

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace footfall::hal {
namespace {

struct Anything {
  template <typename T>
  constexpr operator T() const;  // NOLINT: stands for the initial value of any member
};
template <typename T, std::size_t... k>
constexpr bool has_members(std::index_sequence<k...>) {
  return requires { T{(static_cast<void>(k), Anything{})...}; };
}
template <typename T, std::size_t n = 64>
constexpr std::size_t member_count() {
  if constexpr (n == 0 || has_members<T>(std::make_index_sequence<n>())) {
    return n;
  } else {
    return member_count<T, n - 1>();
  }
}
template <typename... Table>
inline constexpr std::size_t kRowCount = (std::tuple_size_v<std::remove_cvref_t<Table>> + ...);

}  // namespace

static_assert(member_count<Sensors>() ==
                  1 + kRowCount<decltype(kSensorFields), decltype(kFlagFields)>,
              "each member of Sensors but time_ns has one row in a table of sensor_fields.h");
static_assert(member_count<Commands>() == kRowCount<decltype(kCommandFields)>,
              "each member of Commands has one row in the table of sensor_fields.h");
static_assert(core::kMaxJoints != core::kMaxContacts && core::kMaxJoints != core::kMaxMarkers &&
                  core::kMaxContacts != core::kMaxMarkers,
              "arrays by joint, by contact and by marker differ in length");

}  // namespace footfall::hal
