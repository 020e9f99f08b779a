#include "Common/Core/RunMain.h"

#include <csignal>
#include <iostream>
#include <new>
#include <string_view>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"

namespace rt {

namespace {

int report(const char* program, std::string_view message, ExitCode code) {
    std::cerr << program << ": " << printable(message) << std::endl;
    return static_cast<int>(code);
}

} // namespace

int runMain(const char* program, const std::function<int()>& body) {
#ifdef SIGXFSZ
    std::signal(SIGXFSZ, SIG_IGN); // a limit of the size of files is a failing write like any other
#endif
    try {
        const int code = body();
        std::cout.flush();
        if (!std::cout) throw RenderError("cannot write to standard output");
        return code;
    } catch (const Error& error) {
        return report(program, error.what(), error.code());
    } catch (const std::bad_alloc&) {
        return report(program, "not enough memory", ExitCode::Failure);
    } catch (const std::exception& error) {
        return report(program, error.what(), ExitCode::Failure);
    }
}

} // namespace rt
