// Finds the edit of an overlay that an error in its base follows from; see layers.h.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/units/units.h"
#include "core/yaml/edits.h"
#include "core/yaml/layers.h"
#include "core/yaml/value_reader.h"

namespace footfall::core {

namespace {

// Each one costs a load, with checks a tenth of a second more.
constexpr std::size_t kMostEdits = 200, kMostChecked = 40;

// Identifies a problem; its text may differ by a suggestion.
using Key = std::tuple<int, int, int, std::string>;
using Keys = std::set<Key>;

Key key_of(const Diagnostic& item) {
  return {item.mark.file, item.mark.line, item.mark.column, item.id};
}

YamlNode merge_layers(const YamlLayers& layers, EditCounter& counter) {
  Diagnostics ignored;  // reported by the first merge
  YamlNode tree = layers.files.front();
  for (std::size_t k = 1; k < layers.files.size(); ++k) {
    counter.layer = static_cast<int>(k);
    YamlNode own = layers.files[k];
    std::erase_if(own.entries, [](const YamlEntry& entry) { return entry.key == "base"; });
    if (layers.prepare != nullptr) layers.prepare(tree, own);
    merge_maps(tree, std::move(own), MergeRecorder{nullptr, &counter, {}}, ignored);
  }
  return tree;
}

// Whether a place lies within a node.
bool covers(const YamlNode& node, Mark mark) {
  const auto at = [&](Mark own) {
    return own.file == mark.file && own.line == mark.line && own.column == mark.column;
  };
  const auto inside = [&](Mark own) {  // within a scalar: an expression's own columns
    return own.file == mark.file && own.line == mark.line && mark.column >= own.column &&
           mark.column <= own.column + static_cast<int>(node.scalar.size()) + 1;
  };
  if (node.is_scalar() ? inside(node.mark) : at(node.mark)) return true;
  return std::any_of(node.items.begin(), node.items.end(),
                     [&](const YamlNode& item) { return covers(item, mark); }) ||
         std::any_of(node.entries.begin(), node.entries.end(), [&](const YamlEntry& entry) {
           return at(entry.key_mark) || covers(entry.value, mark);
         });
}

class Blame {
 public:
  Blame(const YamlLayers& layers, const Diagnostics& before, const Diagnostics& found,
        const TreeLoader& load, Blamed what)
      : layers_(layers), before_(before), found_(found), load_(load), what_(what) {
    all_ = new_ones(found);
  }

  Diagnostics run() {
    EditCounter counter;
    counter.edits = &edits_;
    merge_layers(layers_, counter);
    if (edits_.size() > (what_ == Blamed::all ? kMostChecked : kMostEdits)) return found_;
    for (std::size_t k = 0; k < edits_.size() && unexplained(); ++k) try_without(k);
    return blamed_.empty() && explained_.empty() ? found_ : result();
  }

 private:
  bool is_meant(const Diagnostic& item) const {
    return what_ == Blamed::all || item.severity == Severity::error;
  }

  Keys new_ones(const Diagnostics& diagnostics) const {
    Keys keys;
    for (std::size_t k = before_.all().size(); k < diagnostics.all().size(); ++k) {
      if (is_meant(diagnostics.all()[k])) keys.insert(key_of(diagnostics.all()[k]));
    }
    return keys;
  }

  int layer_of(int file) const {
    for (std::size_t k = 0; k < layers_.files.size(); ++k) {
      if (layers_.files[k].mark.file == file) return static_cast<int>(k);
    }
    return -1;
  }

  // Whether an error is left in a file that another one builds on.
  bool unexplained() const {
    return std::any_of(all_.begin(), all_.end(), [&](const Key& key) {
      const int layer = layer_of(std::get<0>(key));
      return layer >= 0 && layer + 1 < static_cast<int>(layers_.files.size()) &&
             !explained_.contains(key);
    });
  }

  // Errors that are gone without the edit, if no other ones come: else it is needed by others.
  void try_without(std::size_t index) {
    const YamlEdit& edit = edits_[index];
    EditCounter counter;
    counter.left_out = static_cast<int>(index);
    Diagnostics trial = before_;
    load_(merge_layers(layers_, counter), trial);
    const Keys left = new_ones(trial);
    if (!std::includes(all_.begin(), all_.end(), left.begin(), left.end())) return;
    bool below = false, direct = false;
    std::vector<Key> gone;
    for (const Key& key : all_) {
      if (left.contains(key) || explained_.contains(key)) continue;
      const int layer = layer_of(std::get<0>(key));
      const Mark mark{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
      if (layer == edit.layer && (covers(edit.now, mark) || same_place(edit.mark, mark))) {
        direct = true;
        continue;
      }
      if (layer < 0) continue;
      below = below || layer < edit.layer;
      gone.push_back(key);
    }
    if (!below) return;
    explained_.insert(gone.begin(), gone.end());
    if (!direct) blamed_.emplace_back(index, gone);
  }

  static bool same_place(Mark a, Mark b) {
    return a.file == b.file && a.line == b.line && a.column == b.column;
  }

  const Diagnostic& item_of(const Key& key) const {
    return *std::find_if(found_.all().begin(), found_.all().end(),
                         [&](const Diagnostic& item) { return key_of(item) == key; });
  }

  // The first error that follows from an edit, in a file below it.
  const Diagnostic& first_of(const YamlEdit& edit, const std::vector<Key>& gone) const {
    for (const Diagnostic& item : found_.all()) {
      if (!is_meant(item) || layer_of(item.mark.file) >= edit.layer) continue;
      if (std::find(gone.begin(), gone.end(), key_of(item)) != gone.end()) return item;
    }
    return item_of(gone.front());
  }

  std::string text_of(const YamlEdit& edit, const Diagnostic& first, std::size_t count) const {
    std::string text = first.text;
    const auto was = edit.old.is_scalar() ? parse_quantity(edit.old.scalar) : std::nullopt;
    const auto is = edit.now.is_scalar() ? parse_quantity(edit.now.scalar) : std::nullopt;
    if (was && is && !was->bare && !is->bare && !(was->dimension == is->dimension)) {
      text = fmt::format("expected {}, got {}", dimension_name(was->dimension), describe(edit.now));
    } else if (is_off(edit.now)) {
      text = fmt::format("'{}' is removed: {}", edit.path, text);
    }
    const std::string more = count > 1 ? fmt::format(" and {} more", count - 1) : "";
    const char* const how = what_ == Blamed::all ? "found" : "needed";
    return text + fmt::format(" ({} at {}{})", how, found_.place_text(first.mark), more);
  }

  Diagnostics result() const {
    Diagnostics out = before_;
    for (int k = 0; k < found_.file_count(); ++k) out.add_file(found_.file(k));
    for (const auto& [index, gone] : blamed_) {
      const Diagnostic& first = first_of(edits_[index], gone);
      out.add({first.severity, edits_[index].mark, first.id,
               text_of(edits_[index], first, gone.size())});
    }
    for (std::size_t k = before_.all().size(); k < found_.all().size(); ++k) {
      const Diagnostic& item = found_.all()[k];
      if (is_meant(item) && explained_.contains(key_of(item))) continue;
      out.add(item);
    }
    return out;
  }

  const YamlLayers& layers_;
  const Diagnostics& before_;
  const Diagnostics& found_;
  const TreeLoader& load_;
  const Blamed what_;
  Keys all_, explained_;
  std::vector<YamlEdit> edits_;
  std::vector<std::pair<std::size_t, std::vector<Key>>> blamed_;  // edits and their errors
};

}  // namespace

Diagnostics blame_edits(const YamlLayers& layers, const Diagnostics& before,
                        const Diagnostics& found, const TreeLoader& load, Blamed what) {
  if (layers.files.size() < 2) return found;
  return Blame(layers, before, found, load, what).run();
}

}  // namespace footfall::core
