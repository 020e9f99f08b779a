// A library to preload that lets allocations fail. RT_ALLOCATION_FAULT is the number of one, counted from the beginning
// of main: "120" makes the 120th fail; after "120+4096" memory is full from there on but for 4096 bytes and what is
// freed. RT_ALLOCATION_COUNT names a file that gets the number of all when the program ends, and how many bytes were in
// use at most.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <climits>

// What glibc's own functions are called beside the names that are replaced here: to look these up by dlsym would
// allocate.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* memory, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
void __libc_free(void* memory);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {

std::atomic<bool> isCounting{false};
std::atomic<long> allocations{0}, bytesInUse{0}, peakBytes{0}, maxBytes{LONG_MAX};
long faulty = 0;     // the number of the allocation that fails
long bytesLeft = -1; // from then on; -1: as many as ever

// Whether this allocation goes well.
bool hasRoom(std::size_t bytes) {
    if (!isCounting.load(std::memory_order_relaxed)) return true;
    const long number = ++allocations;
    // What the program frees when one fails, before it tries again, is not part of what it has then.
    if (bytesLeft >= 0 && number == faulty + 1) maxBytes = bytesInUse + bytesLeft;
    if (number != faulty && bytesInUse + static_cast<long>(bytes) <= maxBytes) return true;
    errno = ENOMEM;
    return false;
}

void* counted(void* memory) {
    if (memory == nullptr) return memory;
    const long bytes = bytesInUse += static_cast<long>(malloc_usable_size(memory));
    for (long peak = peakBytes; bytes > peak && !peakBytes.compare_exchange_weak(peak, bytes);) continue;
    return memory;
}

void discount(void* memory) {
    if (memory != nullptr) bytesInUse -= static_cast<long>(malloc_usable_size(memory));
}

using Main = int(int, char**, char**);
Main* realMain = nullptr;

int countedMain(int count, char** arguments, char** environment) {
    if (const char* const fault = std::getenv("RT_ALLOCATION_FAULT")) {
        char* rest = nullptr;
        faulty = std::strtol(fault, &rest, 10);
        if (*rest == '+') bytesLeft = std::strtol(rest, nullptr, 10);
    }
    isCounting = true;
    return realMain(count, arguments, environment);
}

__attribute__((destructor)) void writeCount() {
    isCounting = false;
    const char* const file = std::getenv("RT_ALLOCATION_COUNT");
    const int descriptor = file != nullptr ? open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600) : -1;
    if (descriptor >= 0) dprintf(descriptor, "%ld %ld\n", allocations.load(), peakBytes.load());
}

} // namespace

extern "C" {

// NOLINTNEXTLINE(bugprone-reserved-identifier): glibc's name
int __libc_start_main(Main* program, int count, char** arguments, void (*begin)(), void (*end)(), void (*unload)(),
                      void* stack) {
    realMain = program;
    const auto start = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
    return start(countedMain, count, arguments, begin, end, unload, stack);
}

void* malloc(size_t bytes) {
    return hasRoom(bytes) ? counted(__libc_malloc(bytes)) : nullptr;
}

void* calloc(size_t count, size_t bytes) {
    return hasRoom(count * bytes) ? counted(__libc_calloc(count, bytes)) : nullptr;
}

void* realloc(void* memory, size_t bytes) {
    if (!hasRoom(bytes)) return nullptr;
    const long before = memory != nullptr ? static_cast<long>(malloc_usable_size(memory)) : 0;
    void* const moved = __libc_realloc(memory, bytes);
    if (moved != nullptr || bytes == 0) bytesInUse -= before;
    return counted(moved);
}

void* aligned_alloc(size_t alignment, size_t bytes) {
    return hasRoom(bytes) ? counted(__libc_memalign(alignment, bytes)) : nullptr;
}

int posix_memalign(void** memory, size_t alignment, size_t bytes) {
    *memory = aligned_alloc(alignment, bytes);
    return *memory != nullptr ? 0 : ENOMEM;
}

void free(void* memory) {
    discount(memory);
    __libc_free(memory);
}
}
