// Terminal output and keyboard input; see terminal.h.
#include "apps/tune/terminal.h"

#include <langinfo.h>
#include <unistd.h>

#include <climits>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <cwchar>
#include <stdexcept>

#include "core/process/stop_signals.h"

// Included last, because its macros have common names.
#define NCURSES_NOMACROS 1
#define NCURSES_WIDECHAR 1
#include <curses.h>

namespace footfall::apps {
namespace {

bool ctrl_c_typed = false;  // where the terminal does not make it a signal

// Colour pairs by style; 0: the terminal's default.
struct Look {
  short colour;  // -1: the terminal's default
  attr_t attributes;
};

Look look_of(Style style) {
  switch (style) {
    case Style::plain:
      return {-1, A_NORMAL};
    case Style::dim:
      return {-1, A_DIM};
    case Style::strong:
      return {-1, A_BOLD};
    case Style::title:
      return {-1, A_REVERSE | A_BOLD};
    case Style::selected:
      return {-1, A_REVERSE};
    case Style::good:
      return {COLOR_GREEN, A_NORMAL};
    case Style::warning:
      return {COLOR_YELLOW, A_BOLD};
    case Style::bad:
      return {COLOR_RED, A_BOLD};
    case Style::key:
      return {COLOR_CYAN, A_BOLD};
    case Style::curve:
      return {COLOR_CYAN, A_NORMAL};
  }
  return {-1, A_NORMAL};
}

short pair_of(Style style) { return static_cast<short>(static_cast<int>(style) + 1); }

attr_t attributes_of(Style style, bool colours) {
  const Look look = look_of(style);
  const bool coloured = colours && look.colour >= 0;
  return look.attributes | (coloured ? static_cast<attr_t>(COLOR_PAIR(pair_of(style))) : A_NORMAL);
}

void begin_colours() {
  start_color();
  use_default_colors();
  for (int k = 0; k <= static_cast<int>(Style::curve); ++k) {
    const auto style = static_cast<Style>(k);
    if (look_of(style).colour >= 0) init_pair(pair_of(style), look_of(style).colour, -1);
  }
}

std::optional<TuneKey> special_key(wint_t code) {
  switch (code) {
    case KEY_UP:
      return TuneKey{TuneKey::up, {}};
    case KEY_DOWN:
      return TuneKey{TuneKey::down, {}};
    case KEY_LEFT:
      return TuneKey{TuneKey::left, {}};
    case KEY_RIGHT:
      return TuneKey{TuneKey::right, {}};
    case KEY_PPAGE:
      return TuneKey{TuneKey::page_up, {}};
    case KEY_NPAGE:
      return TuneKey{TuneKey::page_down, {}};
    case KEY_HOME:
      return TuneKey{TuneKey::home, {}};
    case KEY_END:
      return TuneKey{TuneKey::end, {}};
    case KEY_ENTER:
      return TuneKey{TuneKey::enter, {}};
    case KEY_BACKSPACE:
      return TuneKey{TuneKey::backspace, {}};
    case KEY_RESIZE:
      return TuneKey{TuneKey::redraw, {}};
    default:
      return std::nullopt;
  }
}

std::optional<TuneKey> typed_key(wint_t code) {
  constexpr wint_t kEscape = 27, kDelete = 127, kCtrlH = 8, kCtrlL = 12, kCtrlC = 3;
  if (code == kEscape) return TuneKey{TuneKey::escape, {}};
  if (code == '\n' || code == '\r') return TuneKey{TuneKey::enter, {}};
  if (code == kDelete || code == kCtrlH) return TuneKey{TuneKey::backspace, {}};
  if (code == kCtrlL) return TuneKey{TuneKey::redraw, {}};
  if (code == kCtrlC) ctrl_c_typed = true;
  if (code < ' ') return std::nullopt;
  char bytes[MB_LEN_MAX];
  std::mbstate_t state{};
  const std::size_t length = std::wcrtomb(bytes, static_cast<wchar_t>(code), &state);
  if (length == static_cast<std::size_t>(-1)) return std::nullopt;
  return TuneKey{TuneKey::text, std::string(bytes, length)};
}

}  // namespace

TuneTerminal::TuneTerminal() {
  const char* const kind = std::getenv("TERM");
  std::setlocale(LC_CTYPE, "");
  if (std::strcmp(::nl_langinfo(CODESET), "UTF-8") != 0) unicode_ = false;
  ::setenv("ESCDELAY", "25", 0);
  // Not stdout: ncurses asks for the descriptor.
  output_.reset(::fdopen(::dup(STDOUT_FILENO), "w"));
  if (output_ == nullptr || newterm(nullptr, output_.get(), stdin) == nullptr) {
    throw std::runtime_error("the terminal '" + std::string(kind == nullptr ? "" : kind) +
                             "' (TERM) cannot be drawn on");
  }
  ctrl_c_typed = false;
  told_to_stop_ = core::stop_on_signals();
  colours_ = std::getenv("NO_COLOR") == nullptr && has_colors();
  if (colours_) begin_colours();
  cbreak();
  noecho();
  nonl();
  intrflush(stdscr, FALSE);
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
}

TuneTerminal::~TuneTerminal() { endwin(); }

int TuneTerminal::width() const { return getmaxx(stdscr); }
int TuneTerminal::height() const { return getmaxy(stdscr); }

void TuneTerminal::show(const Picture& picture) {
  erase();
  const int rows = height();
  for (int row = 0; row < rows && row < static_cast<int>(picture.lines.size()); ++row) {
    move(row, 0);
    for (const Span& span : picture.lines[static_cast<std::size_t>(row)]) {
      attrset(static_cast<int>(attributes_of(span.style, colours_)));
      addstr(span.text.c_str());
    }
  }
  attrset(A_NORMAL);
  curs_set(picture.cursor_row >= 0 ? 1 : 0);
  if (picture.cursor_row >= 0) move(picture.cursor_row, picture.cursor_column);
  refresh();
}

void TuneTerminal::forget() { clearok(stdscr, TRUE); }

std::optional<TuneKey> TuneTerminal::key() {
  for (;;) {
    wint_t code = 0;
    const int kind = get_wch(&code);
    if (kind == ERR) return std::nullopt;
    const auto key = kind == KEY_CODE_YES ? special_key(code) : typed_key(code);
    if (key) return key;
  }
}

bool TuneTerminal::is_told_to_stop() const { return ctrl_c_typed || *told_to_stop_; }

}  // namespace footfall::apps
