// The single edits that a file makes to its base, while both are merged; see layers.h.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/yaml/yaml.h"

namespace footfall::core {

// One entry of a file over its base: a new, replacing, removing or appending one.
struct YamlEdit {
  std::string path;
  Mark mark;     // of the entry's value, of its key if the value is a map
  YamlNode old;  // null if the base has none
  YamlNode now;
  int layer = 0;  // index of the file in YamlLayers
};

// Counts the edits while layers are merged, and leaves one out.
struct EditCounter {
  int left_out = -1;                       // index of the edit that is not made
  int count = 0;                           // edits so far
  int layer = 0;                           // file that is being merged
  std::vector<YamlEdit>* edits = nullptr;  // receives all edits, if it is given
};

// Destinations of what happens while a map is merged, and the map's path.
struct MergeRecorder {
  YamlHistory* history = nullptr;
  EditCounter* counter = nullptr;
  std::string path{};

  MergeRecorder inside(const std::string& key) const {
    return {history, counter, path.empty() ? key : path + "." + key};
  }
  void add(YamlChange::Kind kind, const std::string& key, const YamlNode& old, Mark mark,
           YamlNode now) const {
    if (history == nullptr) return;
    history->push_back({kind, inside(key).path, old, mark, std::move(now)});
  }
  // Counts the entry as an edit; whether it is the one to be left out.
  bool leaves_out(const YamlEntry& entry, const YamlEntry* old) const {
    if (counter == nullptr) return false;
    if (counter->edits != nullptr) {
      counter->edits->push_back(
          {inside(entry.key).path, entry.value.is_map() ? entry.key_mark : entry.value.mark,
           old == nullptr ? YamlNode{} : old->value, entry.value, counter->layer});
    }
    return counter->count++ == counter->left_out;
  }
};

// Merges `own` over `base`, map by map.
void merge_maps(YamlNode& base, YamlNode&& own, const MergeRecorder& recorder,
                Diagnostics& diagnostics);

}  // namespace footfall::core
