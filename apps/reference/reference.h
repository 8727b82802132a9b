// The reference of all file formats as Markdown, from the same tables as the loader:
// docs/reference.md.
#pragma once

#include <string>

namespace footfall::apps {

std::string reference_markdown();

}  // namespace footfall::apps
