// Outputs on the command line.
#pragma once

#include <string>
#include <vector>

namespace footfall::apps {

// Throws InputError (`-o: error: 'x.yaml' is a file that this command reads`) if the output, by
// whatever name, is one of the inputs, or a folder. Empty, `-` and what does not exist yet are
// none.
void require_no_input(const char* option, const std::string& output,
                      const std::vector<std::string>& inputs);

}  // namespace footfall::apps
