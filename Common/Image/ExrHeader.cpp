// File layout (openexr.com, "OpenEXR File Layout"), as far as headers go:
//
//   magic, version | headers: attributes, an empty name | with several parts an empty header
//   attribute: name, type, size, value
#include "Common/Image/ExrHeader.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"

namespace rt::image {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

namespace {

constexpr std::uint32_t kExrMagic = 20000630;
constexpr std::uint32_t kMultiPart = 0x1000; // flag of the version

struct AttributeType {
    const char* name;
    std::size_t bytes;
};

// Of the types whose readers in the library take no notice of the size that the file states. Those of lists, texts and
// preview images do, and types that it does not know are read as so many bytes.
constexpr AttributeType kFixedTypes[] = {{"box2f", 16},
                                         {"box2i", 16},
                                         {"chromaticities", 32},
                                         {"compression", 1},
                                         {"deepImageState", 1},
                                         {"double", 8},
                                         {"envmap", 1},
                                         {"float", 4},
                                         {"int", 4},
                                         {"keycode", 28},
                                         {"lineOrder", 1},
                                         {"m33d", 72},
                                         {"m33f", 36},
                                         {"m44d", 128},
                                         {"m44f", 64},
                                         {"rational", 8},
                                         {"tiledesc", 9},
                                         {"timecode", 8},
                                         {"v2d", 16},
                                         {"v2f", 8},
                                         {"v2i", 8},
                                         {"v3d", 24},
                                         {"v3f", 12},
                                         {"v3i", 12}};

// Reads numbers and strings in order, never beyond the end.
class Cursor {
  public:
    Cursor(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    std::span<const std::byte> take(std::size_t count) {
        if (bytes_.size() - at_ < count) fail("truncated EXR file");
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    std::uint32_t number() {
        std::uint32_t value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string string() { // up to its terminating zero
        std::string text;
        while (const char c = static_cast<char>(take(1)[0])) text += c;
        return text;
    }
    bool atEnd() const { return at_ == bytes_.size(); }
    const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  private:
    std::span<const std::byte> bytes_;
    const std::string& name_;
    std::size_t at_ = 0;
};

// Whether the list of channels ends where its attribute does.
bool isChannelList(Cursor value) {
    constexpr std::size_t kChannelBytes = 16; // type, linearity and sampling
    while (!value.string().empty()) value.take(kChannelBytes);
    return value.atEnd();
}

bool hasSizeOfType(const std::string& type, Cursor value, std::size_t size) {
    if (type == "chlist") return isChannelList(value);
    if (type == "floatvector") return size % sizeof(float) == 0;
    const auto* const fixed = std::find_if(std::begin(kFixedTypes), std::end(kFixedTypes),
                                           [&](const AttributeType& known) { return known.name == type; });
    return fixed == std::end(kFixedTypes) || fixed->bytes == size;
}

// Returns whether the header holds an attribute.
bool checkHeader(Cursor& in) {
    bool holdsOne = false;
    for (std::string name = in.string(); !name.empty(); name = in.string()) {
        holdsOne = true;
        const std::string type = in.string();
        const std::uint32_t size = in.number();
        // The library of Debian 12 reads four bytes more of one than it has.
        if (type == "idmanifest") in.fail("EXR files with an ID manifest are not supported");
        if (!hasSizeOfType(type, Cursor(in.take(size), in.name()), size))
            in.fail("damaged EXR header: attribute \"" + printable(name) + "\" of type " + printable(type) + " has " +
                    std::to_string(size) + " bytes");
    }
    return holdsOne;
}

} // namespace

void checkExrHeaders(std::span<const std::byte> bytes, const std::string& name) {
    Cursor in(bytes, name);
    if (in.number() != kExrMagic) in.fail("not an EXR file");
    const bool isMultiPart = (in.number() & kMultiPart) != 0;
    while (checkHeader(in) && isMultiPart) continue;
}

} // namespace rt::image
