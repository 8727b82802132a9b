// JSON Schema from key tables; see json_schema.h.
#include "apps/reference/json_schema.h"

#include <fmt/format.h>

#include <cctype>
#include <set>

#include "apps/reference/scalar_patterns.h"
#include "apps/reference/value_text.h"

namespace footfall::apps {
namespace {

using core::KeySpec;
using core::KeyTable;
using core::ValueForm;
using core::ValueKind;
using core::ValueSpec;
using Json = nlohmann::ordered_json;

std::string anchored(const std::string& pattern) { return "^(" + pattern + ")$"; }

bool is_list(const ValueSpec& value) {
  return value.form == ValueForm::list || value.form == ValueForm::pair ||
         value.form == ValueForm::pairs;
}

// Writes the definitions of a file's maps. Maps with required keys have two definitions: in a file
// with `base:`, or in a map merged over another, required keys may be absent.
class SchemaWriter {
 public:
  explicit SchemaWriter(const core::FileTable& file) : file_(file) {}

  Json write() {
    Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                   {"title", fmt::format("Footfall {} file", file_.kind)},
                   {"description", std::string(file_.root->doc)},
                   {"type", "object"}};
    const Json whole = refer(*file_.root, false);
    const Json part = refer(*file_.root, true);
    schema["if"] = {{"required", {"base"}}};
    schema["then"] = part;
    schema["else"] = whole;
    schema["definitions"] = std::move(definitions_);
    return schema;
  }

 private:
  // Whether a table or a table nested in it requires keys; not through lists, which are always
  // complete.
  static bool needs_keys(const KeyTable& table, std::set<const KeyTable*>& seen) {
    if (!seen.insert(&table).second) return false;
    if (!table.part && !table.one_of[0].empty()) return true;
    for (const KeySpec& key : table.keys) {
      if (key.needed && !table.part) return true;
      for (const ValueSpec& value : key.values) {
        if (value.map != nullptr && !is_list(value) && needs_keys(*value.map, seen)) return true;
      }
    }
    if (table.others != nullptr && table.others->map != nullptr &&
        needs_keys(*table.others->map, seen)) {
      return true;
    }
    return table.more != nullptr && needs_keys(*table.more, seen);
  }

  Json refer(const KeyTable& table, bool part) {
    std::set<const KeyTable*> seen;
    const bool differs = part && needs_keys(table, seen);
    const std::string name = std::string(table.id) + (differs ? "_part" : "");
    if (!definitions_.contains(name)) {
      definitions_[name] = nullptr;  // the table may contain itself
      definitions_[name] = map_schema(table, differs);
    }
    return {{"$ref", "#/definitions/" + name}};
  }

  Json map_schema(const KeyTable& table, bool part) {
    Json out = {{"description", std::string(table.doc)}, {"type", {"object", "string"}}};
    if (&table == file_.root) out["type"] = "object";
    if (table.empty) out["type"].push_back("null");
    out["pattern"] = anchored(substituted_pattern());
    out["patternErrorMessage"] = fmt::format("expected a map: {}", table.id);
    Json properties = Json::object();
    Json lists = Json::array();
    add_properties(table, part, properties, lists);
    out["properties"] = std::move(properties);
    if ((part || table.part) && !lists.empty()) {
      std::string names;
      for (const auto& name : lists) names += (names.empty() ? "" : "|") + name.get<std::string>();
      out["patternProperties"] = {{fmt::format("^({})\\+$", names), {{"type", "array"}}}};
    }
    if (table.others != nullptr) {
      out["additionalProperties"] = value_schema({*table.others, {}, {}}, part);
    } else {
      out["additionalProperties"] = false;
    }
    if (!part && !table.part) add_needed(table, out);
    add_variants(table, out);
    return out;
  }

  void add_properties(const KeyTable& table, bool part, Json& properties, Json& lists) {
    for (const KeySpec& key : table.keys) {
      Json value = value_schema(key.values, part);
      Json property = {{"description", hover_text(key)}};
      property.update(value);
      property["description"] = hover_text(key);
      properties[std::string(key.name)] = std::move(property);
      if (is_list(key.values[0]) || key.values[0].form == ValueForm::one_or_list) {
        lists.push_back(std::string(key.name));
      }
    }
    if (table.more != nullptr) add_properties(*table.more, part, properties, lists);
  }

  static void add_needed(const KeyTable& table, Json& out) {
    Json needed = Json::array();
    for (const KeySpec& key : table.keys) {
      if (key.needed) needed.push_back(std::string(key.name));
    }
    if (!needed.empty()) out["required"] = std::move(needed);
    for (std::string_view words : table.one_of) {
      Json choices = Json::array();
      while (!words.empty()) {
        const std::size_t blank = words.find(' ');
        choices.push_back({{"required", {std::string(words.substr(0, blank))}}});
        words = blank == std::string_view::npos ? std::string_view() : words.substr(blank + 1);
      }
      if (!choices.empty()) out["allOf"].push_back({{"anyOf", std::move(choices)}});
    }
  }

  // If the selector is present, keys of other variants are refused.
  static void add_variants(const KeyTable& table, Json& out) {
    const std::string selector(table.selector);
    for (const core::WordSpec& word : table.variants) {
      Json wrong = Json::object();
      for (const KeySpec& key : table.keys) {
        if (!core::belongs_to(key, word.word)) wrong[std::string(key.name)] = false;
      }
      if (wrong.empty()) continue;
      const Json is_it = {{"required", {selector}},
                          {"properties", {{selector, {{"const", std::string(word.word)}}}}}};
      out["allOf"].push_back({{"if", is_it}, {"then", {{"properties", std::move(wrong)}}}});
    }
  }

  Json value_schema(const std::array<ValueSpec, 3>& values, bool part) {
    if (values[0].kind == ValueKind::any) return Json::object();
    if (values[0].named) {
      std::array<ValueSpec, 3> inner = values;
      for (ValueSpec& value : inner) value.named = false;
      // `stack: NAME` and `gains: {TASK: ...}`: alternatives of a name and a map by name.
      return {{"type", "object"}, {"additionalProperties", value_schema(inner, part)}};
    }
    if (values[1].kind != ValueKind::none && values[1].form == ValueForm::list &&
        values[0].form == ValueForm::list) {  // each item matches one of them
      std::array<ValueSpec, 3> items = values;
      for (ValueSpec& value : items) value.form = ValueForm::one;
      return or_removed({{"type", "array"}, {"items", value_schema(items, false)}});
    }
    Json choices = Json::array();
    const KeyTable* selected = nullptr;  // a map that has its own keys, unlike a map by axis
    for (const ValueSpec& value : values) {
      if (value.kind == ValueKind::map && !value.map->selector.empty() &&
          values[0].form == ValueForm::by_axis) {
        selected = value.map;
      } else if (value.kind != ValueKind::none && value.named) {
        ValueSpec inner = value;
        inner.named = false;
        choices.push_back(
            {{"type", "object"}, {"additionalProperties", value_schema({inner, {}, {}}, part)}});
      } else if (value.kind != ValueKind::none) {
        choices.push_back(one_schema(value, part));
      }
    }
    if (selected != nullptr) return axis_or_map(values[0], *selected, part);
    if (choices.size() == 1) return choices[0];
    return {{"anyOf", std::move(choices)}};
  }

  // A map with any key of the table is of that kind; editors offer the selector in an empty map.
  Json axis_or_map(const ValueSpec& by_axis, const KeyTable& table, bool part) {
    Json otherwise = one_schema(by_axis, part);
    const std::string selector(table.selector);
    const KeySpec& key = *core::find_key(table, selector);
    otherwise["properties"] = {{selector, value_schema(key.values, part)}};
    otherwise["properties"][selector]["description"] = hover_text(key);
    Json any = Json::array();
    for (const std::string& name : core::key_names(table)) any.push_back({{"required", {name}}});
    return {{"if", {{"type", "object"}, {"anyOf", std::move(any)}}},
            {"then", refer(table, part)},
            {"else", std::move(otherwise)}};
  }

  // Values in lists are complete.
  Json one_schema(const ValueSpec& value, bool part) {
    ValueSpec item = value;
    item.form = ValueForm::one;
    switch (value.form) {
      case ValueForm::one:
        break;
      case ValueForm::list:
        return or_removed({{"type", "array"}, {"items", one_schema(item, false)}});
      case ValueForm::one_or_list:
        return {{"anyOf",
                 {one_schema(item, false),
                  {{"type", "array"}, {"items", one_schema(item, false)}, {"minItems", 1}}}}};
      case ValueForm::pair:
        return or_removed(pair_of(one_schema(item, false)));
      case ValueForm::pairs:
        return or_removed({{"type", "array"}, {"items", pair_of(one_schema(item, false))}});
      case ValueForm::by_axis: {
        Json out = quantity_schema(item);  // each keyword constrains one type only
        const Json one = shared(out);
        out["type"].push_back("array");
        out["type"].push_back("object");
        out["items"] = one;
        out["additionalProperties"] = one;
        return out;
      }
    }
    return scalar_schema(value, part);
  }

  static Json pair_of(const Json& item) {
    return {{"type", "array"}, {"items", item}, {"minItems", 2}, {"maxItems", 2}};
  }

  // `$name` and `off` may replace a list, too.
  static Json or_removed(Json list) {
    list["type"] = {"array", "string"};
    list["pattern"] = anchored(substituted_pattern());
    list["patternErrorMessage"] = "expected a list";
    return list;
  }

  Json scalar_schema(const ValueSpec& value, bool part) {
    const std::string expected = "expected " + value_text(value, false);
    switch (value.kind) {
      case ValueKind::map:
        return refer(*value.map, part);
      case ValueKind::choice:
        return choice_schema(value);
      case ValueKind::boolean:
        return texts({"boolean", "string"}, substituted_pattern(), expected);
      case ValueKind::integer: {
        Json out = texts({"integer", "string"}, substituted_pattern(), expected);
        out["minimum"] = value.ends[0];
        out["maximum"] = value.ends[1];
        return out;
      }
      case ValueKind::quantity:
      case ValueKind::any_quantity:
        return shared(quantity_schema(value));
      case ValueKind::condition:
        return {{"type", {"string", "boolean", "number"}}};
      case ValueKind::text:
        return {{"type", {"string", "number", "boolean"}}};
      default:
        return {{"type", "string"}, {"minLength", 1}};
    }
  }

  static Json texts(Json types, const std::string& pattern, const std::string& expected) {
    return {{"type", std::move(types)},
            {"pattern", anchored(pattern)},
            {"patternErrorMessage", expected}};
  }

  // Stores long patterns once, named after their error message.
  Json shared(Json value) {
    std::string name = value["patternErrorMessage"].get<std::string>().substr(9);  // "expected "
    for (char& c : name) {
      if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    if (value["type"].size() > 2) name += "_by_axis";
    definitions_[name] = std::move(value);
    return {{"$ref", "#/definitions/" + name}};
  }

  static Json quantity_schema(const ValueSpec& value) {
    return texts({"number", "string"}, text_pattern(value) + "|" + substituted_pattern(),
                 "expected " + value_text(value, false));
  }

  static Json choice_schema(const ValueSpec& value) {
    Json words = Json::array();
    Json docs = Json::array();
    for (const core::WordSpec& word : value.words) {
      words.push_back(std::string(word.word));
      docs.push_back(std::string(word.doc));
    }
    const Json listed = {{"enum", std::move(words)}, {"enumDescriptions", std::move(docs)}};
    const Json named =
        texts({"string"}, substituted_pattern(), "expected " + value_text(value, false));
    return {{"anyOf", {listed, named}}};
  }

  const core::FileTable& file_;
  Json definitions_ = Json::object();
};

}  // namespace

nlohmann::ordered_json json_schema(const core::FileTable& file) {
  return SchemaWriter(file).write();
}

}  // namespace footfall::apps
