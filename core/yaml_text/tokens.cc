// Tokens of YAML; see tokens.h.
#include "core/yaml_text/tokens.h"

#include <algorithm>

namespace footfall::core {
namespace {

constexpr std::size_t kNowhere = std::string_view::npos;

struct Unsupported {};

bool is_flow(char c) { return std::string_view(",[]{}").find(c) != kNowhere; }

class Scanner {
 public:
  explicit Scanner(std::string_view text) : in_(text) {}

  std::vector<YamlToken> run() {
    while (at_ < in_.size()) read_line();
    if (depth_ > 0) throw Unsupported{};
    return std::move(tokens_);
  }

 private:
  char peek() const { return at_ < in_.size() ? in_[at_] : '\n'; }
  bool ends_word(std::size_t at) const {
    return at >= in_.size() || std::string_view(" \t\r\n").find(in_[at]) != kNowhere;
  }
  bool ends_line(std::size_t at) const {
    return at >= in_.size() || in_[at] == '\n' || in_[at] == '\r';
  }
  void skip_blanks() {
    while (at_ < in_.size() && (in_[at_] == ' ' || in_[at_] == '\t')) ++at_;
  }

  // Records the position data needed by the layout, such as the text before the token in its line.
  void add(YamlToken::Kind kind, std::size_t begin, std::size_t end) {
    YamlToken token;
    token.kind = kind;
    token.text = in_.substr(begin, end - begin);
    token.offset = begin;
    token.column = begin - line_begin_;
    token.begins_line = first_;
    if (first_) token.empty_lines = empty_lines_;
    if (first_) empty_lines_ = 0;
    first_ = false;
    at_ = end;
    tokens_.push_back(std::move(token));
  }

  std::size_t line_end() const {
    std::size_t end = std::min(in_.find('\n', at_), in_.size());
    while (end > at_ && std::string_view(" \t\r").find(in_[end - 1]) != kNowhere) --end;
    return end;
  }

  void read_line() {
    line_begin_ = at_;
    first_ = true;
    const std::string_view rest = in_.substr(at_);
    const bool mark = rest.starts_with("---") || rest.starts_with("...");
    if (depth_ == 0 && (rest.starts_with('%') || (mark && ends_word(at_ + 3)))) {
      add(YamlToken::Kind::marker, at_, line_end());
    }
    skip_blanks();
    if (ends_line(at_) && first_) ++empty_lines_;
    for (; !ends_line(at_); skip_blanks()) read_token();
    next_line();
  }
  void next_line() {
    if (peek() == '\r') ++at_;
    if (at_ < in_.size()) ++at_;
  }

  void read_token() {
    const char c = peek();
    if (c == '#') {
      add(YamlToken::Kind::comment, at_, line_end());
    } else if (c == '{' || c == '[') {
      ++depth_;
      add(YamlToken::Kind::open, at_, at_ + 1);
    } else if (depth_ > 0 && (c == '}' || c == ']')) {
      --depth_;
      add(YamlToken::Kind::close, at_, at_ + 1);
      read_colon(true);
    } else if (depth_ > 0 && c == ',') {
      add(YamlToken::Kind::comma, at_, at_ + 1);
    } else if ((c == '?' || c == ':') && ends_word(at_ + 1)) {
      throw Unsupported{};
    } else if (depth_ == 0 && c == '-' && ends_word(at_ + 1)) {
      add(YamlToken::Kind::dash, at_, at_ + 1);
    } else if (c == '&' || c == '*' || c == '!') {
      std::size_t end = at_;
      while (!ends_word(end) && !(depth_ > 0 && is_flow(in_[end]))) ++end;
      add(YamlToken::Kind::property, at_, end);
      read_colon(false);
    } else if (c == '"' || c == '\'') {
      read_quoted(c);
    } else if (depth_ == 0 && (c == '|' || c == '>') && follows_key_or_dash()) {
      read_block();
    } else {
      read_plain();
    }
  }

  bool follows_key_or_dash() const {
    return !first_ && (tokens_.back().kind == YamlToken::Kind::colon ||
                       tokens_.back().kind == YamlToken::Kind::dash ||
                       tokens_.back().kind == YamlToken::Kind::property);
  }

  // Whether the `:` at `at` ends a key; after a quoted key inside brackets no blank is required.
  bool is_colon(std::size_t at, bool after_quote) const {
    if (at >= in_.size() || in_[at] != ':') return false;
    return ends_word(at + 1) || (depth_ > 0 && (after_quote || is_flow(in_[at + 1])));
  }
  void read_colon(bool after_quote) {
    std::size_t at = at_;
    while (at < in_.size() && in_[at] == ' ') ++at;
    if (is_colon(at, after_quote)) add(YamlToken::Kind::colon, at, at + 1);
  }

  void read_plain() {
    std::size_t end = at_;
    for (std::size_t i = at_; !ends_line(i); ++i) {
      if (in_[i] == '#' && i > at_ && ends_word(i - 1)) break;
      if (is_colon(i, false) || (depth_ > 0 && is_flow(in_[i]))) break;
      if (!ends_word(i)) end = i + 1;
    }
    if (end == at_) throw Unsupported{};
    add(YamlToken::Kind::plain, at_, end);
    read_colon(false);
  }

  void read_quoted(char quote) {
    std::size_t end = at_ + 1;
    for (; end < in_.size(); ++end) {
      if (quote == '"' && in_[end] == '\\') {
        ++end;
      } else if (in_[end] == quote) {
        if (quote == '"' || end + 1 >= in_.size() || in_[end + 1] != quote) break;
        ++end;  // '' inside single quotes
      }
    }
    if (end >= in_.size()) throw Unsupported{};
    add(YamlToken::Kind::quoted, at_, end + 1);
    const std::size_t last = in_.rfind('\n', end);
    if (last != kNowhere && last >= line_begin_) line_begin_ = last + 1;
    read_colon(true);
  }

  // The text of a block scalar must be indented more than this column.
  std::size_t parent_column() const {
    for (std::size_t k = tokens_.size(); k-- > 0;) {
      if (tokens_[k].kind == YamlToken::Kind::dash) return tokens_[k].column;
      if (tokens_[k].kind == YamlToken::Kind::colon) {
        // The key, or the anchor before it.
        std::size_t key = k - 1;
        while (key > 0 && !tokens_[key].begins_line &&
               tokens_[key - 1].kind == YamlToken::Kind::property)
          --key;
        return tokens_[key].column;
      }
      if (tokens_[k].begins_line) break;
    }
    throw Unsupported{};
  }

  void read_block() {
    const std::size_t parent = parent_column();
    std::size_t end = at_;
    while (!ends_word(end)) ++end;
    add(YamlToken::Kind::block, at_, end);
    const std::size_t block = tokens_.size() - 1;
    skip_blanks();
    if (peek() == '#') add(YamlToken::Kind::comment, at_, line_end());
    if (!ends_line(at_)) throw Unsupported{};
    next_line();
    const std::string header = tokens_[block].text;
    const std::size_t digit = header.find_first_of("123456789");
    std::size_t indent = digit == std::string::npos
                             ? kNowhere
                             : parent + static_cast<std::size_t>(header[digit] - '0');
    std::vector<std::string>& lines = tokens_[block].lines;
    while (at_ < in_.size()) {
      const std::size_t stop = std::min(in_.find('\n', at_), in_.size());
      std::string_view line = in_.substr(at_, stop - at_);
      if (line.ends_with('\r')) line.remove_suffix(1);
      const std::size_t column = line.find_first_not_of(' ');
      if (column != kNowhere && column <= parent) break;
      if (column != kNowhere && indent == kNowhere) indent = column;
      const bool empty = column == kNowhere && (indent == kNowhere || line.size() <= indent);
      if (!empty && line.substr(0, indent).find_first_not_of(' ') != kNowhere) throw Unsupported{};
      lines.emplace_back(empty ? std::string_view() : line.substr(indent));
      at_ = std::min(stop + 1, in_.size());
    }
    // Empty lines at the end are significant only with `+`.
    while (header.find('+') == std::string::npos && !lines.empty() && lines.back().empty()) {
      lines.pop_back();
      ++empty_lines_;
    }
    if (in_[at_ - 1] == '\n') --at_;  // read_line() ends the line
  }

  std::string_view in_;
  std::size_t at_ = 0, line_begin_ = 0, empty_lines_ = 0;
  int depth_ = 0;
  bool first_ = true;  // no token read in this line yet
  std::vector<YamlToken> tokens_;
};

}  // namespace

std::optional<std::vector<YamlToken>> yaml_tokens(std::string_view text) {
  try {
    return Scanner(text).run();
  } catch (const Unsupported&) {
    return std::nullopt;
  }
}

}  // namespace footfall::core
