#include "tests/gui/Framebuffer.h"

#include <X11/XWDFile.h>
#include <X11/Xlib.h>
#include <algorithm>
#include <fcntl.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#undef None // a macro of X11 and a word of our enumerators, where sources are merged

namespace rt::test {
namespace {

// Of the file's header, whose first byte is the highest.
std::size_t fieldOfHeader(const CARD32& field) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&field);
    return std::size_t{bytes[0]} << 24 | std::size_t{bytes[1]} << 16 | std::size_t{bytes[2]} << 8 | bytes[3];
}

} // namespace

struct Framebuffer::Server {
    Server(const std::string& display, const std::filesystem::path& file);
    ~Server() {
        if (bytes != MAP_FAILED) munmap(bytes, length);
        if (connection != nullptr) XCloseDisplay(connection);
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    Display* connection;
    void* bytes = MAP_FAILED;
    std::size_t length = 0, width = 0, height = 0;
    const std::uint32_t* pixels = nullptr;
};

Framebuffer::Server::Server(const std::string& display, const std::filesystem::path& file)
    : connection(XOpenDisplay(display.c_str())) {
    const int descriptor = open(file.c_str(), O_RDONLY);
    struct stat status {};
    if (connection == nullptr || descriptor < 0 || fstat(descriptor, &status) != 0)
        throw std::runtime_error(file.string() + ": not of a screen");
    length = static_cast<std::size_t>(status.st_size);
    bytes = mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor, 0);
    close(descriptor);
    if (bytes == MAP_FAILED) throw std::runtime_error(file.string() + ": cannot be read");
    const auto& header = *static_cast<const XWDFileHeader*>(bytes);
    const std::size_t begin = fieldOfHeader(header.header_size) + fieldOfHeader(header.ncolors) * sz_XWDColor;
    width = fieldOfHeader(header.pixmap_width);
    height = fieldOfHeader(header.pixmap_height);
    if (fieldOfHeader(header.bits_per_pixel) != 32 || fieldOfHeader(header.bytes_per_line) != 4 * width ||
        begin % 4 != 0 || begin + 4 * width * height > length)
        throw std::runtime_error(file.string() + ": not of four bytes a pixel");
    pixels = reinterpret_cast<const std::uint32_t*>(static_cast<const char*>(bytes) + begin);
}

Framebuffer::Framebuffer(const std::string& display, const std::filesystem::path& folder)
    : server_(std::make_unique<Server>(display, folder / "Xvfb_screen0")) {}

Framebuffer::~Framebuffer() = default;

Screenshot Framebuffer::look() {
    const Server& server = *server_;
    const std::uint32_t* const end = server.pixels + server.width * server.height;
    XGrabServer(server.connection);
    XSync(server.connection, False);
    const bool isNew = !std::equal(server.pixels, end, seen_.begin(), seen_.end());
    if (isNew) seen_.assign(server.pixels, end);
    XUngrabServer(server.connection);
    XFlush(server.connection);
    if (isNew) {
        Screenshot::Pixels pixels = seen_;
        for (std::uint32_t& pixel : pixels) pixel &= 0xffffffu;
        last_ = {static_cast<int>(server.width), static_cast<int>(server.height),
                 std::make_shared<const Screenshot::Pixels>(std::move(pixels))};
    }
    return last_;
}

} // namespace rt::test
