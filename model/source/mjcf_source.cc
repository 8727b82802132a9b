// A reader of XML that keeps the places; see mjcf_source.h.
#include "model/source/mjcf_source.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace footfall::model {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 100;  // included files; a loop of includes ends here

// A position in a text that counts lines and columns.
class Cursor {
 public:
  Cursor(std::string_view text, int file) : text_(text), file_(file) {}

  bool end() const { return at_ >= text_.size(); }
  char peek() const { return end() ? '\0' : text_[at_]; }
  bool starts(std::string_view what) const { return text_.substr(at_).starts_with(what); }
  MjcfPlace place() const { return {file_, line_, column_}; }
  void step(std::size_t count = 1) {
    for (; count > 0 && !end(); --count) {
      ++column_;
      if (text_[at_++] == '\n') {
        ++line_;
        column_ = 1;
      }
    }
  }
  void step_past(std::string_view what) {
    while (!end() && !starts(what)) step();
    step(what.size());
  }
  void skip_blanks() {
    while (!end() && is_one_of(peek(), " \t\r\n")) step();
  }
  std::string name() {
    std::string out;
    while (!end() && !is_one_of(peek(), " \t\r\n=/>\"'<")) {
      out += peek();
      step();
    }
    return out;
  }

 private:
  static bool is_one_of(char c, std::string_view set) {
    return set.find(c) != std::string_view::npos;
  }

  std::string_view text_;
  int file_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

// NAME="VALUE" ... up to the end of the tag; true if the element ends with it.
bool read_attributes(Cursor& cursor, MjcfElement& element) {
  while (!cursor.end()) {
    cursor.skip_blanks();
    if (cursor.starts("/>")) {
      cursor.step(2);
      return true;
    }
    if (cursor.peek() == '>') {
      cursor.step();
      return false;
    }
    MjcfAttribute attribute;
    attribute.place = cursor.place();
    attribute.name = cursor.name();
    if (attribute.name.empty()) {
      cursor.step();
      continue;
    }
    cursor.skip_blanks();
    if (cursor.peek() != '=') continue;
    cursor.step();
    cursor.skip_blanks();
    const char quote = cursor.peek();
    if (quote != '"' && quote != '\'') continue;
    cursor.step();
    while (!cursor.end() && cursor.peek() != quote) {
      attribute.value += cursor.peek();
      cursor.step();
    }
    cursor.step();
    element.attributes.push_back(std::move(attribute));
  }
  return true;
}

void collect_bodies(const MjcfElement& body, std::vector<const MjcfElement*>& out) {
  for (const MjcfElement* child : body.children) {
    if (child->tag != "body") continue;
    out.push_back(child);
    collect_bodies(*child, out);
  }
}

// The element <default class=name> at or below `element`; the top-level one is "main".
const MjcfElement* find_class(const MjcfElement& element, std::string_view name, bool top) {
  const MjcfAttribute* const own = element.find("class");
  if (own != nullptr ? own->value == name : top && name == "main") return &element;
  for (const MjcfElement* child : element.children) {
    if (child->tag != "default") continue;
    if (const MjcfElement* found = find_class(*child, name, false)) return found;
  }
  return nullptr;
}

// Actuators share their defaults: each of these tags sets them.
bool is_actuator(std::string_view tag) {
  constexpr std::string_view kTags[] = {"general",  "motor",       "position",
                                        "velocity", "intvelocity", "damper",
                                        "cylinder", "muscle",      "adhesion"};
  return std::ranges::find(kTags, tag) != std::end(kTags);
}

bool same_defaults(std::string_view a, std::string_view b) {
  if (is_actuator(a) && is_actuator(b)) return true;
  const auto tendon = [](std::string_view tag) {
    return tag == "tendon" || tag == "spatial" || tag == "fixed";
  };
  if (tendon(a) && tendon(b)) return true;
  const auto equality = [](std::string_view tag) {
    return tag == "equality" || tag == "connect" || tag == "weld" || tag == "distance";
  };
  return a == b || (equality(a) && equality(b));
}

}  // namespace

const MjcfAttribute* MjcfElement::find(std::string_view name) const {
  const auto found = std::ranges::find(attributes, name, &MjcfAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

MjcfSource::MjcfSource(const std::string& path) { read_file(path, &top_); }

MjcfElement* MjcfSource::add(MjcfElement* parent, MjcfPlace place) {
  MjcfElement& element = elements_.emplace_back();
  element.place = place;
  element.parent = parent;
  parent->children.push_back(&element);
  return &element;
}

void MjcfSource::read_file(const std::string& path, MjcfElement* parent) {
  std::ifstream in(path, std::ios::binary);
  if (!in || files_.size() >= kMaxFiles) return;
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  files_.push_back(path);
  parse(text, static_cast<int>(files_.size()) - 1, parent);
}

void MjcfSource::parse(std::string_view text, int file, MjcfElement* parent) {
  Cursor cursor(text, file);
  // An included file's root stands for its children.
  bool transparent = parent != &top_;
  std::vector<MjcfElement*> open = {parent};
  while (!cursor.end()) {
    if (cursor.peek() != '<') {
      cursor.step();
    } else if (cursor.starts("<!--")) {
      cursor.step_past("-->");
    } else if (cursor.starts("<?") || cursor.starts("<!")) {
      cursor.step_past(">");
    } else if (cursor.starts("</")) {
      cursor.step_past(">");
      if (open.size() > 1) open.pop_back();
    } else {
      const MjcfPlace place = cursor.place();
      cursor.step();
      MjcfElement scratch;
      scratch.tag = cursor.name();
      const bool closed = read_attributes(cursor, scratch);
      if (transparent) {
        transparent = false;
        if (!closed) open.push_back(parent);
        continue;
      }
      if (scratch.tag == "include") {
        const MjcfAttribute* const name = scratch.find("file");
        if (name != nullptr) {
          const fs::path beside = fs::path(files_.front()).parent_path() / name->value;
          std::error_code error;
          read_file(fs::exists(beside, error) ? beside.string() : name->value, open.back());
        }
        if (!closed) cursor.step_past("</include>");
        continue;
      }
      MjcfElement* const element = add(open.back(), place);
      element->tag = std::move(scratch.tag);
      element->attributes = std::move(scratch.attributes);
      if (!closed) open.push_back(element);
    }
  }
}

std::vector<const MjcfElement*> MjcfSource::sections(std::string_view name) const {
  std::vector<const MjcfElement*> out;
  for (const MjcfElement* root : top_.children) {
    std::ranges::copy_if(root->children, std::back_inserter(out),
                         [name](const MjcfElement* child) { return child->tag == name; });
  }
  return out;
}

std::vector<const MjcfElement*> MjcfSource::section(std::string_view name) const {
  std::vector<const MjcfElement*> out;
  for (const MjcfElement* one : sections(name)) {
    out.insert(out.end(), one->children.begin(), one->children.end());
  }
  return out;
}

std::vector<const MjcfElement*> MjcfSource::bodies() const {
  const auto worlds = sections("worldbody");
  std::vector<const MjcfElement*> out;
  for (const MjcfElement* world : worlds) {
    if (out.empty()) out.push_back(world);
    collect_bodies(*world, out);
  }
  return out;
}

const MjcfElement* MjcfSource::default_class(std::string_view name) const {
  for (const MjcfElement* top : sections("default")) {
    if (const MjcfElement* found = find_class(*top, name, true)) return found;
  }
  return nullptr;
}

MjcfPlace MjcfSource::find(const MjcfElement& element, std::string_view attribute) const {
  if (const MjcfAttribute* own = element.find(attribute)) return own->place;
  std::string_view name = "main";
  const MjcfAttribute* named = element.find("class");
  for (const MjcfElement* e = element.parent; named == nullptr && e != nullptr; e = e->parent) {
    named = e->find("childclass");
  }
  if (named != nullptr) name = named->value;
  for (const MjcfElement* d = default_class(name); d != nullptr && d->tag == "default";
       d = d->parent) {
    for (const MjcfElement* child : d->children) {
      if (!same_defaults(child->tag, element.tag)) continue;
      if (const MjcfAttribute* found = child->find(attribute)) return found->place;
    }
  }
  return element.place;
}

}  // namespace footfall::model
