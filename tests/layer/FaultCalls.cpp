// A library to preload that lets calls of the operating system fail as they fail on full disks. RT_CALL_FAULTS lists
// what goes wrong: "write:3=28,fsync:1=5" makes the third write to a file fail with ENOSPC and the first fsync with
// EIO; "write:2=0" writes but one byte. "remove:1=2" sends the program SIGINT before the first file is removed.
// RT_CALL_LOG names a file that gets a line for each call.
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

namespace {

std::atomic<int> writes{0}, syncs{0}, renames{0}, removals{0};

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void log(const char* line) {
    const char* const file = std::getenv("RT_CALL_LOG");
    const int descriptor = file != nullptr ? open(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600) : -1;
    if (descriptor < 0) return;
    (void)!next<decltype(write)>("write")(descriptor, line, std::strlen(line));
    close(descriptor);
}

// The error of this call; -1: it goes well.
int fault(const char* call, std::atomic<int>& count) {
    const int number = ++count;
    const char* const list = std::getenv("RT_CALL_FAULTS");
    char key[48];
    std::snprintf(key, sizeof key, "%s:%d=", call, number);
    const char* const found = list != nullptr ? std::strstr(list, key) : nullptr;
    return found != nullptr ? std::atoi(found + std::strlen(key)) : -1;
}

} // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t count) {
    const auto real = next<decltype(write)>("write");
    if (descriptor <= STDERR_FILENO) return real(descriptor, bytes, count);
    log("write\n");
    const int error = fault("write", writes);
    if (error <= 0) return real(descriptor, bytes, error == 0 ? 1 : count);
    errno = error;
    return -1;
}

int fsync(int descriptor) {
    log("fsync\n");
    if (const int error = fault("fsync", syncs); error > 0) {
        errno = error;
        return -1;
    }
    return next<decltype(fsync)>("fsync")(descriptor);
}

int rename(const char* from, const char* to) noexcept {
    log("rename\n");
    if (const int error = fault("rename", renames); error > 0) {
        errno = error;
        return -1;
    }
    return next<int(const char*, const char*)>("rename")(from, to);
}

int remove(const char* path) noexcept {
    log("remove\n");
    if (const int signal = fault("remove", removals); signal > 0) (void)std::raise(signal);
    return next<int(const char*)>("remove")(path);
}
}
