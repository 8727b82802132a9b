// Edits of single values in the text of a YAML file; see edit.h.
#include "core/yaml_text/edit.h"

#include <algorithm>
#include <tuple>

#include "core/yaml_text/tokens.h"
#include "core/yaml_text/write.h"

namespace footfall::core {
namespace {

using Kind = YamlToken::Kind;
constexpr std::size_t kNoPlace = std::string_view::npos;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // not counted in a mark's column

// Tokens of a text; offsets count from its first byte, including a byte order mark.
std::optional<std::vector<YamlToken>> tokens_of(std::string_view text) {
  const std::size_t skipped = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  auto tokens = yaml_tokens(text.substr(skipped));
  if (!tokens) return std::nullopt;
  for (YamlToken& token : *tokens) token.offset += skipped;
  return tokens;
}

std::size_t end_of(const YamlToken& token) { return token.offset + token.text.size(); }

// Index of the token that begins at a mark, kNoPlace if none does.
std::size_t token_at(std::string_view text, const std::vector<YamlToken>& tokens, Mark mark) {
  if (mark.line < 1 || mark.column < 1) return kNoPlace;
  std::size_t at = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (int line = 1; line < mark.line; ++line) {
    at = text.find('\n', at);
    if (at == kNoPlace) return kNoPlace;
    ++at;
  }
  at += static_cast<std::size_t>(mark.column) - 1;
  const auto found = std::ranges::lower_bound(tokens, at, {}, &YamlToken::offset);
  return found == tokens.end() || found->offset != at
             ? kNoPlace
             : static_cast<std::size_t>(found - tokens.begin());
}

// Index of the first token after the anchors in front of a value.
std::size_t skip_anchors(const std::vector<YamlToken>& tokens, std::size_t k) {
  while (k < tokens.size() && tokens[k].kind == Kind::property && tokens[k].text[0] == '&') ++k;
  return k;
}

// The value of an alias at `k`: behind the last earlier anchor of the same name.
std::size_t follow_alias(const std::vector<YamlToken>& tokens, std::size_t k) {
  const std::string anchor = "&" + tokens[k].text.substr(1);
  for (std::size_t before = k; before-- > 0;) {
    if (tokens[before].kind == Kind::property && tokens[before].text == anchor) {
      return skip_anchors(tokens, before);
    }
  }
  return kNoPlace;
}

// Index after the last token of the value or entry that begins at `k`, in a block whose keys are at
// `column`; trailing comments are excluded.
std::size_t end_of_entry(const std::vector<YamlToken>& tokens, std::size_t k, std::size_t column) {
  std::size_t end = k + 1;
  int depth = 0;
  for (std::size_t i = k; i < tokens.size(); ++i) {
    const YamlToken& token = tokens[i];
    const bool outside =
        token.column < column || (token.column == column && token.kind != Kind::dash);
    if (token.kind == Kind::comment) continue;
    if (i > k && depth == 0 && token.begins_line && outside) break;
    if (token.kind == Kind::open) ++depth;
    if (token.kind == Kind::close) --depth;
    end = i + 1;
  }
  return end;
}

std::string key_text(const std::string& key) {
  YamlNode node;
  node.kind = YamlNode::Kind::scalar;
  node.scalar = key;
  return to_flow_yaml(node);
}

// `{b: {c: VALUE}}` for the keys from `first` on; VALUE itself if there are none.
std::string nested(const std::vector<std::string>& path, std::size_t first,
                   const std::string& value) {
  std::string out = value;
  for (std::size_t k = path.size(); k-- > first;) out = "{" + key_text(path[k]) + ": " + out + "}";
  return out;
}

// Adds behind the last entry of a map in braces.
std::optional<TextEdit> add_to_flow(const std::vector<YamlToken>& tokens, std::size_t open,
                                    const std::vector<std::string>& path, std::size_t first,
                                    const std::string& value) {
  int depth = 0;
  std::size_t last = open, close = open;
  for (; close < tokens.size(); ++close) {
    const Kind kind = tokens[close].kind;
    if (kind == Kind::open) ++depth;
    if (kind == Kind::close && --depth == 0) break;
    if (kind != Kind::comment) last = close;
  }
  if (close == tokens.size()) return std::nullopt;
  std::string entry = key_text(path[first]) + ": " + nested(path, first + 1, value);
  if (tokens[last].kind == Kind::comma) {
    entry = " " + entry;
  } else if (last != open) {
    entry = ", " + entry;
  }
  return TextEdit{end_of(tokens[last]), end_of(tokens[last]), entry};
}

// The lines of an entry in a block map: one line a key except for the innermost map.
std::string block_lines(const std::vector<std::string>& path, std::size_t first,
                        const std::string& value, std::size_t column, const std::string& line_end) {
  const std::size_t braces = std::max(first + 1, path.size() - 1);  // first key inside braces
  std::string out;
  for (std::size_t k = first; k < braces; ++k) {
    out += std::string(column + 2 * (k - first), ' ') + key_text(path[k]) + ":";
    out += k + 1 < braces ? line_end : " " + nested(path, braces, value);
  }
  return out;
}

// Adds a line behind the last entry of a block map.
std::optional<TextEdit> add_to_block(std::string_view text, const std::vector<YamlToken>& tokens,
                                     const YamlNode& map, const std::vector<std::string>& path,
                                     std::size_t first, const std::string& value) {
  const std::size_t key = token_at(text, tokens, map.entries.back().key_mark);
  if (key == kNoPlace) return std::nullopt;
  const std::size_t column = tokens[key].column;
  if (!tokens[key].begins_line) return std::nullopt;  // `- key:`: the column is ambiguous
  const std::size_t last = end_of_entry(tokens, key, column) - 1;
  // The lines of a block scalar belong to its header, up to the line of the next token.
  std::size_t at = end_of(tokens[last]);
  if (tokens[last].kind == Kind::block) {
    if (last + 1 >= tokens.size()) return std::nullopt;
    at = tokens[last + 1].offset - tokens[last + 1].column - 1;
  }
  const std::size_t end = text.find('\n', at);
  const bool crlf = text.find("\r\n") != kNoPlace;
  const std::string line_end = crlf ? "\r\n" : "\n";
  const std::string lines = block_lines(path, first, value, column, line_end);
  if (end == kNoPlace) return TextEdit{text.size(), text.size(), line_end + lines};
  return TextEdit{end + 1, end + 1, lines + line_end};
}

}  // namespace

std::optional<TextEdit> find_scalar(std::string_view text, Mark mark) {
  const auto tokens = tokens_of(text);
  if (!tokens) return std::nullopt;
  std::size_t k = token_at(text, *tokens, mark);
  if (k == kNoPlace) return std::nullopt;
  k = skip_anchors(*tokens, k);
  for (int links = 0; k < tokens->size() && (*tokens)[k].kind == Kind::property; ++links) {
    if ((*tokens)[k].text[0] != '*' || links > 100) return std::nullopt;
    k = follow_alias(*tokens, k);
  }
  if (k >= tokens->size()) return std::nullopt;
  const YamlToken& token = (*tokens)[k];
  // A plain word after another one is the next key, or a continuation line.
  const auto kind_at = [&](std::size_t i) {
    return i < tokens->size() ? (*tokens)[i].kind : Kind::marker;
  };
  const bool folded =
      token.text.find('\n') != kNoPlace ||
      (token.kind == Kind::plain && kind_at(k + 1) == Kind::plain && kind_at(k + 2) != Kind::colon);
  if ((token.kind != Kind::plain && token.kind != Kind::quoted) || folded) return std::nullopt;
  return TextEdit{token.offset, end_of(token), token.text};
}

std::optional<TextEdit> add_value(std::string_view text, const YamlNode& root,
                                  const std::vector<std::string>& path, const std::string& value) {
  const YamlNode* map = &root;
  std::size_t first = 0;
  while (map->is_map() && first < path.size()) {
    const YamlNode* inner = map->find(path[first]);
    if (inner == nullptr) break;
    map = inner;
    ++first;
  }
  if (!map->is_map() || first == path.size()) return std::nullopt;
  const auto tokens = tokens_of(text);
  if (!tokens) return std::nullopt;
  const std::size_t at = token_at(text, *tokens, map->mark);
  if (at == kNoPlace) return std::nullopt;
  const std::size_t open = skip_anchors(*tokens, at);
  if (open >= tokens->size()) return std::nullopt;
  if ((*tokens)[open].kind == Kind::open && (*tokens)[open].text == "{") {
    return add_to_flow(*tokens, open, path, first, value);
  }
  if ((*tokens)[open].kind == Kind::property || map->entries.empty()) return std::nullopt;
  return add_to_block(text, *tokens, *map, path, first, value);
}

std::optional<std::string> apply_edits(std::string_view text, std::vector<TextEdit> edits) {
  const auto place = [](const TextEdit& edit) { return std::tie(edit.begin, edit.end, edit.text); };
  std::ranges::sort(edits, [&](const auto& a, const auto& b) { return place(a) < place(b); });
  const auto same = [&](const auto& a, const auto& b) { return place(a) == place(b); };
  edits.erase(std::unique(edits.begin(), edits.end(), same), edits.end());
  std::string out;
  std::size_t at = 0;
  for (const TextEdit& edit : edits) {
    if (edit.begin < at || edit.end < edit.begin || edit.end > text.size()) return std::nullopt;
    out += text.substr(at, edit.begin - at);
    out += edit.text;
    at = edit.end;
  }
  out += text.substr(at);
  return out;
}

}  // namespace footfall::core
