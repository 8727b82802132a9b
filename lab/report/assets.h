// The files of lab/report/web/ and the plotting library as text in the program; the build makes the
// source (lab/report/web/report_assets.cmake).
#pragma once

#include <string_view>

namespace footfall::lab {

extern const std::string_view kReportHtml;  // the page with {{places}}
extern const std::string_view kReportCss;
extern const std::string_view kReportJs;
extern const std::string_view kReportKeysJs;
extern const std::string_view kUplotJs;  // empty without npm
extern const std::string_view kUplotCss;
extern const std::string_view kUplotLicense;

}  // namespace footfall::lab
