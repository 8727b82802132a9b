// The canonical layout of YAML; see format.h. The indentation of the block structure is kept on a
// stack of levels, brackets on another one. Comments are held back until the indentation of the
// following line is known.
#include "core/yaml_text/format.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/yaml_text/tokens.h"

namespace footfall::core {
namespace {

using Kind = YamlToken::Kind;
constexpr std::size_t kLongestLine = 160, kBrokenWidth = 120;

// A block map or list: its old and new indentation.
struct Level {
  std::size_t column = 0, indent = 0;
  bool list = false;
};

struct Bracket {
  std::size_t inner = 0;  // column of continuation lines inside the brackets
  std::size_t close = 0;  // column of the closing bracket, if it begins a line
};

// A possible line break: behind a comma and its blank.
struct Break {
  std::size_t at = 0, depth = 0, indent = 0;
};

// Keys whose values are text, never quantities.
bool is_text_key(std::string_view key) {
  static constexpr std::array<std::string_view, 9> kKeys = {
      "doc", "name", "model", "robot", "world", "base", "reason", "log", "behavior"};
  return std::ranges::find(kKeys, key) != kKeys.end();
}

class Layout {
 public:
  std::string run(std::span<const YamlToken> tokens) {
    while (!tokens.empty()) {
      std::size_t count = 1;
      while (count < tokens.size() && !tokens[count].begins_line) ++count;
      add_line(tokens.first(count));
      tokens = tokens.subspan(count);
    }
    before_ = levels_;  // comments behind the last line keep their level
    write_comments(0, 0);
    return std::move(out_);
  }

 private:
  bool flow() const { return !brackets_.empty(); }
  std::size_t indent_below() const { return levels_.empty() ? 0 : levels_.back().indent + 2; }

  void add_line(std::span<const YamlToken> tokens) {
    if (tokens.front().kind == Kind::comment) {
      comments_.push_back(tokens.front());
      return;
    }
    const std::size_t column = tokens.front().column;
    if (tokens.front().kind == Kind::marker) {
      levels_.clear();
      begin_line(tokens, 0, 0);
    } else if (flow()) {
      const Bracket& bracket = brackets_.back();
      const bool closes = tokens.front().kind == Kind::close;
      begin_line(tokens, column, closes ? bracket.close : bracket.inner);
    } else {
      begin_line(tokens, column, enter_all(tokens));
    }
    for (std::size_t k = 0; k < tokens.size(); ++k) {
      const bool key = k + 1 < tokens.size() && tokens[k + 1].kind == Kind::colon;
      const bool last = k + 1 == tokens.size() || tokens[k + 1].kind == Kind::comment;
      add_token(tokens[k], key, last);
    }
    end_line();
  }

  // The indentation of a key or a dash at `column`; opens a new level if necessary.
  std::size_t enter(std::size_t column, bool list) {
    while (!levels_.empty() && levels_.back().column > column) levels_.pop_back();
    if (!list && !levels_.empty() && levels_.back().list && levels_.back().column == column) {
      levels_.pop_back();  // a list not indented below its key ends here
    }
    const bool same =
        !levels_.empty() && levels_.back().column == column && levels_.back().list == list;
    if (!same) levels_.push_back({column, indent_below(), list});
    return levels_.back().indent;
  }

  // Opens the levels of a line of the block structure; returns the line's own indentation.
  std::size_t enter_all(std::span<const YamlToken> tokens) {
    before_ = levels_;
    std::optional<std::size_t> indent;
    for (std::size_t k = 0; k < tokens.size(); ++k) {
      std::size_t key = k;  // behind anchors
      while (key + 1 < tokens.size() && tokens[key].kind == Kind::property &&
             tokens[key + 1].kind != Kind::colon) {
        ++key;
      }
      const bool dash = tokens[k].kind == Kind::dash;
      const bool is_key = key + 1 < tokens.size() && tokens[key + 1].kind == Kind::colon;
      if (!dash && !is_key) break;
      const std::size_t own = enter(tokens[k].column, dash);
      if (!indent) indent = own;
      if (!dash) break;
    }
    if (!indent) {
      while (!levels_.empty() && levels_.back().column >= tokens.front().column) levels_.pop_back();
      indent = indent_below();
    }
    return *indent;
  }

  void begin_line(std::span<const YamlToken> tokens, std::size_t column, std::size_t indent) {
    write_comments(column, indent);
    const YamlToken& first = tokens.front();
    const bool key = tokens.size() > 1 && tokens[1].kind == Kind::colon;
    if (plain_goes_on_ && first.kind == Kind::plain && !key) {
      out_.append(first.empty_lines, '\n');  // inside a scalar every empty line is significant
    } else if (first.empty_lines > 0 && !out_.empty()) {
      out_ += '\n';
    }
    line_.assign(indent, ' ');
    first_token_ = true;
    base_ = indent;
    breaks_.clear();
  }

  // Writes held-back comments before a line at `column` with indentation `indent`: each takes the
  // indentation of the line, or of the level at which it was written.
  void write_comments(std::size_t column, std::size_t indent) {
    for (const YamlToken& comment : comments_) {
      std::size_t own = indent;
      if (!flow() && comment.column != column) {
        own = comment.column > column ? indent : 0;
        const std::vector<Level>& levels = comment.column > column ? before_ : levels_;
        for (const Level& level : levels) {
          if (level.column <= comment.column &&
              (comment.column > column || level.column < column)) {
            own = std::max(own, level.indent);
          }
        }
      }
      if (comment.empty_lines > 0 && !out_.empty()) out_ += '\n';
      out_ += std::string(own, ' ') + comment_text(comment) + "\n";
    }
    comments_.clear();
  }

  static std::string comment_text(const YamlToken& comment) {
    const std::string& text = comment.text;
    const bool spaced =
        text.size() < 2 || std::string_view(" #!").find(text[1]) != std::string_view::npos;
    return spaced ? text : "# " + text.substr(1);
  }

  void add_token(const YamlToken& token, bool key, bool last) {
    const bool tight = token.kind == Kind::close || token.kind == Kind::comma ||
                       token.kind == Kind::colon || token.kind == Kind::comment;
    if (!first_token_ && !tight && after_ != Kind::open) line_ += ' ';
    if (after_ == Kind::comma && !first_token_ && !tight) {
      breaks_.push_back(
          {line_.size(), brackets_.size(), brackets_.empty() ? 0 : brackets_.back().inner});
    }
    if (after_ == Kind::dash) base_ = line_.size();
    switch (token.kind) {
      case Kind::open:
        open_bracket(token, last);
        break;
      case Kind::close:
        if (after_ == Kind::comma && !first_token_) line_.pop_back();  // `[a, ]`
        line_ += token.text;
        if (!brackets_.empty()) brackets_.pop_back();
        break;
      case Kind::comment:
        comment_ = comment_text(token);
        return;
      case Kind::block:
        line_ += token.text;
        block_ = &token;
        break;
      case Kind::quoted:
        add_quoted(token.text);
        if (key) key_ = canonical_quoted(token.text);
        break;
      case Kind::plain:
        line_ += key || is_text_key(key_) ? token.text : spaced_quantity(token.text);
        if (key) key_ = token.text;
        break;
      default:
        line_ += token.text;
    }
    plain_goes_on_ = token.kind == Kind::plain && !key;
    after_ = token.kind;
    first_token_ = false;
  }

  void open_bracket(const YamlToken& token, bool hanging) {
    line_ += token.text;
    if (hanging) {
      // In block structure the closing bracket must be indented more than the key, too.
      brackets_.push_back({base_ + 2, flow() ? base_ : base_ + 2});
    } else {
      brackets_.push_back({line_.size(), line_.size() - 1});
    }
  }

  // A quoted text over several lines is indented anew: blanks around its line ends are
  // insignificant.
  void add_quoted(const std::string& text) {
    if (text.find('\n') == std::string::npos) {
      line_ += canonical_quoted(text);
      return;
    }
    const std::size_t indent = flow() ? brackets_.back().inner : indent_below();
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string part = text.substr(begin, end - begin);
      if (begin > 0) part.erase(0, std::min(part.find_first_not_of(' '), part.size()));
      if (end < text.size()) {
        std::size_t keep = part.find_last_not_of(" \r") + 1;
        if (keep > 0 && part[keep - 1] == '\\' && keep < part.size()) ++keep;  // an escaped blank
        part.erase(keep);
      }
      if (begin > 0 && !part.empty()) line_.assign(indent, ' ');
      line_ += part;
      begin = end + 1;
      if (end == text.size()) break;
      out_ += line_ + "\n";
      line_.clear();
      breaks_.clear();
    }
  }

  void end_line() {
    while (line_.size() > kLongestLine && break_line()) {
    }
    out_ += line_;
    if (!comment_.empty()) out_ += "  " + comment_;
    out_ += '\n';
    comment_.clear();
    if (block_ == nullptr) return;
    const std::size_t digit = block_->text.find_first_of("123456789");
    const std::size_t indent =
        digit == std::string::npos
            ? indent_below()
            : indent_below() - 2 + static_cast<std::size_t>(block_->text[digit] - '0');
    for (const std::string& line : block_->lines) {
      out_ += line.empty() ? "\n" : std::string(indent, ' ') + line + "\n";
    }
    block_ = nullptr;
  }

  // Breaks the line at the last comma before column 120 with the fewest enclosing brackets; the
  // indentation of brackets still open is updated. False if there is none.
  bool break_line() {
    const Break* best = nullptr;
    for (const Break& candidate : breaks_) {
      if (candidate.at > kBrokenWidth || candidate.indent >= candidate.at) continue;
      if (best == nullptr || candidate.depth <= best->depth) best = &candidate;
    }
    if (best == nullptr) return false;
    const Break chosen = *best;
    out_ += line_.substr(0, chosen.at - 1) + "\n";
    line_ = std::string(chosen.indent, ' ') + line_.substr(chosen.at);
    const std::size_t left = chosen.at - chosen.indent;
    std::erase_if(breaks_, [&](const Break& other) { return other.at <= chosen.at; });
    for (Break& other : breaks_) {
      other.at -= left;
      if (other.indent > chosen.at) other.indent -= left;
    }
    for (Bracket& bracket : brackets_) {
      if (bracket.inner > chosen.at) bracket.inner -= left;
      if (bracket.close >= chosen.at) bracket.close -= left;
    }
    return true;
  }

  std::string out_, line_, comment_, key_;
  std::size_t base_ = 0;  // column of the line's first token, dashes aside
  bool first_token_ = true, plain_goes_on_ = false;
  Kind after_ = Kind::marker;
  const YamlToken* block_ = nullptr;
  std::vector<Level> levels_, before_;
  std::vector<Bracket> brackets_;
  std::vector<Break> breaks_;
  std::vector<YamlToken> comments_;
};

bool same_scalar(const YamlNode& a, const YamlNode& b) {
  if (a.quoted == b.quoted && a.scalar == b.scalar) return true;
  if (a.quoted != b.quoted) return a.scalar == b.scalar && is_plain_word(a.scalar);
  return !a.quoted && spaced_quantity(a.scalar) == spaced_quantity(b.scalar);
}

}  // namespace

std::optional<std::string> format_yaml(std::string_view text) {
  const auto tokens = yaml_tokens(text);
  if (!tokens) return std::nullopt;
  return Layout().run(*tokens);
}

bool same_values(const YamlNode& a, const YamlNode& b) {
  if (a.kind != b.kind || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size()) {
    return false;
  }
  if (a.is_scalar()) return same_scalar(a, b);
  for (std::size_t k = 0; k < a.items.size(); ++k) {
    if (!same_values(a.items[k], b.items[k])) return false;
  }
  for (std::size_t k = 0; k < a.entries.size(); ++k) {
    const bool quotes =
        a.entries[k].key_quoted == b.entries[k].key_quoted || is_plain_word(a.entries[k].key);
    if (a.entries[k].key != b.entries[k].key || !quotes) return false;
    if (!same_values(a.entries[k].value, b.entries[k].value)) return false;
  }
  return true;
}

}  // namespace footfall::core
