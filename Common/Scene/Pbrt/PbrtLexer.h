// The words of a pbrt file.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Scene/Pbrt/PbrtBudget.h"
#include "Common/Scene/Pbrt/PbrtBytes.h"
#include "Common/Scene/Pbrt/PbrtPlace.h"

namespace rt::scene {

class PbrtLexer {
  public:
    enum class Kind {
        End,
        Word,   // a directive, a number, true, false
        Quoted, // a string, its escapes resolved
        Open,   // [
        Close,  // ]
    };

    PbrtLexer(const std::filesystem::path& path, PbrtBudget& budget);

    Kind next(); // throws InputError
    Kind kind() const { return kind_; }
    std::string_view text() const { return text_; } // of a word or string, until next()
    PbrtPlace place() const { return {file_, tokenLine_}; }
    std::string described() const; // for messages
    std::uint64_t bytes() const { return bytes_.size(); }

  private:
    static constexpr std::size_t kLongest = std::size_t{1} << 15; // of a word
    static constexpr std::size_t kPiece = std::size_t{1} << 17;

    void fill(); // so that kLongest characters are there, unless the file ends
    void skipSpace();
    void readQuoted();

    PbrtBytes bytes_;
    PbrtBudget& budget_;
    std::shared_ptr<const std::string> file_;
    std::vector<char> buffer_;
    std::size_t at_ = 0, end_ = 0; // in buffer_
    bool hasEnded_ = false;
    std::size_t line_ = 1, tokenLine_ = 1;
    Kind kind_ = Kind::End;
    std::string_view text_;
    std::string unescaped_;
};

} // namespace rt::scene
