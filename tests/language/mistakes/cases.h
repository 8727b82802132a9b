// Mistakes in files, and the diagnostics that they must get. A case file holds, by name:
//
//     base: NAME                  the default of its cases
//     cases:
//       NAME:
//         base: NAME              a text of bases.yaml, which has no mistake
//         change: {OLD: NEW}      each OLD occurs once in the text, and is replaced in turn
//         text: TEXT              instead of base and change
//         set: {PARAMETER: VALUE} optional, as after `footfall check --set`
//         files: {NAME: TEXT}     optional, files beside the text
//         at: LINE:COLUMN         place of a diagnostic outside the texts; 0:0 is the whole file
//         expect: {ID: PART}      id of the diagnostic, part of its message; several are a list
//
// A '@' marks the place of a diagnostic in a text, in the order of `expect`, and is not part of it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace footfall::tests {

struct ExpectedDiagnostic {
  std::string file;  // name without folder; empty if `at` gives the place
  int line = 0, column = 0;
  std::string id, part;
};

struct TextFile {
  std::string name, text;
};

struct MistakeCase {
  std::string name;             // FILE.yaml: CASE
  std::vector<TextFile> files;  // the file that is loaded, then those beside it
  std::vector<std::pair<std::string, std::string>> set;
  std::vector<ExpectedDiagnostic> expected;
};

// The texts of bases.yaml by name.
std::vector<TextFile> read_bases(const std::string& folder);
// All cases of a case file. Malformed case files throw std::runtime_error.
std::vector<MistakeCase> read_cases(const std::string& path, const std::vector<TextFile>& bases);

}  // namespace footfall::tests
