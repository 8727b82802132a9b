// The reference as Markdown; see reference.h.
#include "apps/reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/reference/reference_signals.h"
#include "apps/reference/value_text.h"
#include "apps/shared/commands.h"
#include "behaviors/expression/statistics.h"
#include "behaviors/language/language.h"
#include "core/fault.h"
#include "core/units/unit_list.h"
#include "model/robot/fault_rules.h"
#include "model/robot/keys.h"
#include "tasks/task_types.h"

namespace footfall::apps {
namespace {

using core::KeySpec;
using core::KeyTable;
using core::WordSpec;

constexpr std::string_view kHead = R"(# Reference

Every key, word, signal and event of Footfall's files. Printed by `footfall reference` from the tables that the loader
uses, so the two cannot differ. [behaviors.md](behaviors.md) teaches the language;
[editor.md](editor.md) brings these tables into an editor.

[Values](#values) · [Behavior files](#behavior-files) · [Task types](#task-types) · [Expressions](#expressions) ·
[Events](#events) · [Faults](#faults) · [Signals](#signals) · [Robot files](#robot-files) · [World files](#world-files) · [Sweep files](#sweep-files)

In the tables, **bold** keys are required. `NAME` is a user-defined name.

## Values

A number has its unit: `16 ms`, `100 N`, `220 1/s^2`, `440 Nm/rad`. A bare number is SI. Every key has a dimension,
another one is an error. An angle has no dimension: `rad` is 1. `$name` is a parameter or a template's argument. Where
the tables say *expression*, a text that begins with `=` is computed at run time, and a single signal name needs no `=`.
*One an axis* is one number for all axes, a list in the order of `axes`, or a map by axis (by joint, with globs such as
`"*knee"`). `NAME: off` removes what a base, a stack or a template has under that name.

| dimension | units |
|---|---|
)";

// A bar would end the table cell.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

std::string units() {
  std::vector<core::Dimension> order;
  std::vector<std::string> names;
  for (const core::UnitInfo& unit : core::all_units()) {
    const auto found = std::find(order.begin(), order.end(), unit.dimension);
    const auto k = static_cast<std::size_t>(found - order.begin());
    if (found == order.end()) {
      order.push_back(unit.dimension);
      names.emplace_back();
    }
    names[k] += fmt::format("{}`{}`", names[k].empty() ? "" : " ", unit.name);
  }
  std::string out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    std::string name = core::dimension_name(order[k]);
    name = name.substr(name.find(' ') + 1);
    out += fmt::format("| {} | {} |\n", name, names[k]);
  }
  return out + "\nUnits multiply and divide: `kg m^2`, `1/s^2`, `Nm/rad`.\n";
}

void add_words(const KeyTable& table, std::string& out) {
  for (const KeySpec& key : table.keys) {
    for (const core::ValueSpec& value : key.values) {
      for (const WordSpec& word : value.words) {
        if (&word == value.words.data()) out += fmt::format("\n`{}`:\n\n", key.name);
        out += fmt::format("- `{}`: {}\n", word.word, word.doc);
      }
    }
  }
}

std::string section(const KeyTable& table) {
  std::string out = fmt::format("\n### {}\n\n{}", table.id, table.doc);
  if (table.more != nullptr) out += fmt::format(" All keys of [{0}](#{0}), and:", table.more->id);
  out += "\n\n| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const KeySpec& key : table.keys) {
    const char* mark = key.needed ? "**" : "";
    std::string doc(key.doc);
    if (!key.variants.empty()) doc += fmt::format(" (only {})", alternatives_text(key.variants));
    out += fmt::format("| {0}`{1}`{0} | {2} | {3} | {4} |\n", mark, key.name,
                       cell(values_text(key, true)), cell(key.fallback), cell(doc));
  }
  if (table.others != nullptr) {
    out += fmt::format("| `NAME` of {} | {} | | |\n", table.others_name,
                       cell(value_text(*table.others, true)));
  }
  for (const std::string_view words : table.one_of) {
    if (!words.empty()) {
      out += fmt::format("\nAt least one of {} is required.\n", alternatives_text(words));
    }
  }
  add_words(table, out);
  return out;
}

std::string sections(const core::FileTable& file) {
  std::string out;
  for (const KeyTable* table : core::tables_of(file)) out += section(*table);
  return out;
}

std::string task_types() {
  std::string out =
      "\n## Task types\n\nEach axis asks for the acceleration u = x''_ref + kp e + ki ∫e + kd e'. "
      "Gains have the same units for all: `kp` 1/s^2, `ki` 1/s^3, `kd` 1/s.\n\n"
      "| type | axes | reference in | controls |\n|---|---|---|---|\n";
  for (const tasks::TaskTypeRow& row : tasks::kTaskTypes) {
    const tasks::TaskTypeInfo& type = row.info;
    std::string axes;
    for (const tasks::AxisInfo& axis : type.axes) {
      axes += fmt::format("{}{}", axes.empty() ? "" : " ", axis.name);
    }
    if (type.of_joints()) axes = "the robot's joints (`joints`)";
    std::vector<std::string> units;
    for (int axis = 0; type.has_reference && axis < type.axis_count(1); ++axis) {
      const core::Dimension dimension = type.dimension(axis);
      const std::string unit = dimension == core::kNone ? "rad" : core::unit_text(dimension);
      if (units.empty() || units.back() != unit) units.push_back(unit);
    }
    const std::string unit =
        type.has_reference ? fmt::format("{}", fmt::join(units, " and ")) : "none";
    out += fmt::format("| `{}` | {} | {} | {} |\n", type.name, axes, unit, type.doc);
  }
  return out;
}

std::string words_table(std::span<const WordSpec> words, std::string_view head) {
  std::string out = fmt::format("\n| {} | meaning |\n|---|---|\n", head);
  for (const WordSpec& word : words) {
    out += fmt::format("| `{}` | {} |\n", cell(word.word), cell(word.doc));
  }
  return out;
}

std::string statistics() {
  std::string out =
      "\nStatistics of one signal (or of its `abs`) over a time, in the expectations of a "
      "scenario:\n\n| statistic | meaning |\n|---|---|\n";
  for (const behaviors::Statistic& statistic : behaviors::kStatistics) {
    out += fmt::format("| `{}(SIGNAL)` | {} |\n", statistic.name, statistic.doc);
  }
  return out;
}

std::string expressions() {
  return "\n## Expressions\n\nChecked for dimensions and compiled at load. Names:\n" +
         words_table(behaviors::kExpressionNames, "name") +
         "\nOperators, from lowest to highest precedence:\n" +
         words_table(behaviors::kExpressionOperators, "operator") + "\nFunctions:\n" +
         words_table(behaviors::kExpressionFunctions, "function") + statistics();
}

std::string events() {
  return "\n## Events\n\nUser-defined events are raised by `raise`, or externally if `events` "
         "lists "
         "them. Built-in events:\n" +
         words_table(behaviors::kEventFamilies, "event") +
         "\n`on` takes a name, a list of names, a prefix (`fault.*`: `fault` and all below), or "
         "`\"*\"`.\n";
}

std::string faults() {
  std::string out =
      "\n## Faults\n\nEach raises the event `fault.NAME` and has the reaction of the robot file's "
      "`faults`; [faults.md](faults.md) describes each.\n\n"
      "| fault | when | default reaction |\n|---|---|---|\n";
  for (const model::FaultRule& rule : model::fault_rules()) {
    const auto word = model::kReactions[static_cast<std::size_t>(rule.otherwise)].word;
    out += fmt::format("| `{}` | {} | {}{} |\n", core::fault_name(rule.fault), rule.when, word,
                       rule.refusing.empty() ? "" : "; never `continue`");
  }
  return out;
}

}  // namespace

std::string reference_markdown() {
  std::string out = std::string(kHead) + units();
  for (const core::FileTable* file : file_tables()) {
    std::string title(file->kind);
    title[0] = static_cast<char>(title[0] - 'a' + 'A');
    out += fmt::format("\n## {} files\n{}", title, sections(*file));
    if (file->kind == "behavior") {
      out += task_types() + expressions() + events() + faults() + signals_markdown();
    }
  }
  return out;
}

}  // namespace footfall::apps
