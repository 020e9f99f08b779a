#include "Common/Scene/Obj/ObjGeometry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Obj/Polygon.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

namespace {

constexpr float kBroken = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kMaxEntries = 0x7fffffffu; // of a kind
constexpr std::size_t kShownBytes = 60;            // of what is quoted

std::string quoted(std::string_view text) {
    return " (\"" + printable(text, kShownBytes) + "\")";
}

// The next number of a statement, in single precision; unset: it is none, or too large.
std::optional<float> takeFloat(std::string_view& rest) {
    const std::optional<double> value = numberOf(takeWord(rest));
    if (!value || std::abs(*value) > double{std::numeric_limits<float>::max()}) return std::nullopt;
    return static_cast<float>(*value);
}

template <class Value>
Value takeVector(std::string_view& rest) {
    Value value(kBroken);
    for (int i = 0; i < value.length(); ++i) {
        const std::optional<float> number = takeFloat(rest);
        if (!number) return Value(kBroken);
        value[i] = *number;
    }
    return value;
}

template <class Value>
void append(ObjEntries<Value>& entries, const Value& value, const ObjStatement& statement) {
    interruptionPoint();
    if (entries.values.size() >= kMaxEntries)
        throw InputError("an OBJ file of more than " + std::to_string(kMaxEntries) + " entries of a kind");
    if (!std::isfinite(value.x))
        entries.broken.push_back({static_cast<std::uint32_t>(entries.values.size()), statement.line, statement.source});
    entries.values.push_back(value);
}

template <class Value>
const typename ObjEntries<Value>::Broken* brokenAt(const ObjEntries<Value>& entries, std::uint32_t index) {
    if (std::isfinite(entries.values[index].x)) return nullptr;
    return &*std::ranges::lower_bound(entries.broken, index, {}, &ObjEntries<Value>::Broken::index);
}

struct EntryWords {
    const char* name;    // of the kind
    const char* content; // of a statement
    Trouble index, none, broken, some;
};
constexpr EntryWords kUvWords = {"texture coordinate", "vt must have one or two finite numbers",
                                 Trouble::UvIndex,     Trouble::NoUv,
                                 Trouble::BrokenUv,    Trouble::SomeUvs};
constexpr EntryWords kNormalWords = {"normal",
                                     "vn must have three finite numbers",
                                     Trouble::NormalIndex,
                                     Trouble::NoNormal,
                                     Trouble::BrokenNormal,
                                     Trouble::SomeNormals};

std::string noEntry(const char* name, std::string_view index, std::size_t count, const char* when) {
    return std::string(name) + " index " + printable(index, kShownBytes) +
           (count == 1 ? ": there is " : ": there are ") + std::to_string(count) + when;
}

// An index as files write it; of any size, but no larger than fits.
std::optional<std::int64_t> indexOf(std::string_view text) {
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range)
        return text.front() == '-' ? std::numeric_limits<std::int64_t>::min()
                                   : std::numeric_limits<std::int64_t>::max();
    return index;
}

// The positive index for one that counts backwards from the last of `count`; unset: there is none, nor can be.
std::optional<std::uint32_t> fromStart(std::int64_t index, std::size_t count) {
    if (index < 0) index = index < -static_cast<std::int64_t>(count) ? 0 : index + static_cast<std::int64_t>(count) + 1;
    if (index <= 0 || index > kMaxEntries) return std::nullopt;
    return static_cast<std::uint32_t>(index);
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

} // namespace

// ---- entries -------------------------------------------------------------------------------------------------------

void ObjGeometry::addPosition(const ObjStatement& statement, bool withColor) {
    std::string_view rest = statement.rest;
    const auto position = takeVector<glm::vec3>(rest);
    if (withColor && std::isfinite(position.x)) addColor(rest, statement);
    append(positions_, position, statement);
}

// Red, green and blue behind the position that is added next, encoded as in images: no specification has them, and
// Blender's importer reads them so. One number there is a weight of curves.
void ObjGeometry::addColor(std::string_view numbers, const ObjStatement& statement) {
    std::size_t count = 0;
    for (std::string_view rest = numbers; count < 3 && !takeWord(rest).empty();) ++count;
    if (count < 3) return;
    const auto color = takeVector<glm::vec3>(numbers);
    if (!std::isfinite(color.x)) {
        troubles_.add(Trouble::BrokenColor, statement.line, statement.line,
                      [&] { return "the colour of a vertex must be three finite numbers" + quoted(statement.source); });
        return;
    }
    colors_.resize(positions_.values.size(), glm::vec3(kBroken));
    colors_.push_back(color);
    for (int c = 0; c < 3; ++c)
        areColorsBytes_ = areColorsBytes_ && color[c] >= 0 && color[c] <= 255 && color[c] == std::floor(color[c]);
    colorsBeyond_ += glm::clamp(color, 0.0f, 1.0f) != color;
}

void ObjGeometry::addUv(const ObjStatement& statement) {
    std::string_view rest = statement.rest;
    const std::optional<float> u = takeFloat(rest);
    std::string_view second = rest;
    const std::optional<float> v = takeWord(second).empty() ? 0.0f : takeFloat(rest);
    append(uvs_, u && v ? glm::vec2(*u, *v) : glm::vec2(kBroken), statement);
}

void ObjGeometry::addNormal(const ObjStatement& statement) {
    std::string_view rest = statement.rest;
    append(normals_, takeVector<glm::vec3>(rest), statement);
}

// ---- faces ---------------------------------------------------------------------------------------------------------

// A word like 3, 3/1, 3//2, 3/1/2, with negative indices counted from here backwards.
bool ObjGeometry::readCorner(std::string_view word, std::size_t line, Corner& corner) {
    const auto takeField = [&word] {
        const std::string_view field = word.substr(0, word.find('/'));
        word.remove_prefix(std::min(field.size() + 1, word.size()));
        return field;
    };
    const std::string_view whole = word;
    const std::string_view first = takeField();
    const std::optional<std::int64_t> index = indexOf(first);
    if (index.value_or(0) == 0) {
        troubles_.add(Trouble::VertexIndex, line, line,
                      [&] { return "a vertex index must be a whole number that is not 0" + quoted(whole); });
        return false;
    }
    const std::optional<std::uint32_t> position = fromStart(*index, positions_.values.size());
    if (!position) {
        troubles_.add(Trouble::NoVertex, line, line,
                      [&] { return noEntry("vertex", first, positions_.values.size(), " so far"); });
        return false;
    }
    corner.position = *position;
    const auto other = [&](std::size_t count, const EntryWords& words) -> std::uint32_t {
        const std::string_view field = takeField();
        const std::optional<std::int64_t> number = field.empty() ? 0 : indexOf(field);
        if (!number)
            troubles_.add(words.index, line, line,
                          [&] { return std::string(words.name) + " indices must be whole numbers" + quoted(whole); });
        if (number.value_or(0) == 0) return 0;
        const std::optional<std::uint32_t> found = fromStart(*number, count);
        if (!found) troubles_.add(words.none, line, line, [&] { return noEntry(words.name, field, count, " so far"); });
        return found.value_or(0);
    };
    corner.uv = other(uvs_.values.size(), kUvWords);
    corner.normal = other(normals_.values.size(), kNormalWords);
    return true;
}

bool ObjGeometry::readCorners(const ObjStatement& statement) {
    corners_.clear();
    std::string_view rest = statement.rest;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
        Corner corner{};
        if (!readCorner(word, statement.line, corner)) return false;
        corners_.push_back(corner);
    }
    if (corners_.size() < 3)
        troubles_.add(Trouble::CornerCount, statement.line, statement.line, [&] {
            return "a face of " + counted(corners_.size(), "corner", "corners") + ": at least 3 are needed";
        });
    return corners_.size() >= 3;
}

void ObjGeometry::addFace(const ObjStatement& statement) {
    interruptionPoint();
    if (!readCorners(statement)) return;
    const Face face{statement.line, triangles_, group_, laterCorners_.size(), corners_.size()};
    const bool isLater = std::ranges::any_of(corners_, [&](const Corner& c) {
        return c.position > positions_.values.size() || c.uv > uvs_.values.size() || c.normal > normals_.values.size();
    });
    if (!isLater) {
        build(face, corners_.data());
        return;
    }
    later_.push_back(face);
    laterCorners_.insert(laterCorners_.end(), corners_.begin(), corners_.end());
}

bool ObjGeometry::hasPositions(const Face& face, const Corner* corners) {
    for (std::size_t i = 0; i < face.cornerCount; ++i) {
        const std::uint32_t index = corners[i].position;
        if (index > positions_.values.size()) {
            troubles_.add(Trouble::NoVertex, face.line, face.line,
                          [&] { return noEntry("vertex", std::to_string(index), positions_.values.size(), ""); });
            return false;
        }
        if (const auto* broken = brokenAt(positions_, index - 1)) {
            troubles_.add(Trouble::BrokenVertex, broken->line, face.line,
                          [&] { return "v must have three finite numbers" + quoted(broken->source); });
            return false;
        }
    }
    return true;
}

// Whether every corner has one of these entries.
template <class Value>
bool ObjGeometry::has(const Face& face, const Corner* corners, const ObjEntries<Value>& entries, IndexOfCorner index) {
    const EntryWords& words = index == &Corner::uv ? kUvWords : kNormalWords;
    const char *name = words.name, *content = words.content;
    std::size_t count = 0;
    for (std::size_t i = 0; i < face.cornerCount; ++i) {
        const std::uint32_t number = corners[i].*index;
        if (number == 0) continue;
        if (number > entries.values.size()) {
            troubles_.add(words.none, face.line, face.line,
                          [&] { return noEntry(name, std::to_string(number), entries.values.size(), ""); });
            return false;
        }
        if (const auto* broken = brokenAt(entries, number - 1)) {
            troubles_.add(words.broken, broken->line, face.line, [&] { return content + quoted(broken->source); });
            return false;
        }
        ++count;
    }
    if (count > 0 && count < face.cornerCount)
        troubles_.add(words.some, face.line, face.line, [&] {
            return "a face with a " + std::string(name) + " at " + std::to_string(count) + " of its " +
                   std::to_string(face.cornerCount) + " corners";
        });
    return count == face.cornerCount;
}

void ObjGeometry::build(const Face& face, const Corner* corners) {
    if (!hasPositions(face, corners)) return;
    const bool hasUvs = has(face, corners, uvs_, &Corner::uv);
    const bool hasNormals = has(face, corners, normals_, &Corner::normal);
    const bool isSmooth = !hasNormals && face.group != 0;
    face_.clear();
    outline_.clear();
    for (std::size_t i = 0; i < face.cornerCount; ++i) {
        const std::uint32_t position = corners[i].position - 1;
        std::uint32_t normal = hasNormals ? corners[i].normal - 1 : shared::kNone;
        if (isSmooth) normal = kSmoothed | smoothed_.indexOf({position, face.group, 0});
        face_.push_back(vertices_.indexOf({position, hasUvs ? corners[i].uv - 1 : shared::kNone, normal}));
        outline_.emplace_back(positions_.values[position]);
    }
    cut(face, isSmooth);
}

// Into triangles, whose normals are added up by the angle at each corner where the face is smoothed.
void ObjGeometry::cut(const Face& face, bool isSmooth) {
    smooth_.resize(smoothed_.combinations().size(), glm::dvec3(0));
    const auto add = [&](const glm::uvec3& t) {
        face.triangles->emplace_back(face_[t.x], face_[t.y], face_[t.z]);
        const glm::dvec3 across = glm::cross(outline_[t.y] - outline_[t.x], outline_[t.z] - outline_[t.x]);
        const double length = glm::length(across);
        if (!isSmooth || !(length > 0) || !std::isfinite(length)) return;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3& corner = outline_[t[i]];
            const double angle = angleBetween(outline_[t[(i + 1) % 3]] - corner, outline_[t[(i + 2) % 3]] - corner);
            const std::uint32_t normal = vertices_.combinations()[face_[t[i]]].z;
            smooth_[normal & ~kSmoothed] += angle / length * across;
        }
    };
    if (face.cornerCount == 3)
        add({0, 1, 2});
    else
        for (const glm::uvec3& t : cutPolygon(outline_)) add(t);
}

void ObjGeometry::finish() {
    for (const Face& face : later_) {
        interruptionPoint();
        build(face, laterCorners_.data() + face.firstCorner);
    }
    later_.clear();
    laterCorners_.clear();
    areColorsBytes_ = areColorsBytes_ && colorsBeyond_ > 0;
    if (areColorsBytes_) colorScale_ = 1 / 255.0f;
    renamed_.assign(vertices_.combinations().size(), shared::kNone);
}

} // namespace rt::scene
