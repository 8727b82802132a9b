// Collects load-time problems and prints them like a compiler; see diagnostics.h.
#include "core/diagnostics/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/text/look_alike.h"
#include "core/text/printable.h"

namespace footfall::core {

namespace {

// A quoted word that looks right is wrong for a reader until the character is named that only looks
// like the one to be typed.
std::string with_look_alike(std::string text) {
  if (text.find("U+") == std::string::npos) text += look_alike_hint(text);
  return text;
}

}  // namespace

int Diagnostics::add_file(const std::string& path) {
  const auto found = std::find(files_.begin(), files_.end(), path);
  if (found != files_.end()) return static_cast<int>(found - files_.begin());
  files_.push_back(path);
  return static_cast<int>(files_.size()) - 1;
}

bool Diagnostics::is_new(Mark mark, std::string_view id, const std::string& text) {
  if (silent_.contains({mark.file, mark.line, mark.column})) return false;
  return said_.insert(fmt::format("{} {} {} {} {}", mark.file, mark.line, mark.column, id, text))
      .second;
}

// Moves an error to its cause, where it says where it was found; false if there is one already.
bool Diagnostics::move_to_cause(Mark& mark, std::string& text) {
  const Place cause = mark.cause;
  if (cause.file < 0) return true;
  const Place found = mark.place();
  if (silent_.contains({found.file, found.line, found.column})) return false;
  if (!causes_.insert({cause.file, cause.line, cause.column}).second) return false;
  // A value that stands here as a whole has its own place already, or one within it.
  const bool own = found.file == cause.file && found.line == cause.line;
  if (!own) {
    text += fmt::format(" (needed at {}:{}:{})", file(found.file), found.line, found.column);
    mark = {cause.file, cause.line, cause.column, {}};
  }
  return true;
}

void Diagnostics::error(Mark mark, std::string_view id, std::string text) {
  if (!move_to_cause(mark, text)) return;
  text = with_look_alike(std::move(text));
  if (!is_new(mark, id, text)) return;
  items_.push_back({Severity::error, mark, std::string(id), std::move(text)});
  ++error_count_;
}

void Diagnostics::warning(Mark mark, std::string_view id, std::string text) {
  text = with_look_alike(std::move(text));
  if (!is_new(mark, id, text)) return;
  items_.push_back({Severity::warning, mark, std::string(id), std::move(text)});
}

void Diagnostics::add(const Diagnostic& item) {
  if (item.severity == Severity::error) {
    error(item.mark, item.id, item.text);
  } else {
    warning(item.mark, item.id, item.text);
  }
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  const auto key = [](const Diagnostic& item) {
    return std::tie(item.mark.file, item.mark.line, item.mark.column);
  };
  std::vector<Diagnostic> out = items_;
  std::stable_sort(out.begin(), out.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  // The same problem is reported several times if several aliases refer to its anchor.
  const auto again = std::unique(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    return key(a) == key(b) && a.severity == b.severity && a.text == b.text;
  });
  out.erase(again, out.end());
  return out;
}

std::string Diagnostics::place_text(const Mark& mark) const {
  if (mark.file < 0 || mark.file >= file_count()) return "";
  const std::string name = on_one_line(file(mark.file));
  return mark.line > 0 ? fmt::format("{}:{}:{}", name, mark.line, mark.column) : name;
}

std::string Diagnostics::to_string() const {
  std::string out;
  for (const Diagnostic& item : sorted()) {
    const std::string place = place_text(item.mark);
    if (!place.empty()) out += place + ": ";
    out += item.severity == Severity::error ? "error: " : "warning: ";
    out += on_one_line(item.text) + "\n";
  }
  return out;
}

}  // namespace footfall::core
