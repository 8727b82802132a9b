// Text of people is text, in a page and in a terminal.
#include "core/text/escape.h"

#include <gtest/gtest.h>

#include "core/text/printable.h"

namespace footfall::core {
namespace {

TEST(EscapeTest, SignsOfHtmlBecomeEntitiesAndControlCharactersBlanks) {
  EXPECT_EQ(escape_html("a < b && c > \"d\"\n"), "a &lt; b &amp;&amp; c &gt; &quot;d&quot; ");
  EXPECT_EQ(escape_html("Größe µ"), "Größe µ");
  EXPECT_EQ(escape_html(""), "");
}

TEST(PrintableTest, NothingMovesACursorOrBreaksACharacter) {
  EXPECT_EQ(printable("ann\x1b[2J\r\n\x7f\t", 99), "ann?[2J????");
  EXPECT_EQ(printable("Größe \xc2\x9b"
                      "1m \xff\xc3(\xed\xa0\x80",
                      99),
            "Größe ?1m ?"
            "?(???");
  EXPECT_EQ(printable(std::string("a\0b", 3), 99), "a?b");
  EXPECT_EQ(printable("öö", 3), "ö");
  EXPECT_EQ(printable("", 0), "");
}

// What XML 1.0 forbids, section 2.2, and control characters: a child's output reaches JUnit files.
TEST(PrintableTest, LinesOfAChildBecomeTextThatXmlAllows) {
  EXPECT_EQ(printable_lines("a\tb\nc\r\x1b\x7f"), "a\tb\nc???");
  EXPECT_EQ(printable_lines("\xef\xbf\xbd \xef\xbf\xbe \xef\xbf\xbf"), "\xef\xbf\xbd ? ?");
  EXPECT_EQ(printable_lines("\xc2\x85 \xff \xed\xa0\x80"), "? ? ???");
  EXPECT_EQ(printable_lines("Größe 😀"), "Größe 😀");
}

}  // namespace
}  // namespace footfall::core
