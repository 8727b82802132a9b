// Transfers data from the tick to the logger's thread; see writer.h.
#include "engine/log/writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <thread>

#include "core/index.h"
#include "engine/log/encoder.h"
#include "engine/log/proto_bytes.h"

namespace footfall::engine {
namespace {

constexpr std::size_t kMaxText = 4096;
constexpr std::size_t kMessageBytes = 256 * 1024;  // per batch
constexpr std::size_t kLongestMessage = 3 * (kMaxText + 4) + 64;
constexpr double kBatchTime = 0.05;  // s; a kill loses at most two batches
constexpr std::uint32_t kBatches = 2;
// Polling period of the thread. A wake-up would cost the tick more than the copy of a tick does. In
// lock-step a batch fills in one or two milliseconds.
constexpr std::chrono::microseconds kLookAgain{1000}, kLookAgainInLockstep{200};

using Clock = std::chrono::steady_clock;

// Truncates to kMaxText bytes at a UTF-8 character boundary.
std::string_view cut(std::string_view text) noexcept {
  if (text.size() <= kMaxText) return text;
  std::size_t end = kMaxText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end);
}

// Prefetches memory that the next tick will write: it is in the cache of the core that runs the
// logger's thread, and cache misses would be most of the log's cost in a tick.
void fetch_to_write(const void* begin, std::size_t bytes) noexcept {
  constexpr std::size_t kLine = 64;
  const char* at = static_cast<const char*>(begin);
  for (std::size_t offset = 0; offset < bytes; offset += kLine) __builtin_prefetch(at + offset, 1);
}

int batch_ticks(std::int64_t rate_mhz) {
  return std::max(1, static_cast<int>(kBatchTime * static_cast<double>(rate_mhz) / 1e3));
}

}  // namespace

// Two alternating batches: the tick fills one while the thread writes the other.
struct LogWriter::Impl {
  Impl(const std::string& path, const core::SignalTable& table, const LogHeader& header)
      : most_ticks(batch_ticks(header.rate_mhz)),
        signals(at(table.size())),
        lockstep(header.lockstep),
        encoder(path, table, header, most_ticks) {
    for (LogBatch& batch : batches) {
      batch.inputs.resize(at(most_ticks) * at(encoder.layout().columns()));
      batch.signals.resize(at(most_ticks) * signals);
      batch.highlight.resize(at(most_ticks));
      batch.plan_rows.resize(at(kMostPlans * kPlanColumns));
      batch.messages.resize(kMessageBytes);
    }
    thread = std::thread([this] { work(); });
  }

  LogBatch& filling() noexcept {
    return batches[filled.load(std::memory_order_relaxed) % kBatches];
  }
  bool room() noexcept;
  void hand_over() noexcept;
  std::uint8_t* message(std::size_t most) noexcept;
  void finish_message(LogChannel channel, std::int64_t tick, std::uint8_t* end) noexcept;
  void write_event(std::int64_t tick, std::string_view kind, std::string_view name,
                   std::string_view detail) noexcept;
  void work() noexcept;
  void stop() noexcept;

  const int most_ticks;
  const std::size_t signals;
  const bool lockstep;
  LogEncoder encoder;
  std::array<LogBatch, kBatches> batches;
  // Counts of batches: written <= filled <= written + kBatches; the current batch is `filled`.
  std::atomic<std::uint32_t> filled{0}, written{0};
  std::atomic<bool> ending{false};
  std::int64_t dropped = 0;   // ticks dropped since the queue became full
  std::int64_t lost = 0;      // in all
  Clock::time_point started;  // start of the current batch
  std::thread thread;
};

// Whether a batch is free; in lock-step waits until one is.
bool LogWriter::Impl::room() noexcept {
  const std::uint32_t mine = filled.load(std::memory_order_relaxed);
  for (auto done = written.load(std::memory_order_acquire); mine - done >= kBatches;
       done = written.load(std::memory_order_acquire)) {
    if (!lockstep) return false;
    written.wait(done);
  }
  return true;
}

void LogWriter::Impl::hand_over() noexcept {
  const LogBatch& batch = filling();
  if (batch.ticks == 0 && batch.plans == 0 && batch.message_bytes == 0) return;
  filled.fetch_add(1, std::memory_order_release);
}

void LogWriter::Impl::work() noexcept {
  for (std::uint32_t number = 0;; ++number) {
    while (filled.load(std::memory_order_acquire) == number) {
      std::this_thread::sleep_for(lockstep ? kLookAgainInLockstep : kLookAgain);
    }
    if (ending.load()) return;  // everything is written, because stop() waits for it
    LogBatch& batch = batches[number % kBatches];
    encoder.write(batch);
    batch.ticks = batch.plans = 0;
    batch.message_bytes = 0;
    written.store(number + 1, std::memory_order_release);
    written.notify_all();
  }
}

void LogWriter::Impl::stop() noexcept {
  if (!thread.joinable()) return;
  const std::uint32_t mine = filled.load();
  for (auto done = written.load(); done != mine; done = written.load()) written.wait(done);
  ending.store(true);
  filled.fetch_add(1);
  thread.join();
}

std::uint8_t* LogWriter::Impl::message(std::size_t most) noexcept {
  if (!room()) return nullptr;
  const std::size_t need = sizeof(LogBatch::MessageHead) + most;
  if (filling().message_bytes + need > kMessageBytes) {
    hand_over();
    if (!room()) return nullptr;
  }
  LogBatch& batch = filling();
  return batch.messages.data() + batch.message_bytes + sizeof(LogBatch::MessageHead);
}

void LogWriter::Impl::finish_message(LogChannel channel, std::int64_t tick,
                                     std::uint8_t* end) noexcept {
  LogBatch& batch = filling();
  std::uint8_t* begin = batch.messages.data() + batch.message_bytes;
  const auto size = static_cast<std::size_t>(end - begin);
  const LogBatch::MessageHead head{encoder.time_ns(tick),
                                   static_cast<std::uint32_t>(size - sizeof(LogBatch::MessageHead)),
                                   channel};
  std::memcpy(begin, &head, sizeof head);
  batch.message_bytes += size;
}

void LogWriter::Impl::write_event(std::int64_t tick, std::string_view kind, std::string_view name,
                                  std::string_view detail) noexcept {
  std::uint8_t* to = message(kLongestMessage);
  if (to == nullptr) return;
  ProtoBytes proto(to);
  proto.real(1, static_cast<double>(encoder.time_ns(tick)) * 1e-9);
  proto.text(2, cut(kind));
  proto.text(3, cut(name));
  proto.text(4, cut(detail));
  proto.signed_number(5, tick);
  finish_message(LogChannel::events, tick, proto.end());
}

LogWriter::LogWriter(const std::string& path, const core::SignalTable& table,
                     const LogHeader& header)
    : impl_(std::make_unique<Impl>(path, table, header)) {}

LogWriter::~LogWriter() {
  try {
    close();
  } catch (const std::exception&) {
    // Errors are only reported by an explicit close().
  }
}

void LogWriter::tick(std::int64_t tick, const hal::Sensors& sensors, bool fresh,
                     const hal::Commands& commands, const double* signals,
                     bool highlight) noexcept {
  Impl& m = *impl_;
  if (!m.room()) {
    ++m.dropped;
    ++m.lost;
    return;
  }
  if (m.dropped > 0) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%lld ticks", static_cast<long long>(m.dropped));
    m.write_event(tick, "gap", text.data(), "");
    m.dropped = 0;
  }
  if (m.filling().ticks > 0 && m.filling().first_tick + m.filling().ticks != tick) {
    m.hand_over();
    if (!m.room()) {
      ++m.dropped;
      ++m.lost;
      return;
    }
  }
  LogBatch& batch = m.filling();
  if (batch.ticks == 0) {
    batch.first_tick = tick;
    if (!m.lockstep) m.started = Clock::now();
  }
  const auto row = at(batch.ticks++);
  const InputLayout& layout = m.encoder.layout();
  const std::size_t columns = at(layout.columns());
  std::uint64_t* const inputs = batch.inputs.data() + row * columns;
  double* const copies = batch.signals.data() + row * m.signals;
  layout.pack(sensors, fresh, commands, inputs);
  std::memcpy(copies, signals, m.signals * sizeof(double));
  if (batch.ticks < m.most_ticks) {
    fetch_to_write(inputs + columns, columns * sizeof *inputs);
    fetch_to_write(copies + m.signals, m.signals * sizeof *copies);
  }
  batch.highlight[row] = highlight ? 1 : 0;
  const bool late =
      !m.lockstep && Clock::now() - m.started > std::chrono::duration<double>(kBatchTime);
  if (batch.ticks == m.most_ticks || late) m.hand_over();
}

void LogWriter::inputs(std::int64_t tick, const InputTrace& trace) noexcept {
  Impl& m = *impl_;
  for (const behaviors::PlanAnswer& plan : trace.plans) {
    if (!m.room()) return;
    if (m.filling().plans == kMostPlans) m.hand_over();
    if (!m.room()) return;
    LogBatch& batch = m.filling();
    std::uint64_t* row = batch.plan_rows.data() + at(batch.plans++ * kPlanColumns);
    *row++ = static_cast<std::uint64_t>(tick);
    *row++ = static_cast<std::uint64_t>(plan.planner);
    *row++ = plan.sequence;
    *row++ = plan.ok ? 1 : 0;
    const auto put = [&](double value) { *row++ = std::bit_cast<std::uint64_t>(value); };
    std::ranges::for_each(plan.target, put);
    std::ranges::for_each(plan.predicted_pos, put);
    std::ranges::for_each(plan.predicted_vel, put);
    put(plan.extension);
  }
  const bool flags = trace.limit_steps || trace.late || trace.requests_lost || trace.scripts_stuck;
  if (trace.writes.empty() && trace.events.empty() && !flags) return;
  constexpr std::size_t kWrites = 256;  // of one message
  for (std::size_t from = 0; from == 0 || from < trace.writes.size(); from += kWrites) {
    const std::size_t count = std::min(kWrites, trace.writes.size() - from);
    std::uint8_t* to = m.message(kLongestMessage);
    if (to == nullptr) return;
    ProtoBytes proto(to);
    proto.signed_number(1, tick);
    for (std::size_t k = from; k < from + count; ++k) {
      proto.number(2, static_cast<unsigned>(trace.writes[k].slot));
    }
    proto.begin_text(3, count * sizeof(double));
    for (std::size_t k = from; k < from + count; ++k) {
      proto.fixed(std::bit_cast<std::uint64_t>(trace.writes[k].value));
    }
    if (from == 0) {
      for (const int event : trace.events) proto.number(4, static_cast<unsigned>(event));
      if (trace.limit_steps) proto.number(5, 1);
      if (trace.late) proto.number(6, 1);
      if (trace.requests_lost) proto.number(7, 1);
      if (trace.scripts_stuck) proto.number(8, 1);
    }
    m.finish_message(LogChannel::edits, tick, proto.end());
  }
}

void LogWriter::event(std::int64_t tick, std::string_view kind, std::string_view name,
                      std::string_view detail) noexcept {
  impl_->write_event(tick, kind, name, detail);
}

void LogWriter::close() {
  if (impl_->thread.joinable()) {
    impl_->hand_over();
    impl_->stop();
  }
  impl_->encoder.close();
}

std::int64_t LogWriter::lost() const noexcept { return impl_->lost; }

bool LogWriter::failed() const noexcept { return impl_->encoder.failed(); }

}  // namespace footfall::engine
