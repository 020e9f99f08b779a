#include "Common/Scene/Pbrt/PbrtLexer.h"

#include <algorithm>

#include "Common/Core/Printable.h"

namespace rt::scene {

namespace {

bool endsWord(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '[' || c == ']' || c == '"' || c == '#' ||
           c == '\v' || c == '\f';
}

} // namespace

PbrtLexer::PbrtLexer(const std::filesystem::path& path, PbrtBudget& budget)
    : bytes_(path),
      budget_(budget),
      file_(std::make_shared<const std::string>(path.string())),
      buffer_(kLongest + kPiece) {
    fill();
    if (end_ >= 3 && std::string_view(buffer_.data(), 3) == "\xef\xbb\xbf") at_ = 3; // the mark of UTF-8
}

void PbrtLexer::fill() {
    if (hasEnded_ || end_ - at_ >= kLongest) return;
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
              buffer_.begin());
    end_ -= at_;
    at_ = 0;
    while (end_ < kLongest && !hasEnded_) {
        const std::size_t count = bytes_.read(buffer_.data() + end_, buffer_.size() - end_);
        end_ += count;
        hasEnded_ = count == 0;
    }
}

// Comments go on to the end of the line, however far that is.
void PbrtLexer::skipSpace() {
    bool isComment = false;
    for (;; ++at_) {
        if (at_ == end_) {
            fill();
            if (at_ == end_) return;
        }
        const char c = buffer_[at_];
        if (c == '\n') {
            ++line_;
            isComment = false;
        } else if (c == '#') {
            isComment = true;
        } else if (!isComment && c != ' ' && c != '\t' && c != '\r' && c != '\v' && c != '\f') {
            return;
        }
    }
}

void PbrtLexer::readQuoted() {
    const std::size_t first = ++at_;
    bool isEscaped = false, hasEscapes = false;
    for (; at_ < end_ && (isEscaped || buffer_[at_] != '"'); ++at_) {
        if (buffer_[at_] == '\n') place().fail("a string must end on its line");
        isEscaped = !isEscaped && buffer_[at_] == '\\';
        hasEscapes = hasEscapes || isEscaped;
    }
    if (at_ == end_)
        place().fail(hasEnded_ ? "the file ends within a string"
                               : "a string is longer than " + std::to_string(kLongest) + " bytes");
    text_ = {buffer_.data() + first, at_ - first};
    ++at_;
    if (!hasEscapes) return;
    unescaped_.clear();
    for (std::size_t i = 0; i < text_.size(); ++i) {
        if (text_[i] != '\\') {
            unescaped_ += text_[i];
            continue;
        }
        constexpr std::string_view kNames = "bfnrt\\'\"", kMeanings = "\b\f\n\r\t\\'\"";
        const std::size_t which = kNames.find(text_[++i]);
        if (which == kNames.npos)
            place().fail("the escape \"\\" + printable(text_.substr(i, 1)) +
                         "\" is unknown; known are \\b \\f \\n \\r \\t \\\\ \\' and \\\"");
        unescaped_ += kMeanings[which];
    }
    text_ = unescaped_;
}

PbrtLexer::Kind PbrtLexer::next() {
    skipSpace();
    fill();
    tokenLine_ = line_;
    text_ = {};
    if (at_ == end_) return kind_ = Kind::End;
    if (!budget_.take(1)) budget_.refuse(place());
    const char c = buffer_[at_];
    if (c == '[' || c == ']') {
        ++at_;
        return kind_ = c == '[' ? Kind::Open : Kind::Close;
    }
    if (c == '"') {
        readQuoted();
        return kind_ = Kind::Quoted;
    }
    const std::size_t first = at_;
    while (at_ < end_ && !endsWord(buffer_[at_])) ++at_;
    if (at_ == end_ && !hasEnded_) place().fail("a word is longer than " + std::to_string(kLongest) + " bytes");
    text_ = {buffer_.data() + first, at_ - first};
    return kind_ = Kind::Word;
}

std::string PbrtLexer::described() const {
    switch (kind_) {
        case Kind::End:
            return "the end of the file";
        case Kind::Open:
            return "[";
        case Kind::Close:
            return "]";
        default:
            return '"' + printable(text_, 100) + '"';
    }
}

} // namespace rt::scene
