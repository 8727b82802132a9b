// Names characters that look like others; see look_alike.h.
#include "core/text/look_alike.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace footfall::core {
namespace {

struct Range {
  char32_t first, last;
  std::string_view name;
  std::string_view typed;  // on a keyboard; empty: delete it, or it depends
  bool blank;
};

constexpr auto kRanges = std::to_array<Range>({
    {0x00a0, 0x00a0, "no-break space", " ", true},
    {0x00ab, 0x00ab, "quotation mark", "\"", false},
    {0x00ad, 0x00ad, "soft hyphen", "", true},
    {0x00b7, 0x00b7, "middle dot", "", false},
    {0x00bb, 0x00bb, "quotation mark", "\"", false},
    {0x00d7, 0x00d7, "multiplication sign", "*", false},
    {0x0370, 0x03bb, "Greek letter", "", false},
    {0x03bd, 0x03ff, "Greek letter", "", false},  // without mu, which is in units
    {0x0400, 0x04ff, "Cyrillic letter", "", false},
    {0x1680, 0x1680, "Ogham space mark", " ", true},
    {0x180e, 0x180e, "vowel separator", "", true},
    {0x2000, 0x200a, "space of another width", " ", true},
    {0x200b, 0x200b, "zero-width space", "", true},
    {0x200c, 0x200c, "zero-width non-joiner", "", true},
    {0x200d, 0x200d, "zero-width joiner", "", true},
    {0x200e, 0x200f, "direction mark", "", true},
    {0x2010, 0x2011, "hyphen", "-", false},
    {0x2012, 0x2015, "dash", "-", false},
    {0x2018, 0x201b, "quotation mark", "'", false},
    {0x201c, 0x201f, "quotation mark", "\"", false},
    {0x2028, 0x2028, "line separator", " ", true},
    {0x2029, 0x2029, "paragraph separator", " ", true},
    {0x202a, 0x202e, "direction control", "", true},
    {0x202f, 0x202f, "narrow no-break space", " ", true},
    {0x2032, 0x2033, "prime", "'", false},
    {0x2044, 0x2044, "fraction slash", "/", false},
    {0x205f, 0x205f, "mathematical space", " ", true},
    {0x2060, 0x2060, "word joiner", "", true},
    {0x2061, 0x2064, "invisible operator", "", true},
    {0x2066, 0x2069, "direction control", "", true},
    {0x2212, 0x2212, "minus sign", "-", false},
    {0x2215, 0x2215, "division slash", "/", false},
    {0x2217, 0x2217, "asterisk operator", "*", false},
    {0x2236, 0x2236, "ratio", ":", false},
    {0x2260, 0x2260, "not equal", "!=", false},
    {0x2264, 0x2264, "less or equal", "<=", false},
    {0x2265, 0x2265, "greater or equal", ">=", false},
    {0x22c5, 0x22c5, "dot operator", "*", false},
    {0x3000, 0x3000, "ideographic space", " ", true},
    {0x3001, 0x3001, "ideographic comma", ",", false},
    {0xfeff, 0xfeff, "byte order mark", "", true},
    {0xff01, 0xff5e, "full-width form", "", false},
});

struct Decoded {
  char32_t code = 0;
  std::size_t length = 1;
};

// Invalid bytes are decoded as themselves, one by one; they are reported elsewhere.
Decoded decode(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned lead = byte(0);
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc2 ? 2 : 1;
  if (length == 1 || text.size() < length) return {lead < 0x80 ? lead : 0, 1};
  char32_t code = lead & (0xffU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xc0U) != 0x80U) return {0, 1};
    code = (code << 6U) | (byte(k) & 0x3fU);
  }
  return {code, length};
}

const Range* range_of(char32_t code) {
  if (code < 0xa0) return nullptr;
  const auto found = std::find_if(kRanges.begin(), kRanges.end(), [code](const Range& range) {
    return code >= range.first && code <= range.last;
  });
  return found == kRanges.end() ? nullptr : &*found;
}

// What the key of the same shape writes.
std::string typed(const Range& range, char32_t code) {
  if (range.first == 0xff01) return std::string(1, static_cast<char>(code - 0xff01 + '!'));
  return std::string(range.typed);
}

}  // namespace

std::optional<LookAlike> find_look_alike(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const Decoded character = decode(text.substr(at));
    if (const Range* range = range_of(character.code)) {
      LookAlike found{at, character.length, character.code, {}, {}, range->blank};
      found.name =
          fmt::format("U+{:04X} ({})", static_cast<std::uint32_t>(character.code), range->name);
      const std::string key = typed(*range, character.code);
      if (key == " ") {
        found.advice = "type a blank";
      } else if (range->blank) {
        found.advice = "delete it";
      } else if (!key.empty()) {
        found.advice = fmt::format("type {}", key == "'" || key == "\"" ? key : "'" + key + "'");
      }
      return found;
    }
    at += character.length;
  }
  return std::nullopt;
}

std::string look_alike_hint(std::string_view text) {
  const auto found = find_look_alike(text);
  if (!found) return {};
  return fmt::format("; it has {}{}{}", found->name, found->advice.empty() ? "" : ": ",
                     found->advice);
}

std::string without_look_alikes(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const Decoded character = decode(text.substr(at));
    const Range* range = range_of(character.code);
    const std::string key = range == nullptr ? std::string() : typed(*range, character.code);
    if (range == nullptr || (key.empty() && !range->blank)) {
      out += text.substr(at, character.length);
    } else {
      out += key;
    }
    at += character.length;
  }
  const std::size_t begin = std::min(out.find_first_not_of(' '), out.size());
  const std::size_t end = out.find_last_not_of(' ');
  return end == std::string::npos ? std::string() : out.substr(begin, end + 1 - begin);
}

std::string_view character_at(std::string_view text, std::size_t offset) {
  return text.substr(offset, decode(text.substr(offset)).length);
}

}  // namespace footfall::core
