// What of an OBJ file cannot be taken as it stands, by kind: where it is met first, and how often.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace rt::scene {

enum class Trouble {
    CornerCount,  // of a face, which is left out, as it is with the next three
    VertexIndex,  // no whole number, or 0
    NoVertex,     // of that index
    BrokenVertex, // its coordinates are no numbers
    UvIndex,      // of a face, which does without
    NoUv,
    BrokenUv,
    SomeUvs, // a face has them at some corners only
    NormalIndex,
    NoNormal,
    BrokenNormal,
    SomeNormals,
    BrokenColor, // of a vertex
    kCount,
};

class ObjTroubles {
  public:
    // `describe` tells of the first of a kind, with the value and what is allowed. What suffers is the statement of
    // line `affected`, which counts once.
    template <class Describe>
    void add(Trouble trouble, std::size_t line, std::size_t affected, const Describe& describe) {
        Kind& kind = kinds_[static_cast<std::size_t>(trouble)];
        if (kind.count == 0) {
            kind.line = line;
            kind.message = describe();
        }
        kind.count += affected != kind.affected;
        kind.affected = affected;
    }
    // Why the first face is left out, behind `path` and its line; unset: none is.
    std::optional<std::string> whyNoFace(const std::string& path) const;
    void appendNotices(const std::string& path, std::vector<std::string>& notices) const;

  private:
    struct Kind {
        std::size_t line = 0, affected = 0, count = 0;
        std::string message;
    };
    std::array<Kind, static_cast<std::size_t>(Trouble::kCount)> kinds_;
};

} // namespace rt::scene
