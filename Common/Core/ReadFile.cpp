#include "Common/Core/ReadFile.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <new>
#include <system_error>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/OpenFile.h"
#include "Common/Core/Paths.h"
#include "Common/Core/SystemMemory.h"

namespace rt {

namespace {

thread_local const ReadsBelow* confinement = nullptr;

// As the system finds it, links followed; what does not exist stays where it is named.
std::filesystem::path located(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::path found = std::filesystem::weakly_canonical(path, error);
    return error ? path : found;
}

} // namespace

ReadsBelow::ReadsBelow(const std::filesystem::path& folder, const std::filesystem::path& file)
    : file_(located(file)), outer_(confinement) {
    if (folder.empty()) return;
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw InputError("--assets-below " + folder.string() + ": there is no such folder");
    folders_ = assetFolders();
    folders_.push_back(folder);
    if (const std::filesystem::path maps = planetMapFolder(); !maps.empty()) folders_.push_back(maps);
    for (std::filesystem::path& allowed : folders_) allowed = located(allowed);
    confinement = this;
}

ReadsBelow::~ReadsBelow() {
    confinement = outer_;
}

bool ReadsBelow::allows(const std::filesystem::path& path) const {
    const std::filesystem::path place = located(path);
    const auto isBelow = [&place](const std::filesystem::path& folder) {
        return std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first == folder.end();
    };
    return place == file_ || std::any_of(folders_.begin(), folders_.end(), isBelow);
}

bool mayRead(const std::filesystem::path& path) {
    return confinement == nullptr || confinement->allows(path);
}

namespace {

[[noreturn]] void failToRead(const std::filesystem::path& path, const std::string& reason) {
    throw InputError("cannot read " + path.string() + ": " + reason);
}

// Also how many bytes it says to hold.
std::ifstream openOfSize(const std::filesystem::path& path, std::uint64_t limit, std::uintmax_t& size) {
    const auto fail = [&path](const std::string& reason) { failToRead(path, reason); };
    if (!mayRead(path)) fail("--assets-below does not allow it");
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail(error ? error.message() : std::generic_category().message(ENOENT));
    if (std::filesystem::is_directory(status)) fail(std::generic_category().message(EISDIR));
    if (!std::filesystem::is_regular_file(status)) fail("it is not a regular file"); // it might wait for ever
    size = std::filesystem::file_size(path, error);
    if (error) fail(error.message());
    if (size > limit) fail("it is larger than " + std::to_string(limit) + " bytes");
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) fail(errno == 0 ? "open failed" : std::generic_category().message(errno));
    return in;
}

} // namespace

bool isFile(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

std::ifstream openFile(const std::filesystem::path& path, std::uint64_t limit) {
    std::uintmax_t size = 0;
    return openOfSize(path, limit, size);
}

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t limit) {
    const auto fail = [&path](const std::string& reason) { failToRead(path, reason); };
    std::uintmax_t size = 0;
    std::ifstream in = openOfSize(path, limit, size);
    std::vector<std::byte> content;
    try {
        resizeLarge(content, static_cast<std::size_t>(size));
    } catch (const std::bad_alloc&) {
        fail("it does not fit into memory");
    }
    constexpr std::size_t kPiece = std::size_t{1} << 26; // between two looks at whether somebody waits for the end
    for (std::size_t at = 0; at < content.size() && in; at += kPiece) {
        interruptionPoint();
        const std::size_t count = std::min(kPiece, content.size() - at);
        errno = 0;
        in.read(reinterpret_cast<char*>(content.data() + at), static_cast<std::streamsize>(count));
    }
    if (in.bad()) fail(errno == 0 ? "read failed" : std::generic_category().message(errno));
    if (!in) fail("it became shorter while it was read");
    // Neither do files of a system's making, as below /proc, tell their size.
    if (in.peek() != std::ifstream::traits_type::eof()) fail("it holds more than its size says");
    return content;
}

} // namespace rt
