// Reader of logs; see reader.h. engine/log/column_codec.h defines the coding of blocks.
#include "lab/log/reader.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

#include "core/index.h"
#include "core/text/json_text.h"
#include "engine/log/column_codec.h"
#include "engine/log/encoder.h"
#include "lab/log/mcap.h"

namespace footfall::lab {
namespace {

constexpr int kMaxBlockRows = 1 << 16;     // per block; far above the blocks that the writer makes
constexpr std::int64_t kKeptTicks = 8192;  // ticks whose inputs rows may refer to

std::vector<std::string> texts_of(const std::string& json) {
  const auto list = core::parse_json(json);
  if (!list.is_array()) throw Damaged{};
  std::vector<std::string> texts;
  for (const auto& item : list) {
    if (!item.is_string()) throw Damaged{};
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

template <typename Visit>
void packed(Bytes bytes, Visit&& visit) {
  for (Cursor cursor(bytes); !cursor.empty();) visit(cursor);
}

// Builds a Log from the records of a file.
class Reader final : public McapVisitor {
 public:
  Reader(Log& log, const ReadOptions& options) : log_(log), options_(options) {}

  bool described() const { return !log_.signals.empty() && topics_.contains("/signals"); }
  void finish();

  void metadata(const std::string& name, const std::string& key, const std::string& value) override;
  void attachment(const std::string& name, const std::string& media_type, Bytes content) override {
    log_.files.push_back({name, media_type, {content.begin(), content.end()}});
  }
  void channel(int id, const std::string& topic) override { topics_[topic] = id; }
  void message(int channel, Bytes content) override;

 private:
  struct Block {
    std::int64_t first_tick = 0;
    int ticks = 0;
    bool continues = false;
    std::vector<std::int64_t> offsets;
    std::vector<std::uint64_t> digest;
    Bytes columns;
  };
  void signals(const std::string& json);
  Block block(Bytes content, bool inputs) const;
  void make_codecs(int rows);
  void inputs(const Block& block);
  void rows(const Block& block);
  void row(std::int64_t tick, int k);
  void event(Bytes content);
  void plans(Bytes content);
  void edit(Bytes content);
  void parameters(Bytes content);

  Log& log_;
  ReadOptions options_;
  std::map<std::string, int> topics_;
  std::unique_ptr<engine::ColumnCodec<std::uint64_t>> input_codec_;
  engine::ColumnCodec<std::uint64_t> plan_codec_{engine::kPlanColumns, 0, engine::kMostPlans};
  std::unique_ptr<engine::ColumnCodec<std::uint32_t>> row_codec_;
  std::vector<float> recent_;              // inputs of the last ticks as floats
  std::vector<std::int64_t> recent_tick_;  // tick of each of them
};

void Reader::metadata(const std::string& name, const std::string& key, const std::string& value) {
  if (name == "run") log_.run[key] = value;
  if (name == "signals" && key == "signals") signals(value);
  if (name == "columns" && key == "columns") log_.inputs.columns = texts_of(value);
  engine::InputNames& names = log_.inputs.names;
  if (name == "columns" && key == "joints") names.joints = texts_of(value);
  if (name == "columns" && key == "contacts") names.contacts = texts_of(value);
  if (name == "columns" && key == "markers") names.markers = texts_of(value);
  if (name == "columns" && key == "estimation") names.estimation = value == "true";
  if (name == "columns" && key == "aids") names.aids = value == "true";
  if (name == "events" && key == "events") log_.event_names = texts_of(value);
  if (name != "setup") return;
  if (key == "setup") log_.setup = value;
  if (key == "rate_mhz") log_.rate_mhz = std::max(1LL, std::atoll(value.c_str()));
  if (key == "row_every") log_.row_every = std::max(1, std::atoi(value.c_str()));
}

void Reader::signals(const std::string& json) {
  log_.signals.clear();
  const auto list = core::parse_json(json);
  if (!list.is_array()) throw Damaged{};
  for (const auto& item : list) {
    if (!item.is_object()) throw Damaged{};
    const auto text = [&](const char* key) {
      const auto found = item.find(key);
      return found != item.end() && found->is_string() ? found->get<std::string>() : "";
    };
    log_.signals.push_back({text("name"), text("unit"), text("doc")});
  }
  log_.column.resize(log_.signals.size());
}

void Reader::message(int channel, Bytes content) {
  const auto is = [&](const char* topic) {
    const auto found = topics_.find(topic);
    return found != topics_.end() && found->second == channel;
  };
  if (is("/inputs")) return inputs(block(content, true));
  if (is("/signals")) return rows(block(content, false));
  if (is("/events")) return event(content);
  if (is("/plans")) return plans(content);
  if (is("/edits")) return edit(content);
  if (is("/parameters")) return parameters(content);
}

Reader::Block Reader::block(Bytes content, bool inputs) const {
  Block block;
  Cursor cursor(content);
  while (!cursor.empty()) {
    const ProtoField field = next_field(cursor);
    if (field.number == 1) block.first_tick = field.signed_integer();
    if (field.number == 2 && inputs) {
      if (field.integer > kMaxBlockRows) throw Damaged{};
      block.ticks = static_cast<int>(field.integer);
    }
    if (field.number == 2 && !inputs) {
      packed(field.bytes, [&](Cursor& list) {
        block.offsets.push_back(static_cast<std::int64_t>(list.varint() & 0xFFFFFFFFU));
      });
    }
    if (field.number == 3) block.continues = field.integer != 0;
    if (field.number == 4) block.columns = field.bytes;
    if (field.number == 5) {
      packed(field.bytes,
             [&](Cursor& list) { block.digest.push_back(list.number<std::uint64_t>()); });
    }
  }
  if (!inputs)
    block.ticks = static_cast<int>(std::min<std::size_t>(block.offsets.size(), kMaxBlockRows));
  return block;
}

// All blocks but the last have the length of the first.
void Reader::make_codecs(int rows) {
  if (input_codec_ && input_codec_->max_rows() >= rows) return;
  // Allocate for the longest block at once: a codec keeps state from the previous block.
  const int most =
      std::max(rows, static_cast<int>(std::min<std::int64_t>(kMaxBlockRows, log_.rate_mhz / 1000)));
  const auto columns = static_cast<int>(log_.inputs.columns.size());
  const auto all = columns + static_cast<int>(log_.signals.size());
  input_codec_ = std::make_unique<engine::ColumnCodec<std::uint64_t>>(
      columns, 0, most, 1e3 / static_cast<double>(log_.rate_mhz));
  row_codec_ = std::make_unique<engine::ColumnCodec<std::uint32_t>>(all, columns, most);
  recent_.assign(at(kKeptTicks) * at(columns), 0.0F);
  recent_tick_.assign(at(kKeptTicks), -2);
}

void Reader::inputs(const Block& block) {
  make_codecs(block.ticks);
  if (block.digest.size() != at(block.ticks) || block.first_tick < -1) throw Damaged{};
  if (!input_codec_->decode(block.columns, block.ticks, block.continues)) throw Damaged{};
  LoggedInputs& inputs = log_.inputs;
  const auto columns = static_cast<int>(inputs.columns.size());
  for (int k = 0; k < block.ticks; ++k) {
    const std::int64_t tick = block.first_tick + k;
    const auto slot = at((tick + kKeptTicks) % kKeptTicks);
    recent_tick_[slot] = tick;
    for (int c = 0; c < columns; ++c) {
      recent_[slot * at(columns) + at(c)] =
          static_cast<float>(std::bit_cast<double>(input_codec_->column(c)[k]));
    }
  }
  if (!options_.inputs) return;
  if (inputs.digest.empty()) inputs.first_tick = block.first_tick;
  if (inputs.first_tick + inputs.ticks() != block.first_tick) {
    inputs.after_gap += block.ticks;
    return;
  }
  for (int k = 0; k < block.ticks; ++k) {
    for (int c = 0; c < columns; ++c) inputs.words.push_back(input_codec_->column(c)[k]);
  }
  inputs.digest.insert(inputs.digest.end(), block.digest.begin(), block.digest.end());
}

void Reader::rows(const Block& block) {
  make_codecs(block.ticks);
  const auto columns = static_cast<int>(log_.inputs.columns.size());
  for (int k = 0; k < block.ticks; ++k) {
    const std::int64_t tick = block.first_tick + block.offsets[at(k)];
    const auto slot = at((tick + kKeptTicks) % kKeptTicks);
    if (tick < 0 || recent_tick_[slot] != tick) throw Damaged{};
    for (int c = 0; c < columns; ++c) {
      row_codec_->column(c)[k] = std::bit_cast<std::uint32_t>(recent_[slot * at(columns) + at(c)]);
    }
  }
  if (!row_codec_->decode(block.columns, block.ticks, block.continues)) throw Damaged{};
  for (int k = 0; k < block.ticks; ++k) {
    const std::int64_t tick = block.first_tick + block.offsets[at(k)];
    if (options_.all_rows || tick % log_.row_every == 0) row(tick, k);
  }
}

void Reader::row(std::int64_t tick, int k) {
  const auto inputs = static_cast<int>(log_.inputs.columns.size());
  log_.tick.push_back(tick);
  // As tick times are computed: in whole nanoseconds.
  log_.time.push_back(static_cast<double>(tick * 1'000'000'000'000LL / log_.rate_mhz) * 1e-9);
  for (std::size_t s = 0; s < log_.column.size(); ++s) {
    log_.column[s].push_back(
        std::bit_cast<float>(row_codec_->column(inputs + static_cast<int>(s))[k]));
  }
}

void Reader::event(Bytes content) {
  LoggedEvent event;
  for (Cursor cursor(content); !cursor.empty();) {
    const ProtoField field = next_field(cursor);
    if (field.number == 1) event.time = field.real();
    if (field.number == 2) event.kind = field.text();
    if (field.number == 3) event.name = field.text();
    if (field.number == 4) event.detail = field.text();
    if (field.number == 5) event.tick = field.signed_integer();
  }
  log_.events.push_back(std::move(event));
}

void Reader::plans(Bytes content) {
  std::uint64_t rows = 0;
  bool continues = false;
  Bytes columns;
  for (Cursor cursor(content); !cursor.empty();) {
    const ProtoField field = next_field(cursor);
    if (field.number == 1) rows = field.integer;
    if (field.number == 2) continues = field.integer != 0;
    if (field.number == 3) columns = field.bytes;
  }
  if (rows > engine::kMostPlans) throw Damaged{};
  if (!plan_codec_.decode(columns, static_cast<int>(rows), continues)) throw Damaged{};
  for (int k = 0; k < static_cast<int>(rows); ++k) {
    int c = 0;
    const auto word = [&] { return plan_codec_.column(c++)[k]; };
    const auto real = [&] { return std::bit_cast<double>(word()); };
    LoggedPlan plan;
    plan.tick = static_cast<std::int64_t>(word());
    plan.planner = static_cast<int>(word());
    plan.sequence = static_cast<std::uint32_t>(word());
    plan.ok = word() != 0;
    for (double& x : plan.target) x = real();
    for (double& x : plan.predicted_pos) x = real();
    for (double& x : plan.predicted_vel) x = real();
    plan.extension = real();
    log_.plans.push_back(plan);
  }
}

void Reader::edit(Bytes content) {
  LoggedEdit edit;
  std::vector<double> values;
  for (Cursor cursor(content); !cursor.empty();) {
    const ProtoField field = next_field(cursor);
    if (field.number == 1) edit.tick = field.signed_integer();
    if (field.number == 2) edit.writes.emplace_back(static_cast<int>(field.integer), 0.0);
    if (field.number == 3) {
      packed(field.bytes, [&](Cursor& list) { values.push_back(list.number<double>()); });
    }
    if (field.number == 4) edit.events.push_back(static_cast<int>(field.integer));
    if (field.number == 5) edit.limit_steps = field.integer != 0;
    if (field.number == 6) edit.late = field.integer != 0;
    if (field.number == 7) edit.requests_lost = field.integer != 0;
    if (field.number == 8) edit.scripts_stuck = field.integer != 0;
  }
  if (values.size() != edit.writes.size()) throw Damaged{};
  for (std::size_t k = 0; k < values.size(); ++k) edit.writes[k].second = values[k];
  log_.edits.push_back(std::move(edit));
}

void Reader::parameters(Bytes content) {
  std::vector<std::string> names;
  std::vector<int> slots, sizes;
  for (Cursor cursor(content); !cursor.empty();) {
    const ProtoField field = next_field(cursor);
    if (field.number == 1) names.push_back(field.text());
    if (field.number == 2) slots.push_back(static_cast<int>(field.integer));
    if (field.number == 3) sizes.push_back(static_cast<int>(field.integer));
    if (field.number == 4) {
      packed(field.bytes,
             [&](Cursor& list) { log_.parameter_values.push_back(list.number<double>()); });
    }
  }
  if (slots.size() != names.size() || sizes.size() != names.size()) throw Damaged{};
  const auto count = static_cast<std::int64_t>(log_.parameter_values.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (slots[i] < 0 || sizes[i] < 0 || slots[i] + std::int64_t{sizes[i]} > count) throw Damaged{};
    log_.parameters.push_back({names[i], slots[i], sizes[i]});
  }
}

// Rows before a transition were written late, after rows of a later time: sort them.
void Reader::finish() {
  for (auto& column : log_.column) column.resize(log_.rows());
  log_.tick.resize(log_.rows());
  if (std::ranges::is_sorted(log_.tick)) return;
  std::vector<std::size_t> order(log_.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t row) { return log_.tick[row]; });
  const auto arrange = [&](auto& list) {
    auto sorted = list;
    for (std::size_t row = 0; row < order.size(); ++row) sorted[row] = list[order[row]];
    list = std::move(sorted);
  };
  arrange(log_.tick);
  arrange(log_.time);
  for (auto& column : log_.column) arrange(column);
}

}  // namespace

int Log::find(std::string_view name) const {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<std::string> parts(const Log& log, std::string_view prefix, std::string_view suffix) {
  std::vector<std::string> names;
  for (const LoggedSignal& signal : log.signals) {
    const std::string_view name = signal.name;
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix)) {
      continue;
    }
    const std::string part(name.substr(prefix.size(), name.size() - prefix.size() - suffix.size()));
    if (std::ranges::find(names, part) == names.end()) names.push_back(part);
  }
  return names;
}

const std::vector<float>* Log::values(std::string_view name) const {
  const int index = find(name);
  return index < 0 ? nullptr : &column[static_cast<std::size_t>(index)];
}

std::string Log::get(const std::string& key, const std::string& otherwise) const {
  const auto found = run.find(key);
  return found == run.end() ? otherwise : found->second;
}

Log read_log(const std::string& path, const ReadOptions& options) {
  const std::vector<std::uint8_t> bytes = load_mcap(path);
  Log log;
  log.path = path;
  Reader reader(log, options);
  log.complete = visit_mcap(bytes, reader);
  reader.finish();
  if (!reader.described()) {
    throw std::runtime_error("the log '" + path +
                             "' has no signals: it is damaged, cut off at its start, or not ours");
  }
  return log;
}

}  // namespace footfall::lab
