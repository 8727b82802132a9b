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

// Throws InputError (`--film: error: expected a file named *.mp4, got 'x.gif'`) for another ending:
// the encoder makes MP4, and would say so only after the run. Empty is none.
void require_film_name(const std::string& path);

}  // namespace footfall::apps
