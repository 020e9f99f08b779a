#include "Common/Core/ReadFile.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <new>
#include <system_error>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"

namespace rt {

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limit) {
    const auto fail = [&path](const std::string& reason) {
        throw InputError("cannot read " + path.string() + ": " + reason);
    };
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) fail(std::generic_category().message(EISDIR));
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) fail(errno == 0 ? "open failed" : std::generic_category().message(errno));

    // In growing pieces, because pipes and devices do not tell their size.
    std::vector<std::byte> content;
    std::size_t piece = std::size_t{1} << 16;
    try {
        while (in) {
            interruptionPoint();
            const std::size_t have = content.size();
            content.resize(have + piece);
            errno = 0;
            in.read(reinterpret_cast<char*>(content.data() + have), static_cast<std::streamsize>(piece));
            content.resize(have + static_cast<std::size_t>(in.gcount()));
            if (content.size() > limit) fail("it is larger than " + std::to_string(limit) + " bytes");
            piece = std::clamp(content.size(), piece, std::size_t{1} << 26);
        }
    } catch (const std::bad_alloc&) {
        fail("it does not fit into memory");
    }
    if (in.bad()) fail(errno == 0 ? "read failed" : std::generic_category().message(errno));
    return content;
}

} // namespace rt
