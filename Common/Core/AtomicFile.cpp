#include "Common/Core/AtomicFile.h"

#include <cerrno>
#include <cstdio>
#include <random>

#include "Common/Core/Error.h"
#include "Common/Core/NewFile.h"

namespace rt {

namespace fs = std::filesystem;

namespace {

std::string reasonOf(int error) {
    return error == 0 ? "write failed" : std::generic_category().message(error);
}

// Short, whatever the target's name, so that it fits wherever the target does.
std::string temporaryName() {
    std::random_device device;
    char name[32];
    std::snprintf(name, sizeof name, ".rt-%08x%08x.tmp", static_cast<unsigned>(device()),
                  static_cast<unsigned>(device()));
    return name;
}

} // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(path) {
    std::error_code ignored; // what cannot be looked at is reported when it is opened
    if (const fs::path followed = fs::canonical(path, ignored); !ignored) target_ = followed;
    const fs::file_status status = fs::status(target_, ignored);
    if (fs::is_directory(status)) fail(reasonOf(EISDIR));
    if (!fs::exists(status)) createTemporary(Access::Everybody);
    if (fs::is_regular_file(status)) createTemporary(Access::OwnerOnly); // what it replaces may be private
    errno = 0;
    stream_.open(temporary_.empty() ? target_ : temporary_, std::ios::binary | std::ios::trunc);
    if (!stream_) {
        const int error = errno;
        fs::remove(temporary_, ignored);
        fail(reasonOf(error));
    }
}

void AtomicFile::createTemporary(Access access) {
    std::error_code error = std::make_error_code(std::errc::file_exists);
    while (error == std::errc::file_exists) {
        temporary_ = target_.parent_path() / temporaryName();
        error = createExclusively(temporary_, access);
    }
    if (error) fail(error.message());
}

AtomicFile::~AtomicFile() {
    stream_.close();
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
    const bool lost = stream_.fail();
    errno = 0;
    if (lost) { // the reason may be gone by now: fail once more to learn it
        stream_.clear();
        stream_.put(0);
    }
    stream_.close();
    if (lost || stream_.fail()) fail(reasonOf(errno));
    if (temporary_.empty()) return;
    std::error_code error;
    if (fs::is_regular_file(target_, error)) copyOwnerAndMode(target_, temporary_);
    fs::rename(temporary_, target_, error);
    if (error) fail(error.message());
    temporary_.clear();
}

void AtomicFile::fail(const std::string& reason) const {
    throw RenderError("cannot write " + path_.string() + ": " + reason);
}

} // namespace rt
