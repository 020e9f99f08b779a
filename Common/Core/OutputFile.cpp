#include "Common/Core/OutputFile.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <memory>

#include <climits>

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#else
#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "Common/Core/Interruption.h"

namespace rt {

namespace fs = std::filesystem;

namespace {

std::error_code lastError() {
    return {errno, std::generic_category()};
}

bool isOld(const fs::path& file) {
    std::error_code error;
    const fs::file_time_type changed = fs::last_write_time(file, error);
    return !error && fs::file_time_type::clock::now() - changed > std::chrono::minutes(1);
}

#ifdef _WIN32

int openForWriting(const fs::path& path) {
    int descriptor = -1;
    _wsopen_s(&descriptor, path.c_str(), _O_WRONLY | _O_CREAT | _O_TRUNC | _O_BINARY | _O_NOINHERIT, _SH_DENYNO,
              _S_IREAD | _S_IWRITE);
    return descriptor;
}

std::ptrdiff_t writeSome(int descriptor, const char* bytes, std::size_t count) {
    return _write(descriptor, bytes, static_cast<unsigned>(std::min<std::size_t>(count, INT_MAX)));
}

bool syncDescriptor(int descriptor) {
    return _commit(descriptor) == 0;
}

bool closeDescriptor(int descriptor) {
    return _close(descriptor) == 0;
}

#else

int openForWriting(const fs::path& path) {
    std::error_code ignored;
    const int waiting = fs::is_fifo(path, ignored) ? O_NONBLOCK : 0;
    return open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | waiting, 0666);
}

std::ptrdiff_t writeSome(int descriptor, const char* bytes, std::size_t count) {
    return write(descriptor, bytes, count);
}

bool syncDescriptor(int descriptor) {
#ifdef __APPLE__
    if (fcntl(descriptor, F_FULLFSYNC) == 0) return true; // fsync leaves it in the disk's own memory
#endif
    // Devices, pipes and some file systems cannot.
    return fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

bool closeDescriptor(int descriptor) {
    return close(descriptor) == 0;
}

#endif

} // namespace

OutputFile::~OutputFile() {
    sync();
    close();
}

std::error_code OutputFile::open(const fs::path& path) {
    descriptor_ = openForWriting(path);
    if (descriptor_ < 0) return lastError();
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return {};
}

std::error_code OutputFile::finish(bool toDisk) {
    sync();
    if (!error_ && toDisk && !syncDescriptor(descriptor_)) error_ = lastError();
    close();
    return error_;
}

void OutputFile::close() {
    if (descriptor_ >= 0 && !closeDescriptor(descriptor_) && !error_) error_ = lastError(); // of a network, perhaps
    descriptor_ = -1;
    setp(nullptr, nullptr);
}

OutputFile::int_type OutputFile::overflow(int_type character) {
    if (sync() != 0 || descriptor_ < 0) return traits_type::eof();
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    return sputc(traits_type::to_char_type(character));
}

// What is larger than the buffer goes past it.
std::streamsize OutputFile::xsputn(const char* text, std::streamsize count) {
    if (count < static_cast<std::streamsize>(kBufferBytes)) return std::streambuf::xsputn(text, count);
    return sync() == 0 && send(text, static_cast<std::size_t>(count)) ? count : 0;
}

int OutputFile::sync() {
    const bool isSent = send(pbase(), static_cast<std::size_t>(pptr() - pbase()));
    setp(pbase(), epptr());
    return isSent ? 0 : -1;
}

bool OutputFile::send(const char* bytes, std::size_t count) {
    while (count > 0 && !error_) {
        const std::ptrdiff_t written = writeSome(descriptor_, bytes, count);
        if (written >= 0) {
            bytes += written;
            count -= static_cast<std::size_t>(written);
        } else if (errno == EAGAIN) {
            if (!awaitReader()) error_ = std::make_error_code(std::errc::timed_out);
        } else if (errno != EINTR) {
            error_ = lastError();
        }
    }
    return !error_;
}

#ifdef _WIN32

bool OutputFile::awaitReader() {
    return false; // no file is a pipe here
}

void OutputFile::lock() {} // a file that is open cannot be removed

std::error_code syncFolder(const fs::path&) {
    return {}; // renames are in the file system's journal
}

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename().string());
    return names;
}

void removeAbandoned(const fs::path& file) {
    std::error_code ignored;
    if (isOld(file)) fs::remove(file, ignored);
}

#else

bool OutputFile::awaitReader() {
    constexpr int kLook = 100, kPatience = 1000; // milliseconds: between two looks, of one who is interrupted
    pollfd reader{descriptor_, POLLOUT, 0};
    for (int waited = 0; waited < kPatience || !interruptionRequested(); waited = std::min(waited + kLook, kPatience))
        if (poll(&reader, 1, kLook) > 0) return true;
    return false;
}

void OutputFile::lock() {
    (void)flock(descriptor_, LOCK_SH | LOCK_NB); // where there are no locks, files are told to be in use by their age
}

std::error_code syncFolder(const fs::path& folder) {
    const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return {}; // one that may be written but not read
    const std::error_code error = syncDescriptor(descriptor) ? std::error_code() : lastError();
    close(descriptor);
    return error;
}

std::vector<std::string> namesIn(const fs::path& folder) {
    const auto closing = [](DIR* opened) { closedir(opened); };
    const std::unique_ptr<DIR, decltype(closing)> opened(opendir(folder.c_str()), closing);
    std::vector<std::string> names;
    while (const dirent* entry = opened ? readdir(opened.get()) : nullptr) names.emplace_back(entry->d_name);
    return names;
}

void removeAbandoned(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    struct stat is = {};
    const bool isOwn = fstat(descriptor, &is) == 0 && S_ISREG(is.st_mode) && is.st_uid == geteuid();
    if (isOwn && isOld(file) && flock(descriptor, LOCK_EX | LOCK_NB) == 0) unlink(file.c_str());
    close(descriptor);
}

#endif

} // namespace rt
