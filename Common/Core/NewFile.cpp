#include "Common/Core/NewFile.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "Common/Core/Error.h"

namespace rt {

namespace fs = std::filesystem;

#ifdef _WIN32

std::error_code createExclusively(const fs::path& path, Access) {
    const HANDLE file =
        CreateFileW(path.c_str(), GENERIC_WRITE, 0, nullptr, CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (file == INVALID_HANDLE_VALUE) return {static_cast<int>(GetLastError()), std::system_category()};
    CloseHandle(file);
    return {};
}

void copyOwnerAndMode(const fs::path&, const fs::path&) {}

void openStandardStreams() {} // handles are given out by another rule

#else

std::error_code createExclusively(const fs::path& path, Access access) {
    const mode_t mode = access == Access::OwnerOnly ? 0600 : 0666;
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file < 0) return {errno, std::generic_category()};
    close(file);
    return {};
}

void copyOwnerAndMode(const fs::path& from, const fs::path& to) {
    struct stat wanted = {};
    struct stat made = {};
    if (stat(from.c_str(), &wanted) != 0 || lstat(to.c_str(), &made) != 0) return;
    mode_t mode = wanted.st_mode & 0777;
    const bool isGroupKept =
        made.st_gid == wanted.st_gid || lchown(to.c_str(), static_cast<uid_t>(-1), wanted.st_gid) == 0;
    if (!isGroupKept) mode &= ~mode_t{070} | (mode & mode_t{07}) << 3;
    if (chmod(to.c_str(), mode) != 0) return;
    // Last: a file that has been given away can no more be changed.
    if (made.st_uid != wanted.st_uid) (void)!lchown(to.c_str(), wanted.st_uid, static_cast<gid_t>(-1));
}

void openStandardStreams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0) (void)!open("/dev/null", O_RDWR); // takes the lowest number that is free
}

#endif

fs::path createNumbered(const fs::path& folder, const fs::path& name) {
    constexpr int kMaxNumbers = 10000;
    fs::path path = folder / name;
    for (int number = 2; number < kMaxNumbers; ++number) {
        const std::error_code error = createExclusively(path, Access::Everybody);
        if (!error) return path;
        if (error != std::errc::file_exists)
            throw RenderError("cannot write " + path.string() + ": " + error.message());
        path = folder / (name.stem().string() + "." + std::to_string(number) + name.extension().string());
    }
    throw RenderError("cannot write " + path.string() + ": there are too many files of that name");
}

} // namespace rt
