// Reads the records of an MCAP file, complete or truncated at any byte. Every length is checked,
// because the file may be damaged.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace footfall::lab {

using Bytes = std::span<const std::uint8_t>;

// Thrown if the file, or a part of it, is malformed.
struct Damaged {};

// Reads numbers and texts from the front of a byte sequence; throws Damaged if it is too short.
class Cursor {
 public:
  explicit Cursor(Bytes bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }
  Bytes take(std::uint64_t size) {
    if (size > rest_.size()) throw Damaged{};
    const Bytes front = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(front.size());
    return front;
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string text(std::uint64_t size) {
    const Bytes bytes = take(size);
    return {bytes.begin(), bytes.end()};
  }
  std::string text() { return text(number<std::uint32_t>()); }
  std::uint64_t varint();

 private:
  Bytes rest_;
};

// One field of a protobuf message, decoded by wire type only.
struct ProtoField {
  std::uint64_t number = 0;
  std::uint64_t integer = 0;  // varint, or the bits of a fixed number
  Bytes bytes;

  double real() const;
  std::int64_t signed_integer() const;  // of a sint64
  std::string text() const { return {bytes.begin(), bytes.end()}; }
};
ProtoField next_field(Cursor& cursor);

// Receives the records of a file; each function may throw Damaged.
class McapVisitor {
 public:
  virtual ~McapVisitor() = default;
  virtual void metadata(const std::string& name, const std::string& key,
                        const std::string& value) = 0;
  virtual void attachment(const std::string& name, const std::string& media_type,
                          Bytes content) = 0;
  virtual void channel(int id, const std::string& topic) = 0;
  virtual void message(int channel, Bytes content) = 0;
};

// The content of an MCAP file. Throws std::runtime_error with one sentence that names the path if
// it is missing, unreadable, or not a log.
std::vector<std::uint8_t> load_mcap(const std::string& path);

// Visits the records in file order. True if the file is complete; false if it is truncated or
// damaged, after visiting all records before the damage.
bool visit_mcap(Bytes file, McapVisitor& visitor);

}  // namespace footfall::lab
