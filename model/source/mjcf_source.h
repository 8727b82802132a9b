// The elements of an MJCF file with their places, for messages: MuJoCo's compiled model says what
// acts, and this says where it is written. Load time only.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace footfall::model {

struct MjcfPlace {
  int file = 0;  // index into MjcfSource::files()
  int line = 0;  // 0: the whole file
  int column = 0;
};

struct MjcfAttribute {
  std::string name, value;
  MjcfPlace place;  // of the name
};

struct MjcfElement {
  std::string tag;
  MjcfPlace place;  // of '<'
  std::vector<MjcfAttribute> attributes;
  std::vector<const MjcfElement*> children;
  const MjcfElement* parent = nullptr;  // nullptr for a root

  const MjcfAttribute* find(std::string_view name) const;
};

class MjcfSource {
 public:
  // Reads a file and those that it includes. What is malformed is left out: MuJoCo has reported it.
  explicit MjcfSource(const std::string& path);

  const std::vector<std::string>& files() const { return files_; }
  // The elements <mujoco>, normally one.
  const std::vector<const MjcfElement*>& roots() const { return top_.children; }
  // The children of all elements <section> below <mujoco>, with those of included files.
  std::vector<const MjcfElement*> section(std::string_view section) const;
  // The elements <section> themselves.
  std::vector<const MjcfElement*> sections(std::string_view section) const;
  // The bodies in MuJoCo's order, the world first.
  std::vector<const MjcfElement*> bodies() const;
  // Where an attribute is written: at the element, or else in the defaults of its class; the
  // element itself if nowhere.
  MjcfPlace find(const MjcfElement& element, std::string_view attribute) const;

 private:
  void read_file(const std::string& path, MjcfElement* parent);
  void parse(std::string_view text, int file, MjcfElement* parent);
  MjcfElement* add(MjcfElement* parent, MjcfPlace place);
  const MjcfElement* default_class(std::string_view name) const;

  std::vector<std::string> files_;
  std::deque<MjcfElement> elements_;  // stable addresses
  MjcfElement top_;                   // its child is <mujoco>
};

}  // namespace footfall::model
