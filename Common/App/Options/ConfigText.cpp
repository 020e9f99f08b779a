#include "Common/App/Options/ConfigText.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "Common/App/Options/OptionValues.h"
#include "Common/Core/Error.h"
#include "Common/Core/Format.h"
#include "Common/Scene/Json/JsonText.h"

namespace rt::app {
namespace {

constexpr const char* kForm = "must be FLAG = VALUE, such as spp = 500";

std::string inQuotes(const std::string& text) {
    return '"' + excerpt(text) + '"';
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

std::string textOf(const nlohmann::json& value, const std::string& name, const std::string& file) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    throw UsageError(file + ": " + inQuotes(name) +
                     ": must be a string, a number, true, false or an array of at least one of these");
}

std::vector<ConfigEntry> readJson(const std::string& text, const std::string& file) {
    nlohmann::json root;
    try {
        root = scene::parseJson(text, file);
    } catch (const InputError& error) {
        throw UsageError(error.what());
    }
    std::vector<ConfigEntry> entries;
    for (const auto& [name, value] : root.items()) {
        ConfigEntry entry{name, {}, file};
        if (value.is_array() && !value.empty()) {
            for (const auto& element : value) entry.values.push_back(textOf(element, name, file));
        } else {
            entry.values.push_back(textOf(value, name, file));
        }
        entries.push_back(entry);
    }
    return entries;
}

// ---- lines ---------------------------------------------------------------------------------------------------------

class LineReader {
  public:
    LineReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    std::vector<ConfigEntry> read() {
        for (skipBlank(true); at_ < text_.size(); skipBlank(true)) readEntry();
        return entries_;
    }

  private:
    char next() const { return at_ < text_.size() ? text_[at_] : '\n'; }
    std::string place() const { return file_ + ":" + std::to_string(line_); }
    [[noreturn]] void fail(const std::string& message) const { throw UsageError(place() + ": " + message); }

    void skipSpace() { at_ = std::min(text_.find_first_not_of(" \t\r", at_), text_.size()); }
    // Also lines and comments; of those that begin with a semicolon only where a line starts.
    void skipBlank(bool atStart) {
        for (skipSpace(); at_ < text_.size(); skipSpace()) {
            const char c = text_[at_];
            if (c == '#' || (c == ';' && atStart))
                at_ = std::min(text_.find('\n', at_), text_.size());
            else if (c == '\n')
                ++at_, ++line_;
            else
                return;
        }
    }

    // Up to one of these characters, without the space around it.
    std::string readWord(const char* ends) {
        const std::size_t end = std::min(text_.find_first_of(ends, at_), text_.size());
        std::string word = text_.substr(at_, end - at_);
        word.erase(word.find_last_not_of(" \t\r") + 1);
        at_ = end;
        return word;
    }

    void readEntry() {
        ConfigEntry entry;
        entry.place = place();
        if (next() == '[') fail(inQuotes(readWord("\n")) + ": there are no sections; a line " + kForm);
        entry.name = readWord("=#\n");
        if (next() != '=' || entry.name.empty()) fail(inQuotes(entry.name + readWord("\n")) + ": " + kForm);
        const auto same = [&](const ConfigEntry& e) { return e.name == entry.name; };
        if (const auto first = std::find_if(entries_.begin(), entries_.end(), same); first != entries_.end())
            fail(inQuotes(entry.name) + " appears twice, first at " + first->place + "; several values go into [ ]");
        ++at_;
        skipSpace();
        if (next() == '[')
            readArray(entry);
        else
            readValue(entry, "#\n");
        skipSpace();
        if (next() != '#' && next() != '\n') fail(inQuotes(readWord("\n")) + ": follows the value; a line " + kForm);
        entries_.push_back(std::move(entry));
    }

    void readValue(ConfigEntry& entry, const char* ends) {
        const char quote = next();
        if (quote != '"' && quote != '\'') {
            entry.values.push_back(readWord(ends));
            if (entry.values.back().empty()) fail(inQuotes(entry.name) + ": has no value; a line " + kForm);
            return;
        }
        const std::size_t end = text_.find_first_of(std::string{quote, '\n'}, at_ + 1);
        if (end == std::string::npos || text_[end] == '\n') fail(inQuotes(entry.name) + ": lacks the closing quote");
        entry.values.push_back(text_.substr(at_ + 1, end - at_ - 1));
        at_ = end + 1;
    }

    void readArray(ConfigEntry& entry) {
        do {
            ++at_; // over the bracket or the comma
            skipBlank(false);
            if (next() == ']' && !entry.values.empty()) break; // after a last comma
            readValue(entry, ",]#\n");
            skipBlank(false);
        } while (next() == ',');
        if (next() != ']') fail(inQuotes(entry.name) + ": its values must be separated by , and end with ]");
        ++at_;
    }

    const std::string& text_;
    const std::string& file_;
    std::size_t at_ = 0, line_ = 1;
    std::vector<ConfigEntry> entries_;
};

// Control characters would also spoil the terminal that an error is shown on.
void checkBytes(const std::string& text, const std::string& file) {
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if (byte == '\n') ++line;
        const bool endsLine = byte == '\r' && (i + 1 == text.size() || text[i + 1] == '\n');
        if ((byte >= 0x20 && byte != 0x7f) || byte == '\t' || byte == '\n' || endsLine) continue;
        throw UsageError(file + ":" + std::to_string(line) + ": the byte " + formatted("0x%02x", byte) +
                         " is no text; must be TOML, INI or JSON in UTF-8");
    }
}

} // namespace

std::vector<ConfigEntry> readConfigText(const std::string& text, const std::string& file) {
    constexpr const char* kByteOrderMark = "\xef\xbb\xbf";
    const std::string content = text.rfind(kByteOrderMark, 0) == 0 ? text.substr(3) : text;
    checkBytes(content, file);
    const std::size_t first = content.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && content[first] == '{') return readJson(content, file);
    return LineReader(content, file).read();
}

} // namespace rt::app
