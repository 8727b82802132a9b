// Packs and unpacks; see input_row.h.
#include "engine/tick/input_row.h"

#include <array>
#include <bit>
#include <tuple>
#include <type_traits>

namespace footfall::engine {
namespace {

// How many entries of an array the robot has.
struct Sizes {
  std::size_t joints, contacts, markers;
  constexpr std::size_t of(std::size_t capacity) const noexcept {
    switch (capacity) {
      case core::kMaxJoints:
        return joints;
      case core::kMaxContacts:
        return contacts;
      case core::kMaxMarkers:
        return markers;
      default:
        return capacity;
    }
  }
};

// Calls visit(number) for each number of a field, in the order of its columns.
template <typename Value, typename Visit>
void visit_numbers(Value& value, const Sizes& sizes, Visit& visit) {
  if constexpr (std::is_same_v<std::remove_const_t<Value>, double>) {
    visit(value);
  } else {
    const std::size_t count = sizes.of(std::tuple_size<std::remove_const_t<Value>>::value);
    for (std::size_t k = 0; k < count; ++k) visit_numbers(value[k], sizes, visit);
  }
}

// The names of a field's columns.
template <typename Value>
void name_columns(const std::string& stem, const InputNames& of, std::vector<std::string>& names) {
  if constexpr (std::is_same_v<Value, double>) {
    names.push_back(stem);
  } else {
    constexpr std::size_t kSize = std::tuple_size_v<Value>;
    static const std::vector<std::string> xyz = {"x", "y", "z"}, wxyz = {"w", "x", "y", "z"};
    const auto& parts = kSize == core::kMaxJoints     ? of.joints
                        : kSize == core::kMaxContacts ? of.contacts
                        : kSize == core::kMaxMarkers  ? of.markers
                        : kSize == 4                  ? wxyz
                                                      : xyz;
    for (const std::string& part : parts) {
      name_columns<typename Value::value_type>(stem + "." + part, of, names);
    }
  }
}

}  // namespace

InputLayout::InputLayout(const InputNames& of)
    : joints_(of.joints.size()),
      contacts_(of.contacts.size()),
      markers_(of.markers.size()),
      estimation_(of.estimation),
      aids_(of.aids) {
  struct Range {
    std::string_view name, rate;
    int first, count;
  };
  std::vector<Range> ranges;
  const auto add = [&]<typename Owner, typename Value>(const hal::NumberField<Owner, Value>& f) {
    if (!has(f)) return;
    const int first = columns();
    name_columns<Value>(std::string(f.name), of, names_);
    ranges.push_back({f.name, f.rate, first, columns() - first});
    if (std::is_same_v<Value, std::array<double, 4>>) quaternions_.push_back(first);
  };
  hal::for_each_field(hal::kCommandFields, add);
  names_.emplace_back(kTimeColumn);
  names_.emplace_back(kFlagsColumn);
  hal::for_each_field(hal::kSensorFields, add);
  for (const Range& field : ranges) {
    for (const Range& rate : ranges) {
      if (field.rate.empty() || rate.name != field.rate) continue;
      for (int k = 0; k < field.count; ++k) {
        integrals_.emplace_back(rate.first + k, field.first + k);
      }
    }
  }
}

void InputLayout::pack(const hal::Sensors& sensors, bool fresh, const hal::Commands& commands,
                       std::uint64_t* row) const noexcept {
  const Sizes sizes{joints_, contacts_, markers_};
  const auto put = [&](const double& x) { *row++ = std::bit_cast<std::uint64_t>(x); };
  hal::for_each_field(hal::kCommandFields, [&](const auto& field) {
    visit_numbers(commands.*field.member, sizes, put);
  });
  *row++ = static_cast<std::uint64_t>(sensors.time_ns);
  std::uint64_t flags = fresh ? hal::kFreshBit : 0;
  hal::for_each_field(hal::kFlagFields, [&](const auto& field) {
    const auto& value = sensors.*field.member;
    if constexpr (std::is_same_v<decltype(value), const bool&>) {
      flags |= value ? field.bit : 0;
    } else {
      const std::size_t count = sizes.of(value.size());
      for (std::size_t k = 0; k < count; ++k) flags |= value[k] ? field.bit << k : 0;
    }
  });
  *row++ = flags;
  hal::for_each_field(hal::kSensorFields, [&](const auto& field) {
    if (has(field)) visit_numbers(sensors.*field.member, sizes, put);
  });
}

bool InputLayout::unpack(const std::uint64_t* row, hal::Sensors& sensors,
                         hal::Commands& commands) const noexcept {
  const Sizes sizes{joints_, contacts_, markers_};
  const auto take = [&](double& x) { x = std::bit_cast<double>(*row++); };
  hal::for_each_field(hal::kCommandFields, [&](const auto& field) {
    visit_numbers(commands.*field.member, sizes, take);
  });
  sensors.time_ns = static_cast<std::int64_t>(*row++);
  const std::uint64_t flags = *row++;
  hal::for_each_field(hal::kFlagFields, [&](const auto& field) {
    auto& value = sensors.*field.member;
    if constexpr (std::is_same_v<decltype(value), bool&>) {
      value = (flags & field.bit) != 0;
    } else {
      const std::size_t count = sizes.of(value.size());
      for (std::size_t k = 0; k < count; ++k) value[k] = (flags >> k & field.bit) != 0;
    }
  });
  hal::for_each_field(hal::kSensorFields, [&](const auto& field) {
    if (has(field)) visit_numbers(sensors.*field.member, sizes, take);
  });
  return (flags & hal::kFreshBit) != 0;
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
