// The report of a sweep: one HTML page that works offline.
#pragma once

#include <string>

#include "lab/report/sections.h"
#include "lab/sweep/results/factors.h"

namespace footfall::lab {

std::string sweep_report_html(const SweepTable& table);

// The sections of the page in order; empty if the table has no data for them.
Section sweep_summary_section(const SweepTable& table);
Section sweep_share_section(const SweepTable& table, const std::vector<SweepFactor>& factors);
Section sweep_map_section(const SweepTable& table, const std::vector<SweepFactor>& factors);
Section sweep_sensitivity_section(const SweepTable& table, const std::vector<SweepFactor>& factors);
Section sweep_worst_section(const SweepTable& table);
Section sweep_settings_section(const SweepTable& table);

}  // namespace footfall::lab
