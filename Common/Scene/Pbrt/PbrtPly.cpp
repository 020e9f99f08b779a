#include "Common/Scene/Pbrt/PbrtPly.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Pbrt/PbrtBytes.h"

namespace rt::scene {

namespace {

struct PlyType {
    std::string_view name, other;
    std::size_t bytes;
    bool isSigned, isReal;
};
constexpr PlyType kPlyTypes[] = {{"char", "int8", 1, true, false},    {"uchar", "uint8", 1, false, false},
                                 {"short", "int16", 2, true, false},  {"ushort", "uint16", 2, false, false},
                                 {"int", "int32", 4, true, false},    {"uint", "uint32", 4, false, false},
                                 {"float", "float32", 4, true, true}, {"double", "float64", 8, true, true}};

enum class PlyRole { X, Y, Z, NormalX, NormalY, NormalZ, U, V, None };
constexpr std::size_t kPlyRoles = static_cast<std::size_t>(PlyRole::None);
struct PlyRoleName {
    std::string_view name;
    PlyRole role;
};
constexpr PlyRoleName kPlyRoleNames[] = {
    {"x", PlyRole::X},         {"y", PlyRole::Y},        {"z", PlyRole::Z},         {"nx", PlyRole::NormalX},
    {"ny", PlyRole::NormalY},  {"nz", PlyRole::NormalZ}, {"u", PlyRole::U},         {"v", PlyRole::V},
    {"s", PlyRole::U},         {"t", PlyRole::V},        {"texture_u", PlyRole::U}, {"texture_v", PlyRole::V},
    {"texture_s", PlyRole::U}, {"texture_t", PlyRole::V}};

struct PlyProperty {
    const PlyType* type = nullptr;
    const PlyType* countType = nullptr; // of a list
    PlyRole role = PlyRole::None;       // of a vertex
    bool isCorners = false;             // of a face
};
struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

constexpr std::size_t kLongestLine = 4096; // of the header, and the longest word of numbers

// Bytes, words and numbers of the file.
class PlyInput {
  public:
    explicit PlyInput(const std::filesystem::path& path) : bytes_(path), name_(path.string()), buffer_(1 << 16) {}

    [[noreturn]] void fail(const std::string& message) const { throw InputError(name_ + ": " + message); }
    std::uint64_t size() const { return bytes_.size(); }

    bool take(char& c) {
        if (at_ == end_) {
            at_ = 0;
            end_ = bytes_.read(buffer_.data(), buffer_.size());
            if (end_ == 0) return false;
        }
        c = buffer_[at_++];
        return true;
    }

    std::string line() {
        std::string text;
        for (char c = 0; take(c) && c != '\n';) {
            text += c;
            if (text.size() > kLongestLine) fail("a line of its header is longer than 4096 bytes");
        }
        return std::string(trimmed(text));
    }

    void setFormat(bool isText, bool isBigEndian) {
        isText_ = isText;
        swaps_ = isBigEndian != (std::endian::native == std::endian::big);
    }

    double number(const PlyType& type) { return isText_ ? word() : binary(type); }

  private:
    double word() {
        std::array<char, 64> text{};
        std::size_t length = 0;
        for (char c = 0; take(c);) {
            const bool isSpace = c == ' ' || c == '\n' || c == '\r' || c == '\t';
            if (isSpace && length > 0) break;
            if (isSpace) continue;
            if (length == text.size()) fail("a number has more than 64 characters");
            text[length++] = c;
        }
        if (length == 0) fail("it ends before its last element");
        const std::string_view digits(text.data(), length);
        const std::optional<double> value = numberOf(digits);
        if (!value) fail('"' + printable(digits) + "\": must be a number");
        return *value;
    }

    template <class T>
    T raw() {
        std::array<char, sizeof(T)> bytes;
        if (end_ - at_ >= sizeof(T)) {
            std::memcpy(bytes.data(), buffer_.data() + at_, sizeof(T));
            at_ += sizeof(T);
        } else {
            for (char& byte : bytes)
                if (!take(byte)) fail("it ends before its last element");
        }
        if (swaps_)
            for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
        return std::bit_cast<T>(bytes);
    }

    double binary(const PlyType& type) {
        if (type.isReal) return type.bytes == 4 ? static_cast<double>(raw<float>()) : raw<double>();
        switch (type.bytes) {
            case 1:
                return type.isSigned ? double(raw<std::int8_t>()) : double(raw<std::uint8_t>());
            case 2:
                return type.isSigned ? double(raw<std::int16_t>()) : double(raw<std::uint16_t>());
            default:
                return type.isSigned ? double(raw<std::int32_t>()) : double(raw<std::uint32_t>());
        }
    }

    PbrtBytes bytes_;
    const std::string name_;
    std::vector<char> buffer_;
    std::size_t at_ = 0, end_ = 0;
    bool isText_ = true, swaps_ = false;
};

class PlyReader {
  public:
    PlyReader(const std::filesystem::path& path, PbrtBudget& budget)
        : in_(path), budget_(budget), place_{std::make_shared<const std::string>(path.string()), 1} {
        budget_.add(in_.size());
    }

    std::variant<MeshData, FloatMeshData> read() {
        readHeader();
        if (isSingle()) return read<float>();
        return read<double>();
    }

  private:
    // Few vertices take no memory worth saving; numbers of a text may tell more than their type says.
    bool isSingle() const {
        constexpr std::uint64_t kMany = std::uint64_t{1} << 15;
        for (const PlyElement& element : elements_) {
            if (element.name != "vertex") continue;
            const auto isShort = [](const PlyProperty& p) {
                return p.role == PlyRole::None || p.type->bytes <= 2 || (p.type->isReal && p.type->bytes == 4);
            };
            return element.count > kMany && std::ranges::all_of(element.properties, isShort);
        }
        return false;
    }

    template <class Real>
    MeshOf<Real> read() {
        MeshOf<Real> mesh;
        for (const PlyElement& element : elements_) {
            budget_.spend(element.count, place_);
            if (element.name == "vertex")
                readVertices(element, mesh);
            else if (element.name == "face")
                readFaces(element, mesh.triangles);
            else
                for (std::uint64_t i = 0; i < element.count; ++i) skip(element.properties);
        }
        for (const glm::uvec3& triangle : mesh.triangles)
            for (int c = 0; c < 3; ++c)
                if (triangle[c] >= mesh.positions.size())
                    in_.fail("a face has the vertex " + std::to_string(triangle[c]) + ": must be below " +
                             std::to_string(mesh.positions.size()));
        if (mesh.triangles.empty()) in_.fail("there is no face in it");
        return mesh;
    }

    void readHeader() {
        if (in_.line() != "ply") in_.fail("its first line must be \"ply\"");
        for (;;) {
            const std::string text = in_.line();
            std::string_view rest = text;
            const std::string_view keyword = takeWord(rest);
            if (keyword == "end_header") break;
            if (keyword == "format")
                setFormat(takeWord(rest));
            else if (keyword == "element")
                addElement(rest);
            else if (keyword == "property")
                addProperty(rest);
            else if (keyword != "comment" && keyword != "obj_info" && !text.empty())
                in_.fail('"' + printable(text, 100) +
                         "\" is no line of a header; known are format, element, property, comment, obj_info");
            else if (++emptyLines_ > kMaxComments)
                in_.fail("its header has no end_header");
        }
        if (!hasFormat_) in_.fail("its header has no format");
    }

    void setFormat(std::string_view format) {
        hasFormat_ = true;
        if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
            in_.fail("format \"" + printable(format, 100) +
                     "\" is unknown; known are ascii, binary_little_endian, binary_big_endian");
        in_.setFormat(format == "ascii", format == "binary_big_endian");
    }

    void addElement(std::string_view rest) {
        PlyElement element;
        element.name = std::string(takeWord(rest));
        const std::string_view count = takeWord(rest);
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size())
            in_.fail("element \"" + printable(element.name, 100) + "\": its number must be whole and not negative");
        if (elements_.size() == kMaxElements) in_.fail("its header has too many elements");
        elements_.push_back(std::move(element));
    }

    const PlyType& typeOf(std::string_view name) const {
        for (const PlyType& type : kPlyTypes)
            if (type.name == name || type.other == name) return type;
        in_.fail("the type \"" + printable(name, 100) +
                 "\" of a property is unknown; known are char, uchar, short, ushort, int, uint, float, double");
    }

    void addProperty(std::string_view rest) {
        if (elements_.empty()) in_.fail("a property must follow an element");
        PlyProperty property;
        std::string_view type = takeWord(rest);
        if (type == "list") {
            property.countType = &typeOf(takeWord(rest));
            type = takeWord(rest);
        }
        property.type = &typeOf(type);
        const std::string_view name = takeWord(rest);
        property.isCorners = property.countType && (name == "vertex_indices" || name == "vertex_index");
        if (!property.countType)
            for (const PlyRoleName& known : kPlyRoleNames)
                if (known.name == name) property.role = known.role;
        elements_.back().properties.push_back(property);
        if (elements_.back().properties.size() > kMaxElements) in_.fail("an element has too many properties");
    }

    std::uint64_t listCount(const PlyProperty& property) {
        const double count = in_.number(*property.countType);
        if (!(count >= 0 && count <= 4294967295.0 && count == std::floor(count)))
            in_.fail("the length of a list must be whole and not negative");
        budget_.spend(static_cast<std::uint64_t>(count), place_);
        return static_cast<std::uint64_t>(count);
    }

    void skip(const PlyProperty& property) {
        const std::uint64_t count = property.countType ? listCount(property) : 1;
        for (std::uint64_t i = 0; i < count; ++i) in_.number(*property.type);
    }
    void skip(const std::vector<PlyProperty>& properties) {
        for (const PlyProperty& property : properties) skip(property);
    }

    template <class Real>
    void readVertices(const PlyElement& element, MeshOf<Real>& mesh) {
        if (!mesh.positions.empty()) in_.fail("it has two lists of vertices");
        std::array<bool, kPlyRoles + 1> has{};
        for (const PlyProperty& property : element.properties) has[static_cast<std::size_t>(property.role)] = true;
        const auto hasAll = [&has](PlyRole first, std::size_t count) {
            bool all = true;
            for (std::size_t i = 0; i < count; ++i) all = all && has[static_cast<std::size_t>(first) + i];
            return all;
        };
        if (!hasAll(PlyRole::X, 3)) in_.fail("its vertices have no x, y and z");
        const bool hasNormals = hasAll(PlyRole::NormalX, 3), hasUvs = hasAll(PlyRole::U, 2);
        const auto expected = std::min(element.count, in_.size()); // whatever the header says
        mesh.positions.reserve(expected);
        if (hasNormals) mesh.normals.reserve(expected);
        if (hasUvs) mesh.uvs.reserve(expected);
        std::array<double, kPlyRoles + 1> values{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (property.countType)
                    skip(property);
                else
                    values[static_cast<std::size_t>(property.role)] = in_.number(*property.type);
            }
            for (std::size_t role = 0; role < kPlyRoles; ++role)
                if (!(std::abs(values[role]) <= kLargest))
                    in_.fail("vertex " + std::to_string(i) + ": its numbers must be from -1e9 to 1e9");
            mesh.positions.emplace_back(values[0], values[1], values[2]);
            if (hasNormals) mesh.normals.emplace_back(values[3], values[4], values[5]);
            if (hasUvs) mesh.uvs.emplace_back(values[6], values[7]);
        }
    }

    void readFaces(const PlyElement& element, std::vector<glm::uvec3>& triangles) {
        triangles.reserve(std::min(element.count, in_.size()));
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) {
                if (property.isCorners)
                    readCorners(property, i, triangles);
                else
                    skip(property);
            }
    }

    void readCorners(const PlyProperty& property, std::uint64_t face, std::vector<glm::uvec3>& triangles) {
        const std::uint64_t count = listCount(property);
        if (count < 3) in_.fail("face " + std::to_string(face) + ": must have 3 corners or more");
        glm::uvec3 corners(0);
        for (std::uint64_t i = 0; i < count; ++i) {
            const double index = in_.number(*property.type);
            if (!(index >= 0 && index <= 4294967294.0))
                in_.fail("face " + std::to_string(face) + ": has a vertex that is no index");
            corners[i == 0 ? 0 : i == 1 ? 1 : 2] = static_cast<std::uint32_t>(index);
            if (i < 2) continue;
            triangles.push_back(corners);
            corners[1] = corners[2];
        }
    }

    static constexpr std::size_t kMaxElements = 100, kMaxComments = 100000;

    PlyInput in_;
    PbrtBudget& budget_;
    const PbrtPlace place_;
    std::vector<PlyElement> elements_;
    std::size_t emptyLines_ = 0;
    bool hasFormat_ = false;
};

} // namespace

std::variant<MeshData, FloatMeshData> loadPbrtPly(const std::filesystem::path& path, PbrtBudget& budget) {
    return PlyReader(path, budget).read();
}

} // namespace rt::scene
