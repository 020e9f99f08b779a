#include "Common/Core/RunMain.h"

#include <csignal>
#include <cstddef>
#include <iostream>
#include <new>
#include <string>

#include "Common/Core/Error.h"
#include "Common/Core/MemoryReserve.h"
#include "Common/Core/NewFile.h"
#include "Common/Core/Printable.h"

namespace rt {

namespace {

// More than all functions keep on the main thread's stack at a time, most of which are a kernel's packets of paths.
constexpr std::size_t kStackBytes = 256 << 10;
constexpr std::size_t kPageBytes = 4096;

// Uses as much of the stack once. A stack grows when it is first used, and where there is no memory left by then the
// program ends without a word.
void growStack() {
    char bytes[kStackBytes];
    volatile char* at = bytes;
    for (std::size_t i = 0; i < kStackBytes; i += kPageBytes) at[i] = 0;
}

// Even when there is no memory for the message itself.
int report(const char* program, const std::exception& error, ExitCode code) noexcept {
    try {
        const std::string line = printable(messageOf(error));
        std::cerr << program << ": " << line << std::endl;
    } catch (const std::bad_alloc&) {
        std::cerr << program << ": not enough memory" << std::endl;
    }
    return static_cast<int>(code);
}

} // namespace

int runMain(const char* program, const std::function<int()>& body) {
    void (*volatile grow)() = growStack; // not inlined: the stack is to be free again
    grow();
    keepMemoryReserve();
    openStandardStreams();
#ifdef SIGPIPE
    std::signal(SIGPIPE, SIG_IGN); // so is a reader that has gone: of progress, that is no reason to lose a render
#endif
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN); // a limit of the size of files is a failing write like any other
#endif
    try {
        const int code = body();
        std::cout.flush();
        if (!std::cout) throw RenderError("cannot write to standard output");
        return code;
    } catch (const Error& error) {
        return report(program, error, error.code());
    } catch (const std::exception& error) {
        return report(program, error, ExitCode::Failure);
    }
}

} // namespace rt
