// The HTML page that every report is in.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace footfall::lab {

struct ReportPage {
  std::string title;     // text
  std::string subtitle;  // HTML; likewise below
  std::string nav, body;
  std::string css;          // the whole style sheet
  std::string data = "{}";  // JSON for the page's script
  std::string library;      // script that the page's own needs
  std::string footer =
      "Drag in a plot to zoom, double-click for the whole run; press ? for keys. "
      "SI units, z up.";
};

// The template lab/report/web/report.html, filled.
std::string fill_page(const ReportPage& page);

// A text with each {{name}} replaced by its value, by nothing if it has none; what is put in is not
// searched again.
std::string fill_template(std::string_view text,
                          const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace footfall::lab
