// Work spread over threads: std::execution where the standard library has it, oneTBB where it has not (libc++).
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>
#include <vector>

#if __has_include(<execution>)
#include <execution>
#endif
#if !defined(__cpp_lib_execution)
#include <tbb/parallel_for.h>
#endif

#include "Common/Core/Interruption.h"

#if defined(__SANITIZE_THREAD__)
#define RT_THREADS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RT_THREADS_SANITIZED 1
#endif
#endif

namespace rt {

inline std::size_t threadCount(std::size_t threads) {
    return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

// Whether threads can be had at all. The first call starts those of the library beneath std::execution, which would end
// the program if one could not be started later, when memory has run short.
bool canStartThreads();

// The exception of work on several threads, which must not leave a parallel algorithm: that would end the program. Of
// several the one of the least order, or else the first.
class FirstFailure {
  public:
    template <class Function>
    void guard(const Function& function, std::size_t order = 0) {
        try {
            function();
        } catch (...) {
            const std::scoped_lock lock(mutex_);
            if (!exception_ || order < order_) exception_ = std::current_exception(), order_ = order;
            happened_.store(true, std::memory_order_relaxed);
        }
    }
    bool happened() const { return happened_.load(std::memory_order_relaxed); }
    // To be called when all threads are done.
    void rethrow() const {
        if (exception_) std::rethrow_exception(exception_);
    }

  private:
    std::mutex mutex_;
    std::exception_ptr exception_;
    std::size_t order_ = 0;
    std::atomic<bool> happened_{false};
};

#ifdef RT_THREADS_SANITIZED
// Calls work(i) for each i in [0, count), each on a thread of its own. ThreadSanitizer cannot see how oneTBB's library,
// which is not compiled with it, hands work from thread to thread and takes each hand-over for a race; it sees how
// these do.
template <class Work>
void onThreads(std::size_t count, const Work& work) {
    std::vector<std::thread> threads;
    threads.reserve(count);
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&work, i] { work(i); });
    for (std::thread& thread : threads) thread.join();
}
#endif

// Calls f(i) once for each i in [0, count), on up to `threads` threads (0: as many as the machine has). Calls start in
// order of i, so the largest pieces of work belong first. When one throws, no more are started, and when those that run
// are done the exception of the least i is thrown again: the same for any number of threads. Who may call this thread's
// work off (Interruption.h) calls off the others' as well.
template <class Function>
void parallelFor(std::size_t threads, std::size_t count, const Function& f) {
    const std::size_t workers = std::min(threadCount(threads), count);
    if (workers <= 1 || !canStartThreads()) {
        for (std::size_t i = 0; i < count; ++i) {
            f(i);
        }
        return;
    }
    std::atomic<std::size_t> next{0};
    FirstFailure failure;
    const std::atomic<bool>* callOff = interruptionFlag();
    const auto work = [&](std::size_t) {
        const Interruptible likeTheCaller(callOff);
        for (std::size_t i; !failure.happened() && (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) {
            failure.guard([&] { f(i); }, i);
        }
    };
#if defined(RT_THREADS_SANITIZED)
    onThreads(workers, work);
#elif defined(__cpp_lib_execution)
    std::vector<std::size_t> indices(workers);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    std::for_each(std::execution::par, indices.begin(), indices.end(), work);
#else
    tbb::parallel_for(std::size_t{0}, workers, work);
#endif
    failure.rethrow();
}

// The pieces of [0, count) that parallel loops work on: their number depends on count alone, never on the threads.
struct Chunks {
    std::size_t count;
    std::size_t size;

    Chunks(std::size_t items, std::size_t itemsPerChunk)
        : count((items + itemsPerChunk - 1) / itemsPerChunk), size(itemsPerChunk), items_(items) {}
    std::size_t begin(std::size_t chunk) const { return chunk * size; }
    std::size_t end(std::size_t chunk) const { return std::min(items_, (chunk + 1) * size); }

  private:
    std::size_t items_;
};

// Calls f(begin, end) for pieces of [0, items), as parallelFor does.
template <class Function>
void parallelChunks(std::size_t threads, std::size_t items, std::size_t itemsPerChunk, const Function& f) {
    const Chunks chunks(items, itemsPerChunk);
    parallelFor(threads, chunks.count, [&](std::size_t chunk) { f(chunks.begin(chunk), chunks.end(chunk)); });
}

} // namespace rt
