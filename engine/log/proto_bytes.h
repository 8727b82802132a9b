// Writes fields of protobuf messages in sequence to preallocated memory
// (https://protobuf.dev/programming-guides/encoding); allocates nothing.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace footfall::engine {

class ProtoBytes {
 public:
  explicit ProtoBytes(std::uint8_t* begin) noexcept : begin_(begin), at_(begin) {}

  void number(int field, std::uint64_t value) noexcept {
    tag(field, 0);
    varint(value);
  }
  void signed_number(int field, std::int64_t value) noexcept {
    number(field, static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
  }
  void real(int field, double value) noexcept {
    tag(field, 1);
    fixed(std::bit_cast<std::uint64_t>(value));
  }
  void text(int field, std::string_view value) noexcept {
    begin_text(field, value.size());
    std::memcpy(at_, value.data(), value.size());
    at_ += value.size();
  }
  void reals(int field, std::span<const double> values) noexcept {
    begin_text(field, values.size_bytes());
    for (const double value : values) fixed(std::bit_cast<std::uint64_t>(value));
  }
  // The next `size` bytes belong to the field: fixed() or varint() of a packed list, or bytes.
  void begin_text(int field, std::size_t size) noexcept {
    tag(field, 2);
    varint(size);
  }
  void fixed(std::uint64_t value) noexcept {
    std::memcpy(at_, &value, sizeof value);
    at_ += sizeof value;
  }
  void varint(std::uint64_t value) noexcept {
    for (; value >= 0x80; value >>= 7) *at_++ = static_cast<std::uint8_t>(value | 0x80);
    *at_++ = static_cast<std::uint8_t>(value);
  }
  static std::size_t varint_size(std::uint64_t value) noexcept {
    return static_cast<std::size_t>((std::bit_width(value | 1) + 6) / 7);
  }

  std::uint8_t* end() noexcept { return at_; }
  void advance(std::uint8_t* to) noexcept { at_ = to; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(at_ - begin_); }

 private:
  void tag(int field, int wire) noexcept { varint(static_cast<std::uint64_t>(field << 3 | wire)); }

  std::uint8_t* begin_;
  std::uint8_t* at_;
};

}  // namespace footfall::engine
