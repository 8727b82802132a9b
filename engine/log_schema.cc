// Schema of the log; see log_schema.h.
#include "engine/log_schema.h"

#include <cctype>
#include <stdexcept>
#include <string_view>
#include <unordered_set>

#include "core/units.h"

namespace footfall::engine {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Numbers from google/protobuf/descriptor.proto.
constexpr int kLengthDelimited = 2;
constexpr int kTypeDouble = 1, kTypeFloat = 2, kTypeString = 9;
constexpr int kLabelOptional = 1;
constexpr int kMaxFields = 18'999;  // 19000 to 19999 are reserved by protobuf

void put_text(Bytes& out, int field, std::string_view text) {
  put_varint(out, static_cast<std::uint64_t>(field << 3 | kLengthDelimited));
  put_varint(out, text.size());
  out.insert(out.end(), text.begin(), text.end());
}

void put_message(Bytes& out, int field, const Bytes& message) {
  put_text(out, field, {reinterpret_cast<const char*>(message.data()), message.size()});
}

void put_number(Bytes& out, int field, int value) {
  put_varint(out, static_cast<std::uint64_t>(field << 3));
  put_varint(out, static_cast<std::uint64_t>(value));
}

// FieldDescriptorProto: name 1, number 3, label 4, type 5.
Bytes field_descriptor(std::string_view name, int number, int type) {
  Bytes field;
  put_text(field, 1, name);
  put_number(field, 3, number);
  put_number(field, 4, kLabelOptional);
  put_number(field, 5, type);
  return field;
}

// FileDescriptorSet: file 1; FileDescriptorProto: name 1, package 2, message_type 4, syntax 12.
Bytes descriptor_set(std::string_view file_name, const Bytes& message) {
  Bytes file;
  put_text(file, 1, file_name);
  put_text(file, 2, "footfall");
  put_message(file, 4, message);
  put_text(file, 12, "proto3");
  Bytes set;
  put_message(set, 1, file);
  return set;
}

// What the name becomes in JSON, roughly: two fields may not differ in `_` and case only.
std::string collision_key(std::string_view name) {
  std::string key;
  for (const char c : name) {
    if (c != '_') key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return key;
}

}  // namespace

void put_varint(Bytes& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
  out.push_back(static_cast<std::uint8_t>(value));
}

bool is_double(const core::SignalInfo& info) { return info.dimension == core::kTime; }

std::vector<std::string> field_names(const core::SignalTable& table) {
  std::vector<std::string> names;
  std::unordered_set<std::string> taken;
  for (const core::SignalInfo& info : table.infos()) {
    std::string name;
    for (const char c : info.name) {
      const bool plain = c < 0x7F && (std::isalnum(static_cast<unsigned char>(c)) != 0);
      name += plain ? c : '_';
    }
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0) name = "s_" + name;
    const std::string stem = name;
    for (int k = 2; !taken.insert(collision_key(name)).second; ++k) {
      name = stem + "_" + std::to_string(k);
    }
    names.push_back(name);
  }
  return names;
}

Bytes signals_descriptor(const core::SignalTable& table) {
  if (table.size() > kMaxFields) throw std::runtime_error("a log holds at most 18999 signals");
  const std::vector<std::string> names = field_names(table);
  Bytes message;  // DescriptorProto: name 1, field 2
  put_text(message, 1, "Signals");
  for (int i = 0; i < table.size(); ++i) {
    const int type = is_double(table.info(i)) ? kTypeDouble : kTypeFloat;
    put_message(message, 2, field_descriptor(names[static_cast<std::size_t>(i)], i + 1, type));
  }
  return descriptor_set("footfall/signals.proto", message);
}

Bytes event_descriptor() {
  Bytes message;
  put_text(message, 1, "Event");
  put_message(message, 2, field_descriptor("time", 1, kTypeDouble));
  put_message(message, 2, field_descriptor("kind", 2, kTypeString));
  put_message(message, 2, field_descriptor("name", 3, kTypeString));
  put_message(message, 2, field_descriptor("detail", 4, kTypeString));
  return descriptor_set("footfall/event.proto", message);
}

}  // namespace footfall::engine
