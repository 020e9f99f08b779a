#include "Common/Core/Parallel.h"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <new>
#include <system_error>

namespace rt {

#ifdef RT_THREADS_SANITIZED

bool canStartThreads() {
    return true;
}

#else

namespace {

// Bytes, more than oneTBB needs to begin. Where it gets none while it begins, release 2021.11 (of Ubuntu 24.04) waits
// for a lock that it holds itself. It maps its memory, and so many are mapped, too, by glibc (over 32 MiB) and given back.
constexpr std::size_t kLibraryBytes = 40 << 20;

// Whether that many threads, each with its stack, can exist at the same time, and there is memory left for the library.
bool haveRoomForThreads(std::size_t count) {
    std::mutex gate;
    std::unique_ptr<char[]> ofLibrary;
    std::vector<std::thread> threads;
    bool all = true;
    {
        const std::scoped_lock closed(gate);
        try {
            threads.reserve(count);
            const auto pass = [&gate, &ofLibrary] {
                const std::scoped_lock passing(gate);
                if (ofLibrary) ofLibrary[0] = 1; // is used, so that no compiler leaves it out
            };
            while (threads.size() < count) threads.emplace_back(pass);
            ofLibrary = std::make_unique_for_overwrite<char[]>(kLibraryBytes);
        } catch (const std::system_error&) {
            all = false;
        } catch (const std::bad_alloc&) {
            all = false;
        }
    }
    for (std::thread& thread : threads) thread.join();
    return all;
}

// Has the library start its threads: each call waits a moment for the others, so that no thread makes two of them.
void meetOnThreads(std::size_t count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
    std::mutex mutex;
    std::condition_variable everybodyIsHere;
    std::size_t present = 0;
    const auto meet = [&](std::size_t) {
        std::unique_lock lock(mutex);
        if (++present == count) everybodyIsHere.notify_all();
        everybodyIsHere.wait_until(lock, deadline, [&] { return present == count; });
    };
#if defined(__cpp_lib_execution)
    std::vector<std::size_t> indices(count);
    std::for_each(std::execution::par, indices.begin(), indices.end(), meet);
#else
    tbb::parallel_for(std::size_t{0}, count, meet);
#endif
}

} // namespace

bool canStartThreads() {
    static const bool can = [] {
        const std::size_t count = threadCount(0);
        if (!haveRoomForThreads(count)) return false;
        meetOnThreads(count);
        return true;
    }();
    return can;
}

#endif

} // namespace rt
