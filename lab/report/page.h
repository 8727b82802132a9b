// The HTML page common to all reports.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace footfall::lab {

struct ReportPage {
  std::string title;     // plain text
  std::string subtitle;  // HTML; likewise below
  std::string nav, body;
  std::string css;          // complete style sheet
  std::string data = "{}";  // JSON for the page's script
  std::string library;      // script required by the page's own script
  std::string footer =
      "Drag in a plot to zoom, double-click for the whole run; press ? for keys. "
      "SI units, z up.";
};

// Fills the template lab/report/web/report.html.
std::string fill_page(const ReportPage& page);

// Replaces each {{name}} in a text by its value, or by nothing if unknown; inserted text is not
// searched again.
std::string fill_template(std::string_view text,
                          const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace footfall::lab
