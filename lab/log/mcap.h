// Reads the records of an MCAP file, whole or cut off at any byte. Every length is checked: a file
// may be damaged.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace footfall::lab {

using Bytes = std::span<const std::uint8_t>;

// The file, or a part of it, is not what it says.
struct Damaged {};

// Takes numbers and texts from the front of some bytes; Damaged when they end too early.
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

// One field of a protobuf message: what its wire type gives.
struct ProtoField {
  std::uint64_t number = 0;
  std::uint64_t integer = 0;  // varint, or the bits of a fixed number
  Bytes bytes;

  double real() const;
  std::int64_t signed_integer() const;  // of a sint64
  std::string text() const { return {bytes.begin(), bytes.end()}; }
};
ProtoField next_field(Cursor& cursor);

// What a file's records are told to; each may throw Damaged.
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

// The bytes of a file that begins as an MCAP file does. Throws std::runtime_error with one sentence
// that names the path: missing, unreadable, not a log.
std::vector<std::uint8_t> load_mcap(const std::string& path);

// Visits the records in the file's order. True: the file has its proper end; false: it is cut off
// or damaged, and what came before that was visited.
bool visit_mcap(Bytes file, McapVisitor& visitor);

}  // namespace footfall::lab
