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

}  // namespace
}  // namespace footfall::core
