#include "Common/Scene/Pbrt/PbrtBytes.h"

#include <fstream>
#include <system_error>
#include <vector>

#ifdef RT_HAS_ZLIB
#include <zlib.h>
#endif

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/OpenFile.h"

namespace rt::scene {

namespace {

constexpr std::uint64_t kMaxPbrtBytes = std::uint64_t{16} << 30;

} // namespace

struct PbrtBytes::Impl {
    explicit Impl(const std::filesystem::path& path)
        : name(path.string()), in(openFile(path, kMaxPbrtBytes)), packed(kPiece) {
        std::error_code none;
        size = std::filesystem::file_size(path, none);
        if (none) size = 0;
        isPacked = in.get() == 0x1f && in.get() == 0x8b;
        in.clear();
        in.seekg(0);
#ifdef RT_HAS_ZLIB
        if (!isPacked) return;
        constexpr int kGzipOnly = 16;
        if (inflateInit2(&stream, kGzipOnly + MAX_WBITS) != Z_OK) fail("zlib has no memory");
        isOpen = true;
#else
        if (isPacked) fail("is packed by gzip, which this build lacks");
#endif
    }
    ~Impl() {
#ifdef RT_HAS_ZLIB
        if (isOpen) inflateEnd(&stream);
#endif
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    [[noreturn]] void fail(const std::string& reason) const;

    std::size_t readPlain(char* to, std::size_t most) {
        interruptionPoint();
        in.read(to, static_cast<std::streamsize>(most));
        if (in.bad()) fail("cannot be read");
        return static_cast<std::size_t>(in.gcount());
    }

#ifdef RT_HAS_ZLIB
    std::size_t unpack(char* to, std::size_t most) {
        stream.next_out = reinterpret_cast<Bytef*>(to);
        stream.avail_out = static_cast<uInt>(most);
        while (stream.avail_out == most && !hasEnded) {
            if (stream.avail_in == 0) {
                stream.next_in = reinterpret_cast<Bytef*>(packed.data());
                stream.avail_in = static_cast<uInt>(readPlain(packed.data(), packed.size()));
                if (stream.avail_in == 0) fail("its gzip data end too early");
            }
            const int status = inflate(&stream, Z_NO_FLUSH);
            if (status == Z_STREAM_END)
                next();
            else if (status != Z_OK && status != Z_BUF_ERROR)
                fail("its gzip data are damaged");
        }
        return most - stream.avail_out;
    }

    // Several packed files one after the other are one.
    void next() {
        if (stream.avail_in == 0) {
            stream.next_in = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_in = static_cast<uInt>(readPlain(packed.data(), packed.size()));
        }
        hasEnded = stream.avail_in == 0 || *stream.next_in != 0x1f; // what is no further one is filling
        if (!hasEnded) inflateReset(&stream);
    }

    z_stream stream{};
    bool isOpen = false, hasEnded = false;
#endif

    static constexpr std::size_t kPiece = std::size_t{1} << 16;
    const std::string name;
    std::ifstream in;
    std::vector<char> packed;
    std::uint64_t size = 0;
    bool isPacked = false;
};

void PbrtBytes::Impl::fail(const std::string& reason) const {
    throw InputError(name + ": " + reason);
}

PbrtBytes::PbrtBytes(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
PbrtBytes::~PbrtBytes() = default;
PbrtBytes::PbrtBytes(PbrtBytes&&) noexcept = default;
PbrtBytes& PbrtBytes::operator=(PbrtBytes&&) noexcept = default;

std::size_t PbrtBytes::read(char* to, std::size_t most) {
#ifdef RT_HAS_ZLIB
    if (impl_->isPacked) return impl_->unpack(to, most);
#endif
    return impl_->readPlain(to, most);
}

std::uint64_t PbrtBytes::size() const {
    return impl_->size;
}

} // namespace rt::scene
