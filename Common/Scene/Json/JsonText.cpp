#include "Common/Scene/Json/JsonText.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"

namespace rt::scene {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxDepth = 256;

std::string lineAndColumn(std::string_view text, std::size_t offset) {
    offset = std::min(offset, text.size());
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(offset);
    const auto line = std::count(text.begin(), end, '\n') + 1;
    const std::size_t lineStart = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
    const std::size_t column = lineStart == std::string::npos ? offset + 1 : offset - lineStart;
    return std::to_string(line) + ":" + std::to_string(column);
}

// The library's message without its prefix of identifiers and positions.
std::string reason(const std::string& message) {
    const std::size_t syntax = message.find("syntax error ");
    const std::size_t start = syntax != std::string::npos ? syntax : message.find("] ") + 2;
    return message.substr(start, 200);
}

// ---- parsing -------------------------------------------------------------------------------------------------------

// Walks over a text, but for a part of it that is left out, and leaves word of how far.
struct Reader {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at;
    const char** read;
    std::string_view leftOut; // something follows it

    const char* next() const { return at == leftOut.data() ? at + leftOut.size() : at; }
    reference operator*() const { return *next(); }
    Reader& operator++() {
        *read = at = next() + 1;
        return *this;
    }
    bool operator==(const Reader& other) const { return at == other.at; }
    bool operator!=(const Reader& other) const { return at != other.at; }
};

// Builds values from what the library's parser reports. The library's own builder takes time in proportion to the
// square of an array's length once a callback watches it, and without one a repeated key goes unnoticed.
class Builder : public nlohmann::json_sax<Json> {
  public:
    Builder(std::string_view text, const std::string& file, std::string_view part, std::string_view leftOut)
        : text_(text), file_(file), part_(part), leftOut_(leftOut), read_(part.data()) {}

    LargeJson build() {
        const char* const end = part_.data() + part_.size();
        Json::sax_parse(Reader{part_.data(), &read_, leftOut_}, Reader{end, &read_, {}}, this);
        return std::move(root_);
    }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(value); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string&) override { return add(value); }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Json::binary_t&) override { return false; } // not in a text
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(std::string& name) override {
        const auto [member, isNew] = open_.back()->get_ref<Json::object_t&>().try_emplace(name, nullptr);
        if (!isNew)
            fail("key " + Json(name).dump(-1, ' ', false, Json::error_handler_t::replace) +
                 " appears twice in one object");
        member_ = &member->second;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
        if (const auto* syntax = dynamic_cast<const Json::parse_error*>(&error)) {
            const std::size_t offset = offsetOf(part_.data()) + (syntax->byte > 0 ? syntax->byte - 1 : 0);
            const bool isBehind = !leftOut_.empty() && offset >= offsetOf(leftOut_.data());
            failAt(offset + (isBehind ? leftOut_.size() : 0), reason(error.what()));
        }
        fail(reason(error.what())); // a number that no double can hold
    }

  private:
    std::size_t offsetOf(const char* place) const { return static_cast<std::size_t>(place - text_.data()); }
    [[noreturn]] void failAt(std::size_t offset, const std::string& what) const {
        throw InputError(file_ + ":" + lineAndColumn(text_, offset) + ": " + what);
    }
    [[noreturn]] void fail(const std::string& what) const { // at what was read last
        failAt(offsetOf(std::max(read_ - 1, part_.data())), what);
    }

    Json& place(Json&& value) {
        if (open_.empty()) return *root_ = std::move(value);
        if (open_.back()->is_array()) return open_.back()->get_ref<Json::array_t&>().emplace_back(std::move(value));
        return *member_ = std::move(value);
    }
    bool add(Json&& value) {
        place(std::move(value));
        return true;
    }
    bool open(Json&& value) {
        interruptionPoint();
        Json& placed = place(std::move(value));
        open_.push_back(&placed);
        if (open_.size() > kMaxDepth + 1) fail("values are nested deeper than " + std::to_string(kMaxDepth));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    std::string_view text_;
    const std::string& file_;
    std::string_view part_; // of text_
    std::string_view leftOut_;
    const char* read_;
    LargeJson root_;
    std::vector<Json*> open_; // arrays and objects around what comes next
    Json* member_ = nullptr;  // of the innermost object, what comes next
};

// ---- finding the elements of an array ------------------------------------------------------------------------------

constexpr std::array<bool, 256> kIsQuoteOrBracket = [] {
    std::array<bool, 256> is{};
    for (const unsigned char c : std::string_view("\"[]{}")) is[c] = true;
    return is;
}();

// Looks at quotes and brackets only; whatever else is wrong shows when it is parsed. Positions beyond the end are the
// end.
class Scanner {
  public:
    explicit Scanner(std::string_view text) : text_(text) {}

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    std::size_t position() const { return at_; }
    void skipSpace() {
        while (peek() == ' ' || peek() == '\n' || peek() == '\r' || peek() == '\t') ++at_;
    }
    bool take(char expected) {
        if (peek() != expected) return false;
        ++at_;
        return true;
    }
    // What stands between its quotes.
    std::string_view string() {
        const std::size_t start = ++at_;
        for (; at_ < text_.size() && text_[at_] != '"'; ++at_)
            if (text_[at_] == '\\') ++at_;
        at_ = std::min(at_, text_.size());
        const std::string_view inside = text_.substr(start, at_ - start);
        at_ = std::min(at_ + 1, text_.size());
        return inside;
    }
    // From a bracket to the one that closes it; empty where none does.
    std::string_view bracketed() {
        const std::size_t start = at_;
        std::size_t depth = 0;
        for (;;) {
            while (at_ < text_.size() && !kIsQuoteOrBracket[static_cast<unsigned char>(text_[at_])]) ++at_;
            if (at_ == text_.size()) return {};
            if (text_[at_] == '"') {
                string();
                continue;
            }
            const char bracket = text_[at_++];
            depth += bracket == '{' || bracket == '[' ? 1 : -1;
            if (depth == 0) return text_.substr(start, at_ - start);
        }
    }

  private:
    std::string_view text_;
    std::size_t at_ = 0;
};

// The elements of the array that is the root's member `name`; none when one of them is no object, or there is no such
// array.
std::vector<std::string_view> findObjects(std::string_view text, std::string_view name) {
    Scanner in(text);
    in.skipSpace();
    if (!in.take('{')) return {};
    for (in.skipSpace(); in.peek() == '"'; in.skipSpace()) {
        const std::string_view key = in.string();
        in.skipSpace();
        if (!in.take(':')) return {};
        in.skipSpace();
        if (key == name) break;
        if (in.peek() == '{' || in.peek() == '[')
            in.bracketed();
        else if (in.peek() == '"')
            in.string();
        else
            while (in.peek() != ',' && in.peek() != '}' && in.peek() != '\0') in.take(in.peek());
        in.skipSpace();
        if (!in.take(',')) return {};
    }
    std::vector<std::string_view> elements;
    if (!in.take('[')) return {};
    for (in.skipSpace(); in.peek() == '{'; in.skipSpace()) {
        interruptionPoint();
        elements.push_back(in.bracketed());
        in.skipSpace();
        if (in.take(']')) return elements;
        if (elements.back().empty() || !in.take(',')) return {};
    }
    return {};
}

// As deep as values are nested, which a Builder limits.
void takeApart(Json& value) {
    if (value.is_array())
        for (auto& array = value.get_ref<Json::array_t&>(); !array.empty(); array.pop_back()) takeApart(array.back());
    if (value.is_object())
        for (auto& object = value.get_ref<Json::object_t&>(); !object.empty(); object.erase(object.begin()))
            takeApart(object.begin()->second);
}

} // namespace

LargeJson::~LargeJson() {
    takeApart(value_);
}

Json parseJson(std::string_view text, const std::string& file) {
    LargeJson root = Builder(text, file, text, {}).build();
    return std::move(*root);
}

LongJson::LongJson(std::string_view text, const std::string& file, std::string_view longArray)
    : text_(text), file_(file), elements_(findObjects(text, longArray)) {}

LargeJson LongJson::document() const {
    if (elements_.empty()) return Builder(text_, file_, text_, {}).build();
    const char* const begin = elements_.front().data();
    const char* const end = elements_.back().data() + elements_.back().size();
    return Builder(text_, file_, text_, {begin, static_cast<std::size_t>(end - begin)}).build();
}

LargeJson LongJson::element(std::size_t index) const {
    return Builder(text_, file_, elements_[index], {}).build();
}

} // namespace rt::scene
