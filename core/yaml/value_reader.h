// Typed access to YAML nodes for every loader: a value of the right kind and dimension, or an error
// at its exact place. Load time only.
//
// Every function reports to `diagnostics` and then returns an empty value (nullopt, nullptr,
// false), so that a loader goes on and finds all problems in one pass. `what` names the value in
// the message: `expected an angle, got '100 N'`; without it the dimension's name is used. A scalar
// that starts with `$` or `=` (parameter, expression) is not resolved here; callers that allow
// those check is_reference() / is_expression() first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/units/units.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// Describes a node for messages: `'100 N'` (at most 40 characters), `a list`, `a map`, `nothing`.
std::string describe(const YamlNode& node);
// "expected WHAT, got ..." at the node.
void report_expected(const YamlNode& node, std::string_view what, Diagnostics& diagnostics);

// Whether a scalar is a parameter reference `$name`, or an expression `= ...`.
bool is_reference(const YamlNode& node);
bool is_expression(const YamlNode& node);
// The plain scalar `off` (which removes an inherited entry).
bool is_off(const YamlNode& node);

// Checks the file's kind and version: the first key must be `kind`, its value 1..newest. Otherwise
// one error (id "kind" or "version") and false; the caller should stop reading. Null (file not
// read): false without a further error.
bool check_kind(const YamlNode& root, std::string_view kind, int newest, Diagnostics& diagnostics);

bool expect_map(const YamlNode& node, std::string_view what, Diagnostics& diagnostics);
bool expect_sequence(const YamlNode& node, std::string_view what, Diagnostics& diagnostics);
// Requires a scalar: neither empty, nor a list, nor a map.
bool expect_scalar(const YamlNode& node, std::string_view what, Diagnostics& diagnostics);
// Reports every key of a map that is not in `known` (id "unknown-key") with the nearest known one,
// and a `doc` that is not text (check_doc).
void check_keys(const YamlNode& map, const std::vector<std::string>& known,
                Diagnostics& diagnostics);
// Requires documentation text: a scalar. An unquoted number, `true` or `false` is refused, because
// it is more likely the value of another key.
bool check_doc(const YamlNode& node, Diagnostics& diagnostics);
// Warns about a text that YAML's comment cuts: `log: step #{n}`.
void warn_cut(const YamlNode& text, Diagnostics& diagnostics);
// Whether the map has a misspelt form of this key; then the error about that key is enough.
bool has_nearly(const YamlNode& map, std::string_view key);
// The value under a required key (id "missing-key" at the map, unless has_nearly()).
const YamlNode* require_key(const YamlNode& map, std::string_view key, Diagnostics& diagnostics);

// A number in SI units of the expected dimension; bare numbers are SI.
std::optional<double> read_quantity(const YamlNode& node, Dimension expected,
                                    Diagnostics& diagnostics, std::string_view what = {});
// Same for an optional key: writes `out` and returns true if the key is present and valid.
bool read_quantity(const YamlNode& map, std::string_view key, Dimension expected, double& out,
                   Diagnostics& diagnostics, std::string_view what = {});
// A quantity of any dimension.
std::optional<Quantity> read_any_quantity(const YamlNode& node, Diagnostics& diagnostics);
// read_quantity with minimum <= value <= maximum (SI); otherwise id "out-of-range".
std::optional<double> read_bounded(const YamlNode& node, Dimension expected, double minimum,
                                   double maximum, Diagnostics& diagnostics,
                                   std::string_view what = {});
// An integer without unit, minimum <= value <= maximum.
std::optional<std::int64_t> read_integer(const YamlNode& node, std::int64_t minimum,
                                         std::int64_t maximum, Diagnostics& diagnostics);
// A frequency that is an exact multiple of 1 mHz, in mHz, e.g. `1500 Hz` -> 1500000.
std::optional<std::int64_t> read_millihertz(const YamlNode& node, Diagnostics& diagnostics);

// Only an unquoted `true` or `false`.
std::optional<bool> read_bool(const YamlNode& node, Diagnostics& diagnostics);
// Non-empty text.
std::optional<std::string> read_text(const YamlNode& node, Diagnostics& diagnostics,
                                     std::string_view what = "a text");
// An identifier: letters, digits, `_`; begins with a letter or `_`; none of on off yes no true
// false.
std::optional<std::string> read_name(const YamlNode& node, Diagnostics& diagnostics,
                                     std::string_view what = "a name");
// Same check for a map's key, reported at the key.
bool check_name(const YamlEntry& entry, Diagnostics& diagnostics, std::string_view what = "a name");
bool is_name(std::string_view text);
// Names separated by dots, each of letters, digits, '_' and '-': `contact.left_foot.touchdown`.
bool is_dotted_name(std::string_view text);
// Index of a word in a fixed list. `expected WHAT: a, b or c, got 'd' (did you mean ...)`.
std::optional<int> read_choice(const YamlNode& node, const std::vector<std::string>& choices,
                               Diagnostics& diagnostics, std::string_view what = {});
// A sequence of texts; one scalar counts as a sequence of one.
std::optional<std::vector<std::string>> read_texts(const YamlNode& node, Diagnostics& diagnostics,
                                                   std::string_view what = "a name");

// `[a, b]`, in any order.
std::optional<std::array<double, 2>> read_pair(const YamlNode& node, Dimension expected,
                                               Diagnostics& diagnostics,
                                               std::string_view what = {});
// `[minimum, maximum]` with minimum <= maximum (id "range").
std::optional<std::array<double, 2>> read_range(const YamlNode& node, Dimension expected,
                                                Diagnostics& diagnostics,
                                                std::string_view what = {});
// A vector over named axes: a sequence with one value an axis, one number for all axes, or a map by
// axis (`{x: 1, z: 2}`; an omitted axis keeps `fallback`).
std::optional<std::vector<double>> read_vector(const YamlNode& node, Dimension expected,
                                               const std::vector<std::string>& axes,
                                               Diagnostics& diagnostics, double fallback = 0.0,
                                               std::string_view what = {});
// read_vector over x y z.
std::optional<std::array<double, 3>> read_vector3(const YamlNode& node, Dimension expected,
                                                  Diagnostics& diagnostics,
                                                  std::string_view what = {});

}  // namespace footfall::core
