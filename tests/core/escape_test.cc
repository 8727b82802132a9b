// Text of people in a page is text.
#include "core/escape.h"

#include <gtest/gtest.h>

namespace footfall::core {
namespace {

TEST(EscapeTest, SignsOfHtmlBecomeEntitiesAndControlCharactersBlanks) {
  EXPECT_EQ(escape_html("a < b && c > \"d\"\n"), "a &lt; b &amp;&amp; c &gt; &quot;d&quot; ");
  EXPECT_EQ(escape_html("Größe µ"), "Größe µ");
  EXPECT_EQ(escape_html(""), "");
}

}  // namespace
}  // namespace footfall::core
