// The text of OBJ and MTL files, in which encodings, lines, spaces and quotes come as they like.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rt::scene {

// The bytes of a file, in UTF-8 without a byte order mark where one says that it is UTF-8 or UTF-16. Throws InputError.
std::vector<std::byte> readText(const std::filesystem::path& path);

// The lines of a text that say something. A backslash at the end of a line, or before its comment, goes on with the
// next one; a comment line goes on nowhere.
class TextLines {
  public:
    explicit TextLines(std::string_view text) : rest_(text) {}
    bool next();                                        // false: there is none left
    std::string_view line() const { return line_; }     // without space around it, until next()
    std::string_view source() const { return source_; } // the line in the text, of several the first
    std::size_t number() const { return number_; }      // of source(), counted from 1

  private:
    std::string_view takeLine();

    std::string_view rest_, line_, source_;
    std::size_t number_ = 0, taken_ = 0;
    std::string joined_;
};

// Without spaces, tabs and carriage returns around it.
std::string_view trimmed(std::string_view text);
std::string lowerCase(std::string_view text); // of ASCII

// Takes the next word off a text; empty: it ends, or a comment begins.
std::string_view takeWord(std::string_view& text);

// The finite number that the whole text is, with a decimal point in any locale, within two units in its last place;
// what is too large is the largest there is.
std::optional<double> numberOf(std::string_view text);

// Up to the first # at the start or behind a space.
std::string_view withoutComment(std::string_view text);
std::string_view withoutQuotes(std::string_view text);
// A name as files write it, without what is surely a comment: a # between spaces ("Material #25" is a name), and
// without quotes.
std::string_view nameIn(std::string_view text);

// `"a"`, `"a" and "b"`, `"a", "b", "c" and 7 others`; not of nothing.
std::string listed(const std::set<std::string>& names);

} // namespace rt::scene
