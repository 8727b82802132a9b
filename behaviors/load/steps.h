// Loader steps before and after chart and control: tree, overrides, parameters, templates, unused
// names. Load time only.
#pragma once

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// Substitutes arguments in a tree: whole scalars, keys, parts of dotted names and of expressions.
// An error in such a text is reported at the argument, unless that is a name of the robot.
core::YamlNode substitute(const core::YamlNode& node, const Arguments& arguments,
                          const model::RobotDescription& robot);

// Loads a behavior's file, or its text, with its bases (tree.cc); the files one by one go to
// `layers` if it is given.
core::YamlNode load_tree(const std::string& path, const LoadOptions& options,
                         core::Diagnostics& diagnostics, core::YamlLayers* layers = nullptr);
core::YamlNode load_tree_text(std::string_view text, const std::string& name,
                              const LoadOptions& options, core::Diagnostics& diagnostics,
                              core::YamlLayers* layers = nullptr);

void apply_overrides(LoadContext& context);      // overrides.cc
void load_parameters(LoadContext& context);      // parameters.cc
void load_estimator(LoadContext& context);       // estimator.cc
void expand_machine(LoadContext& context);       // template.cc
void check_machine_names(LoadContext& context);  // template.cc
void warn_absences(LoadContext& context);        // unused.cc

// Reports every `$name` left in a name or key that is not a parameter (template.cc).
void check_resolved(LoadContext& context, const core::YamlNode& node);

}  // namespace footfall::behaviors
