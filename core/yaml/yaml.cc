// YAML as an immutable tree with exact positions; see yaml.h. Built from yaml-cpp's events instead
// of its nodes: events give the place of every key and alias, show an alias to a node that is still
// open (a self-reference), and allow a document that expands beyond the budget to be stopped.
#include "core/yaml/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <unordered_map>
#include <utility>

#include "core/text/whole_file.h"
#include "core/yaml/errors.h"
#include "core/yaml/flow_traps.h"
#include "core/yaml/text_check.h"

namespace footfall::core {

namespace {

constexpr std::size_t kMaxFileBytes = 4u << 20;
constexpr std::size_t kMaxExpandedBytes = 64u << 20;  // text of all scalars after alias expansion
constexpr int kMaxNodes = 200'000;
constexpr int kMaxDepth = 100;

// Thrown through yaml-cpp to end a document; the problem is already reported.
struct Stop {};

// Nodes, text and nesting of a finished subtree: the cost of an alias to it.
struct Size {
  int nodes = 1;
  std::size_t bytes = 0;
  int depth = 1;
};

Size size_of(const YamlNode& node) {
  Size size{1, node.scalar.size(), 1};
  const auto add = [&size](const YamlNode& child, std::size_t key_bytes) {
    const Size own = size_of(child);
    size.nodes += own.nodes;
    size.bytes += own.bytes + key_bytes;
    size.depth = std::max(size.depth, own.depth + 1);
  };
  for (const YamlNode& item : node.items) add(item, 0);
  for (const YamlEntry& entry : node.entries) add(entry.value, entry.key.size());
  return size;
}

// Builds the tree of one document.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(int file, std::string_view text, Diagnostics& diagnostics)
      : file_(file), text_(text), diagnostics_(diagnostics) {}

  YamlNode take_root() { return std::move(root_); }
  // Approximate end of the last scalar: with escapes and folds the source is longer than the value.
  std::size_t last_end() const { return last_end_; }
  // Start of the innermost open list or map, else `fallback`.
  Mark innermost(Mark fallback) const { return open_.empty() ? fallback : open_.back().node.mark; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node;
    node.mark = place(mark);
    if (expects_key()) fail(node.mark, "missing-key-name", "expected a key, got nothing");
    if (in_map()) {
      const Frame& frame = open_.back();
      // For `key:` the parser's mark is at the next token, perhaps lines below.
      if (node.mark.line != frame.key.key_mark.line) node.mark = frame.key.key_mark;
      if (!frame.key.key_quoted && frame.key.key.find(':') != std::string::npos) {
        diagnostics_.error(
            frame.key.key_mark, "missing-blank",
            fmt::format("'{}' has no value: a blank belongs after the ':'", frame.key.key));
      }
    }
    finish(std::move(node), anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node;
    node.kind = YamlNode::Kind::scalar;
    node.scalar = value;
    node.mark = place(mark);
    node.quoted = tag != "?";
    last_end_ = static_cast<std::size_t>(mark.pos) + value.size() + (node.quoted ? 2 : 0);
    node.cut = !node.quoted && is_cut(text_, static_cast<std::size_t>(mark.pos), value);
    if (value.find('\0') != std::string::npos) {
      diagnostics_.error(node.mark, "bad-text", "a control character (0x00)");
    }
    if (tag != "?" && tag != "!" && tag != "tag:yaml.org,2002:str") refuse_tag(node.mark, tag);
    finish(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      fail(place(mark), "self-reference", "an alias inside the very node that it stands for");
    }
    const auto& [node, size] = *found->second;
    check_depth(place(mark), static_cast<int>(open_.size()) + size.depth);
    // finish() counts the node itself.
    count(place(mark), size.nodes - 1, size.bytes - node.scalar.size());
    YamlNode copy = node;
    copy.mark = place(mark);
    finish(std::move(copy), YAML::NullAnchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::sequence, mark, tag, anchor);
  }
  void OnSequenceEnd() override {
    warn_of_comma();
    end();
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Frame {
    YamlNode node;
    YAML::anchor_t anchor = YAML::NullAnchor;
    bool has_key = false;
    bool drop_value = false;                     // of a duplicate key
    YamlEntry key;                               // key that waits for its value
    std::unordered_map<std::string, int> lines;  // lines of the keys read so far
  };
  using Anchored = std::pair<YamlNode, Size>;

  bool in_map() const { return !open_.empty() && open_.back().node.is_map(); }
  bool expects_key() const { return in_map() && !open_.back().has_key; }
  Mark place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }

  [[noreturn]] void fail(Mark mark, std::string_view id, std::string text) {
    diagnostics_.error(mark, id, std::move(text));
    throw Stop{};
  }
  void refuse_tag(Mark mark, const std::string& tag) {
    constexpr std::string_view kYaml = "tag:yaml.org,2002:";
    const bool own = tag.starts_with(kYaml);
    diagnostics_.error(mark, "tag",
                       fmt::format("a YAML tag '{}{}' has no meaning here: leave it out",
                                   own ? "!!" : "", own ? tag.substr(kYaml.size()) : tag));
  }

  void count(Mark mark, int nodes, std::size_t bytes) {
    nodes_ += nodes;
    bytes_ += bytes;
    if (nodes_ > kMaxNodes || bytes_ > kMaxExpandedBytes) {
      fail(mark, "too-large",
           fmt::format("more than {} values (aliases count as what they stand for)", kMaxNodes));
    }
  }
  void check_depth(Mark mark, int depth) {
    if (depth > kMaxDepth) {
      fail(mark, "too-deep", fmt::format("nested deeper than {} levels", kMaxDepth));
    }
  }

  void begin(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
             YAML::anchor_t anchor) {
    const Mark at = place(mark);
    if (expects_key()) {
      fail(at, "key-kind", "expected a key, got a list or map" + comment_hint(text_, at.line));
    }
    if (tag != "?" && !tag.empty()) refuse_tag(at, tag);
    check_depth(at, static_cast<int>(open_.size()) + 1);
    Frame frame;
    frame.node.kind = kind;
    frame.node.mark = at;
    frame.anchor = anchor;
    open_.push_back(std::move(frame));
  }

  // `[100,5, 200]` may be meant as two values or as three.
  void warn_of_comma() {
    const YamlNode* item = split_item(open_.back().node);
    if (item == nullptr) return;
    const std::string& after = (item + 1)->scalar;
    diagnostics_.warning(item->mark, "list-comma",
                         fmt::format("'{0},{1}' is two values: {0}.{1} has a decimal point, not a "
                                     "comma; if two are meant, a blank belongs after the comma",
                                     item->scalar, after));
  }

  // `{value: 3,5 cm}` has a key `5 cm`; true if that was reported.
  bool refuse_comma(const Frame& frame, const YamlNode& node) {
    if (!node.is_null() || frame.key.key_quoted || frame.node.entries.empty()) return false;
    const YamlEntry& before = frame.node.entries.back();
    const std::string meant = split_quantity(before, frame.key.key);
    if (meant.empty()) return false;
    diagnostics_.error(before.value.mark, "decimal-comma",
                       fmt::format("a decimal point, not a comma: '{}'", meant));
    return true;
  }

  void end() {
    Frame frame = std::move(open_.back());
    open_.pop_back();
    finish(std::move(frame.node), frame.anchor);
  }

  // Stores a complete node for aliases and adds it to its parent.
  void finish(YamlNode node, YAML::anchor_t anchor) {
    count(node.mark, 1, node.scalar.size());
    if (anchor != YAML::NullAnchor) {
      const Size size = size_of(node);
      // The anchor's copy uses memory too, so it counts; nested anchors cannot grow quadratically.
      count(node.mark, size.nodes, size.bytes);
      anchors_[anchor] = std::make_unique<Anchored>(node, size);
    }
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.is_sequence()) {
      open_.back().node.items.push_back(std::move(node));
    } else if (!open_.back().has_key) {
      take_key(std::move(node));
    } else {
      Frame& frame = open_.back();
      frame.has_key = false;
      if (frame.drop_value || refuse_comma(frame, node)) return;
      frame.key.value = std::move(node);
      frame.node.entries.push_back(std::move(frame.key));
    }
  }

  void take_key(YamlNode node) {
    Frame& frame = open_.back();
    if (!node.is_scalar()) fail(node.mark, "key-kind", "expected a key, got a list or map");
    if (!node.quoted && node.scalar == "<<") {
      diagnostics_.error(node.mark, "merge-key",
                         "'<<' is not supported: use a template, or 'base:' for whole files");
    }
    const auto [found, is_new] = frame.lines.emplace(node.scalar, node.mark.line);
    if (!is_new) {
      diagnostics_.error(
          node.mark, "duplicate-key",
          fmt::format("duplicate key '{}', first on line {}", node.scalar, found->second));
    }
    frame.has_key = true;
    frame.drop_value = !is_new;
    frame.key = YamlEntry{std::move(node.scalar), node.mark, node.quoted, {}};
  }

  int file_;
  std::string_view text_;
  Diagnostics& diagnostics_;
  std::vector<Frame> open_;
  std::unordered_map<YAML::anchor_t, std::unique_ptr<Anchored>> anchors_;
  int nodes_ = 0;
  std::size_t bytes_ = 0;
  std::size_t last_end_ = 0;
  YamlNode root_;
};

// Reports content behind the first document, at its first event.
class SecondDocument : public YAML::EventHandler {
 public:
  SecondDocument(int file, std::string_view text, Diagnostics& diagnostics)
      : file_(file), text_(text), diagnostics_(diagnostics) {}
  void OnDocumentStart(const YAML::Mark& mark) override {
    const std::size_t at = std::min(static_cast<std::size_t>(mark.pos), text_.size());
    const bool separated = text_.substr(at).starts_with("---");
    diagnostics_.error({file_, mark.line + 1, mark.column + 1}, "several-documents",
                       separated ? "a second YAML document ('---'): a file holds one"
                                 : "expected the end of the file: is the indentation right?");
    throw Stop{};
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int file_;
  std::string_view text_;
  Diagnostics& diagnostics_;
};

// The position of the first quote at or behind `from`.
Mark quote_after(std::string_view text, std::size_t from, int file) {
  const std::size_t quote = std::min(text.find_first_of("'\"", from), text.size());
  const std::string_view before = text.substr(0, quote);
  const auto line = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return {file, static_cast<int>(line) + 1, static_cast<int>(quote - line_begin) + 1};
}

YamlNode parse(std::string text, int file, Diagnostics& diagnostics) {
  const Mark whole{file, 0, 0};
  if (text.size() > kMaxFileBytes) {
    diagnostics.error(whole, "too-large", "larger than 4 MB");
    return {};
  }
  make_line_ends_plain(text);
  if (!check_text(text, file, diagnostics)) return {};
  // yaml-cpp silently reads an unclosed quote as text up to the end of the file; but it refuses an
  // end-of-document marker inside quotes, so that one is appended.
  if (text.empty() || text.back() != '\n') text += '\n';
  const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  const int errors_before = diagnostics.error_count();
  std::istringstream stream{text + "...\n"};
  TreeBuilder builder(file, text, diagnostics);
  try {
    YAML::Parser parser(stream);
    if (parser.HandleNextDocument(builder)) {
      SecondDocument second(file, text, diagnostics);
      parser.HandleNextDocument(second);
    }
    if (diagnostics.error_count() != errors_before) return {};
    YamlNode root = builder.take_root();
    if (root.is_null()) diagnostics.error(whole, "empty", "the file is empty");
    return root;
  } catch (const Stop&) {
    return {};
  } catch (const YAML::Exception& error) {
    const int failed_line = error.mark.is_null() ? lines : std::min(error.mark.line + 1, lines);
    if (report_false_colon(text, failed_line, file, diagnostics)) return {};
    if (!error.mark.is_null() && error.mark.line >= lines) {
      const bool in_quotes = error.msg == YAML::ErrorMsg::DOC_IN_SCALAR;
      const Mark mark =
          in_quotes ? quote_after(text, builder.last_end(), file) : builder.innermost(whole);
      diagnostics.error(
          mark, in_quotes ? "open-quote" : "yaml",
          in_quotes ? "a quote that is never closed"
                    : "YAML: " + yaml_error_text(error.msg) + comment_hint(text, mark.line));
    } else {
      const Mark mark =
          error.mark.is_null() ? whole : Mark{file, error.mark.line + 1, error.mark.column + 1};
      const Mark open = builder.innermost(mark);  // what a comment has left open
      diagnostics.error(mark, "yaml",
                        "YAML: " + yaml_error_text(error.msg) + comment_hint(text, open.line));
    }
    return {};
  }
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  for (const YamlEntry& entry : entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

YamlNode load_yaml_file(const std::string& path, Diagnostics& diagnostics) {
  const int file = diagnostics.add_file(path);
  std::string problem;
  std::optional<std::string> text = read_file(path, kMaxFileBytes + 1, problem);
  if (!text) {
    diagnostics.error({file, 0, 0}, "cannot-read", "cannot read: " + problem);
    return {};
  }
  return parse(std::move(*text), file, diagnostics);
}

YamlNode load_yaml_text(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
  return parse(std::string(text), diagnostics.add_file(name), diagnostics);
}

}  // namespace footfall::core
