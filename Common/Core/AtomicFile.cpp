#include "Common/Core/AtomicFile.h"

#include <mutex>
#include <random>
#include <set>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Format.h"

namespace rt {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = ".rt-", kSuffix = ".tmp";
constexpr std::size_t kDigits = 16; // between them

// Short, whatever the target's name, so that it fits wherever the target does.
std::string temporaryName() {
    std::random_device device;
    const unsigned first = device(), second = device();
    return std::string(kPrefix) + formatted("%08x%08x", first, second) + std::string(kSuffix);
}

bool isTemporary(const std::string& name) {
    return name.size() == kPrefix.size() + kDigits + kSuffix.size() && name.starts_with(kPrefix) &&
           name.ends_with(kSuffix);
}

// Once a program in each folder that it writes to.
void removeLeftovers(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> visited;
    {
        const std::scoped_lock lock(mutex);
        if (!visited.insert(folder).second) return;
    }
    for (const std::string& name : namesIn(folder.empty() ? "." : folder))
        if (isTemporary(name)) removeAbandoned(folder / name);
}

} // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(path) {
    std::error_code ignored; // what cannot be looked at is reported when it is opened
    if (const fs::path followed = fs::canonical(path, ignored); !ignored) target_ = followed;
    const fs::file_status status = fs::status(target_, ignored);
    if (fs::is_directory(status)) fail(std::make_error_code(std::errc::is_a_directory));
    if (!fs::exists(status)) createTemporary(Access::Everybody);
    if (fs::is_regular_file(status)) createTemporary(Access::OwnerOnly); // what it replaces may be private
    if (const std::error_code error = file_.open(temporary_.empty() ? target_ : temporary_)) {
        fs::remove(temporary_, ignored);
        fail(error);
    }
    if (!temporary_.empty()) file_.lock();
}

void AtomicFile::createTemporary(Access access) {
    removeLeftovers(target_.parent_path());
    std::error_code error = std::make_error_code(std::errc::file_exists);
    while (error == std::errc::file_exists) {
        temporary_ = target_.parent_path() / temporaryName();
        error = createExclusively(temporary_, access);
    }
    if (error) fail(error);
}

AtomicFile::~AtomicFile() {
    file_.close();
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit(Durability durability) {
    const bool toDisk = durability == Durability::ToDisk;
    if (const std::error_code error = file_.finish(toDisk)) fail(error);
    if (stream_.fail()) fail(std::make_error_code(std::errc::io_error)); // by whoever wrote to it
    if (temporary_.empty()) return;
    std::error_code error;
    if (fs::is_regular_file(target_, error)) copyOwnerAndMode(target_, temporary_);
    fs::rename(temporary_, target_, error);
    if (error) fail(error);
    temporary_.clear();
    if (const std::error_code lost = toDisk ? syncFolder(target_.parent_path()) : error) fail(lost);
}

void AtomicFile::fail(const std::error_code& error) const {
    const bool isUnread = error == std::errc::no_such_device_or_address;
    const bool isStalled = error == std::errc::timed_out;
    throw RenderError("cannot write " + path_.string() + ": " +
                      (isUnread    ? "nobody reads from this pipe"
                       : isStalled ? "whoever reads from this pipe takes nothing"
                                   : error.message()));
}

} // namespace rt
