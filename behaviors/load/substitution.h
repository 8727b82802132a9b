// Substitutes template arguments in text. Inside an expression a substituted part is framed by two
// control bytes, so that errors behind it are still reported at their column in the file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::behaviors {

inline constexpr char kMarkBegin = '\x01';  // followed by one byte: length of the replaced text
inline constexpr char kMarkEnd = '\x02';

// An expression without its frames.
struct MarkedText {
  std::string text;
  std::vector<int> columns;  // by byte of `text`: offset in the file's text
  std::vector<bool> inside;  // by byte of `text`: in a substituted part
  int column(int offset) const;
  // Whether the word that begins there has a substituted part: `contact.$swing`.
  bool is_inside(int offset) const;
};

MarkedText read_marked(std::string_view text);

}  // namespace footfall::behaviors
