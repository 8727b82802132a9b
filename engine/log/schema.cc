// Schema of the log; see schema.h.
#include "engine/log/schema.h"

#include <google/protobuf/descriptor.pb.h>

namespace footfall::engine {
namespace {

using Field = google::protobuf::FieldDescriptorProto;

struct FieldRow {
  const char* message;
  const char* name;
  int number;
  Field::Type type;
  bool repeated = false;
};

// Fields of one message are contiguous, in order of their numbers.
constexpr FieldRow kFields[] = {
    {"InputBlock", "first_tick", 1, Field::TYPE_SINT64},
    {"InputBlock", "ticks", 2, Field::TYPE_UINT32},
    {"InputBlock", "continues", 3, Field::TYPE_BOOL},
    {"InputBlock", "columns", 4, Field::TYPE_BYTES},
    {"InputBlock", "digest", 5, Field::TYPE_FIXED64, true},
    {"SignalBlock", "first_tick", 1, Field::TYPE_SINT64},
    {"SignalBlock", "offset", 2, Field::TYPE_UINT32, true},
    {"SignalBlock", "continues", 3, Field::TYPE_BOOL},
    {"SignalBlock", "columns", 4, Field::TYPE_BYTES},
    {"Event", "time", 1, Field::TYPE_DOUBLE},
    {"Event", "kind", 2, Field::TYPE_STRING},
    {"Event", "name", 3, Field::TYPE_STRING},
    {"Event", "detail", 4, Field::TYPE_STRING},
    {"Event", "tick", 5, Field::TYPE_SINT64},
    {"PlanBlock", "rows", 1, Field::TYPE_UINT32},
    {"PlanBlock", "continues", 2, Field::TYPE_BOOL},
    {"PlanBlock", "columns", 3, Field::TYPE_BYTES},
    {"Edit", "tick", 1, Field::TYPE_SINT64},
    {"Edit", "slot", 2, Field::TYPE_UINT32, true},
    {"Edit", "value", 3, Field::TYPE_DOUBLE, true},
    {"Edit", "event", 4, Field::TYPE_UINT32, true},
    {"Edit", "limit_steps", 5, Field::TYPE_BOOL},
    {"Edit", "late", 6, Field::TYPE_BOOL},
    {"Edit", "requests_lost", 7, Field::TYPE_BOOL},
    {"Edit", "scripts_stuck", 8, Field::TYPE_BOOL},
    {"Parameters", "name", 1, Field::TYPE_STRING, true},
    {"Parameters", "slot", 2, Field::TYPE_UINT32, true},
    {"Parameters", "size", 3, Field::TYPE_UINT32, true},
    {"Parameters", "value", 4, Field::TYPE_DOUBLE, true},
};

}  // namespace

std::vector<std::uint8_t> log_descriptor_set() {
  google::protobuf::FileDescriptorSet set;
  google::protobuf::FileDescriptorProto& file = *set.add_file();
  file.set_name("footfall/log.proto");
  file.set_package("footfall");
  file.set_syntax("proto3");
  google::protobuf::DescriptorProto* message = nullptr;
  for (const FieldRow& row : kFields) {
    if (message == nullptr || message->name() != row.message) {
      message = file.add_message_type();
      message->set_name(row.message);
    }
    Field& field = *message->add_field();
    field.set_name(row.name);
    field.set_number(row.number);
    field.set_type(row.type);
    field.set_label(row.repeated ? Field::LABEL_REPEATED : Field::LABEL_OPTIONAL);
  }
  std::vector<std::uint8_t> bytes(set.ByteSizeLong());
  set.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace footfall::engine
