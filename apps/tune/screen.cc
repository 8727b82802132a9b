// `footfall tune` on a terminal: event loop for the engine, the keys and the screen.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>

#include "apps/shared/commands.h"
#include "apps/tune/model/options.h"
#include "apps/tune/save.h"
#include "apps/tune/session.h"
#include "apps/tune/terminal.h"
#include "apps/tune/view/layout.h"
#include "apps/tune/view/pages.h"

namespace footfall::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFrame = std::chrono::milliseconds(50);

struct Screen {
  TuneSession& session;
  TuneOutbox outbox;
  TuneView view;
  TuneSave save;
  std::int64_t under_way = 0;  // sequence number of the pending request; 0: none
  std::int64_t run = 0, generation = 0;
};

// The preferred signal for the plot, among those available.
std::string first_signal(const TuneModel& model) {
  for (const char* name : {"com.pos.z", "base.pos.z", "base.rpy.pitch"}) {
    if (find_signal(model, name) >= 0) return name;
  }
  return model.catalogue.signals.empty() ? std::string() : model.catalogue.signals[0];
}

void begin_run(Screen& screen) {
  const auto& told = screen.session.model.catalogue;
  if (told.session == screen.run && told.generation == screen.generation) return;
  if (screen.run != 0) {
    show_message(screen.view,
                 told.session == screen.run ? "the behavior was loaded again" : "another run began",
                 false);
  }
  screen.run = told.session;
  screen.generation = told.generation;
  screen.outbox.clear();
  screen.under_way = 0;
  read_file_values(screen.session.model);
  if (find_signal(screen.session.model, screen.view.signal) < 0) {
    screen.view.signal = first_signal(screen.session.model);
  }
}

// Receives messages and sends pending requests.
void exchange(Screen& screen) {
  TuneSession& session = screen.session;
  const auto answers = take_messages(session, 0.0);
  begin_run(screen);
  for (const footfall_lcm::answer_t& answer : answers) {
    const bool own = answer.client == session.client.client();
    if (!own || answer.sequence != screen.under_way) continue;
    screen.under_way = 0;
    screen.outbox.answered(answer);
    if (answer.accepted != 0) show_message(screen.view, answer.text, false);
  }
  for (const std::string& problem : screen.outbox.take_problems()) {
    show_message(screen.view, problem, true);
  }
  if (screen.under_way != 0 || !session.client.connected()) return;
  if (const auto request = screen.outbox.next(session.model)) {
    screen.under_way = session.client.send(*request);
  }
}

void preview_save(Screen& screen) {
  TuneModel& model = screen.session.model;
  read_file_values(model);
  std::vector<int> all(model.parameters.size());
  std::iota(all.begin(), all.end(), 0);
  screen.save = plan_tune_save(model, all, screen.view.overlay);
  std::vector<StyledLine> lines;
  for (const std::string& problem : screen.save.problems) lines.push_back({{problem, Style::bad}});
  for (const std::string& note : screen.save.plan.notes) lines.push_back({{note, Style::warning}});
  if (!screen.save.problems.empty()) {
    show_page(screen.view, "cannot be saved", std::move(lines));
  } else if (screen.save.diff.empty()) {
    show_message(screen.view, "nothing to save: every value is what the file says", false);
  } else {
    const auto diff = diff_lines(screen.save.diff);
    lines.insert(lines.end(), diff.begin(), diff.end());
    show_page(screen.view, "save: what would change", std::move(lines));
    screen.view.mode = TuneMode::confirm;
  }
}

void write_save(Screen& screen) {
  std::vector<std::string> problems;
  const auto written = write_tune_save(screen.session.model, screen.save, problems);
  show_message(screen.view,
               fmt::format("{}", fmt::join(problems.empty() ? written : problems, "; ")),
               !problems.empty());
  read_file_values(screen.session.model);
}

// Executes a command; false to quit.
bool obey(Screen& screen, TuneTerminal& terminal, TuneCommand command) {
  switch (command) {
    case TuneCommand::none:
      break;
    case TuneCommand::compare:
      read_file_values(screen.session.model);
      show_page(screen.view, "different from " + screen.session.model.catalogue.path,
                comparison(screen.session.model));
      break;
    case TuneCommand::preview_save:
      preview_save(screen);
      break;
    case TuneCommand::write:
      write_save(screen);
      break;
    case TuneCommand::redraw:
      terminal.forget();
      break;
    case TuneCommand::quit:
      return false;
  }
  return true;
}

void draw_frame(Screen& screen, TuneTerminal& terminal) {
  TuneLink link;
  link.silence = screen.session.client.silence();
  if (link.silence > 1.0) link.trouble = screen.session.client.why_not();
  link.unicode = terminal.unicode();
  terminal.show(draw(screen.session.model, screen.view, screen.outbox, link, terminal.width(),
                     terminal.height()));
}

void wait_for_anything(const TuneSession& session, Clock::duration longest) {
  std::array<pollfd, 2> files = {pollfd{STDIN_FILENO, POLLIN, 0},
                                 pollfd{session.client.file_descriptor(), POLLIN, 0}};
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(longest).count();
  ::poll(files.data(), files.size(), static_cast<int>(std::max<long>(0, left)) + 1);
}

void run_screen(Screen& screen, TuneTerminal& terminal) {
  auto next_frame = Clock::now();
  while (!terminal.is_told_to_stop()) {
    exchange(screen);
    bool pressed = false;
    while (const auto key = terminal.key()) {
      pressed = true;
      const TuneCommand command = press(screen.view, screen.session.model, screen.outbox, *key);
      if (!obey(screen, terminal, command)) return;
    }
    const auto now = Clock::now();
    if (pressed || now >= next_frame) {
      draw_frame(screen, terminal);
      next_frame = now + kFrame;
    }
    wait_for_anything(screen.session, next_frame - Clock::now());
  }
}

}  // namespace

int tune_screen(const TuneOptions& options) {
  // Checked first, so that a script gets the error without an engine.
  if (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0) {
    throw InputError(
        "error: the full screen needs a terminal; in scripts: footfall tune list, get, set ... "
        "(see "
        "footfall tune --help)\n");
  }
  const auto session = open_session(options, true);
  if (session == nullptr) return kMachineFailed;
  Screen screen{*session, {}, {}, {}};
  begin_run(screen);
  TuneTerminal terminal;
  run_screen(screen, terminal);
  return kGood;
}

}  // namespace footfall::apps
