// HTML page template; see page.h.
#include "lab/report/page.h"

#include "lab/report/assets.h"
#include "lab/report/plot.h"

namespace footfall::lab {
std::string fill_template(std::string_view page,
                          const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string out;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    const std::size_t close = open == std::string_view::npos ? open : page.find("}}", open);
    if (close == std::string_view::npos) return out.append(page.substr(at));
    out += page.substr(at, open - at);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : values) {
      if (key == name) out += value;
    }
    at = close + 2;
  }
  return out;
}

std::string fill_page(const ReportPage& page) {
  return fill_template(kReportHtml, {{"title", escape_html(page.title)},
                                     {"subtitle", page.subtitle},
                                     {"nav", page.nav},
                                     {"body", page.body},
                                     {"css", page.css},
                                     {"footer", escape_html(page.footer)},
                                     {"data", page.data},
                                     {"library", page.library},
                                     {"script", std::string(kReportJs)},
                                     {"keys", std::string(kReportKeysJs)}});
}

}  // namespace footfall::lab
