// Foreign text on one line, short, and without what a terminal obeys.
#include <gtest/gtest.h>

#include "Common/Core/Printable.h"

namespace rt {
namespace {

TEST(Printable, LeavesTextAsItIs) {
    for (const char* text :
         {"", "a.png: 12 %", "gr\xc3\xbc\xc3\x9f", "\xe6\x97\xa5\xe6\x9c\xac", "\xf0\x9f\x99\x82", "C:\\a"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalObeys) {
    EXPECT_EQ(printable("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
    EXPECT_EQ(printable("a\r\nb\tc\x7f"), "a\\x0d\\nb\\tc\\x7f");
    EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "2J"),
              "\\u{9b}2J"); // C1: a control sequence in one character
    EXPECT_EQ(printable("\xe2\x80\xae"
                        "gnp"),
              "\\u{202e}gnp");                         // right to left
    EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u{2028}"); // line separator
    EXPECT_EQ(printable("\xe2\x81\xa6"
                        "a\xef\xbb\xbf"),
              "\\u{2066}a\\u{feff}");
}

TEST(Printable, EscapesWhatIsNotUtf8) {
    EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
    EXPECT_EQ(printable("\xc3"), "\\xc3");                            // cut off
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                   // longer than need be
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");          // a surrogate
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80"); // beyond Unicode
    EXPECT_EQ(printable("a\x80z"), "a\\x80z");
}

TEST(Printable, LeavesOutTheMiddle) {
    const std::string text = "start" + std::string(3'000'000, 'x') + "end";
    const std::string shown = printable(text, 90);
    EXPECT_LT(shown.size(), 130u);
    EXPECT_EQ(shown.rfind("startxxx", 0), 0u);
    EXPECT_EQ(shown.substr(shown.size() - 5), "xxend");
    EXPECT_NE(shown.find("[2999918 bytes more]"), std::string::npos) << shown;
    std::string umlauts;
    for (int i = 0; i < 1000; ++i) umlauts += "\xc3\xbc";
    for (std::size_t maximum = 80; maximum < 90; ++maximum)
        EXPECT_EQ(printable(umlauts, maximum).find("\\x"), std::string::npos);
    EXPECT_EQ(printable(std::string(1000, '\x80'), 90).find('\x80'), std::string::npos);
}

} // namespace
} // namespace rt
